// SPDX-License-Identifier: BSD-3-Clause
#include "Private/RankBlocks/RankBlocks.h"

#include "Distributed/DistributedMesh.h"
#include "Distributed/RankCommunicator.h"
#include "Distributed/SharedPlaces.h"
#include "Mesh/ShellLayer.h"
#include "Private/Blocks/BlockCells.h"
#include "Private/Blocks/BlockWarnings.h"
#include "Private/Blocks/Leaves.h"
#include "Private/RankBlocks/GlobalRanks.h"
#include "Private/RankBlocks/RankBehind.h"
#include "Private/RankBlocks/RankSets.h"
#include "Private/RankBlocks/SharedCells.h"

#include <vtkCellData.h>
#include <vtkDataObjectTree.h>
#include <vtkDataSet.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace morph::filters::RankBlocks
{
namespace
{
using morph::Index;
using morph::distributed::Ranks;
using morph::distributed::SharedPlaces;

MergedBlocks makeOwn(
  const Ranks& ranks, vtkDataObjectTree* tree, const MergedBlocks::Options& options)
{
  MergedBlocks merged;
  ranks.together([&] { merged = MergedBlocks::Make(tree, options); });
  return merged;
}

/// The highest dimension of all processes' blocks.
int dimensionOf(const Ranks& ranks, const std::vector<Leaves::Leaf>& leaves)
{
  Index highest = 0;
  for (const Leaves::Leaf& leaf : leaves)
  {
    auto* data = vtkDataSet::SafeDownCast(leaf.Data);
    highest = std::max<Index>(highest, data ? BlockCells::Dimension(data) : -1);
  }
  return static_cast<int>(ranks.maximum(highest));
}

/// The diagonal of the box around all processes' nodes.
double sizeOf(const Ranks& ranks, vtkUnstructuredGrid* grid)
{
  Eigen::AlignedBox3d box;
  if (grid->GetNumberOfPoints() > 0)
  {
    double at[6];
    grid->GetBounds(at);
    box = { Eigen::Vector3d(at[0], at[2], at[4]), Eigen::Vector3d(at[1], at[3], at[5]) };
  }
  return morph::distributed::diagonal(ranks, box);
}

std::vector<std::uint8_t> usedNodes(vtkUnstructuredGrid* grid)
{
  std::vector<std::uint8_t> isUsed(grid->GetNumberOfPoints(), 0);
  const std::vector<std::uint8_t> isGhost = SharedCells::Ghosts(grid);
  vtkNew<vtkIdList> corners;
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    if (isGhost[c] == 0)
    {
      grid->GetCellPoints(c, corners);
      std::for_each(corners->begin(), corners->end(), [&](vtkIdType n) { isUsed[n] = 1; });
    }
  }
  return isUsed;
}

std::vector<SharedPlaces::Node> nodesOf(
  const MergedBlocks& merged, const std::vector<Index>& numbers, bool merges)
{
  const std::vector<std::uint8_t> isUsed = usedNodes(merged.Grid);
  std::vector<SharedPlaces::Node> nodes(isUsed.size());
  std::vector<Index> blockOf(isUsed.size(), -1);
  for (std::size_t i = 0; i < merged.All.size(); ++i)
  {
    for (const Index node : merged.All[i].Nodes)
    {
      blockOf[node] = blockOf[node] < 0 ? numbers[i] : blockOf[node];
    }
  }
  for (std::size_t n = 0; n < nodes.size(); ++n)
  {
    SharedPlaces::Node& node = nodes[n];
    merged.Grid->GetPoint(static_cast<vtkIdType>(n), node.x.data());
    node.id = merged.NodeIds[n];
    node.block = blockOf[n];
    node.group = merges ? 0 : blockOf[n];
    node.isUsed = isUsed[n];
  }
  return nodes;
}

/// Makes `ids` the global ids of the grid. The given array stays where all processes have these.
void setIds(
  const Ranks& ranks, const std::vector<Index>& ids, const char* name, vtkDataSetAttributes* data)
{
  const std::vector<Index> given = BlockCells::GlobalIds(data, static_cast<vtkIdType>(ids.size()));
  if (ranks.sum(Index(given != ids)) == 0)
  {
    return;
  }
  vtkNew<vtkIdTypeArray> array;
  array->SetName(name);
  array->SetNumberOfValues(static_cast<vtkIdType>(ids.size()));
  std::copy(ids.begin(), ids.end(), array->GetPointer(0));
  data->AddArray(array);
  data->SetActiveGlobalIds(name);
}
}

namespace
{
/// Gives a piece without nodes one of another process, so that all have a part of the layer.
void takeSomeNode(const Ranks& ranks, morph::distributed::Piece& piece)
{
  morph::Points& points = piece.mesh.points;
  std::vector<double> node; // its id and position
  if (points.rows() > 0)
  {
    node = { static_cast<double>(piece.nodeIds[0]), points(0, 0), points(0, 1), points(0, 2) };
  }
  node = ranks.gather(node);
  if (points.rows() == 0)
  {
    points = Eigen::Map<const Eigen::RowVector3d>(node.data() + 1);
    piece.nodeIds = { static_cast<std::int64_t>(node[0]) };
  }
}
}

MergedBlocks Make(vtkDataObjectTree* tree, MergedBlocks::Options given)
{
  MergedBlocks::Options options = given;
  const Ranks ranks = GlobalRanks();
  const vtkNew<vtkMultiBlockDataSet> none;
  tree = tree ? tree : none.Get();
  const std::vector<Leaves::Leaf> leaves = Leaves::Of(tree);
  options.AreOnRanks = true;
  options.Dimension = dimensionOf(ranks, leaves);
  std::vector<std::string> paths;
  for (const Leaves::Leaf& leaf : leaves)
  {
    paths.push_back(leaf.Path);
  }
  const std::vector<std::string> allPaths = GatherTexts(ranks, paths);
  std::vector<Index> numbers;
  for (const std::string& path : paths)
  {
    numbers.push_back(std::lower_bound(allPaths.begin(), allPaths.end(), path) - allPaths.begin());
  }

  MergedBlocks merged = makeOwn(ranks, tree, options);
  std::vector<std::string> warnings;
  Index contradictory = ranks.maximum(merged.Contradiction.value_or(-1));
  if (contradictory < 0 && options.ByIds)
  {
    contradictory = SharedPlaces::contradiction(
      ranks, nodesOf(merged, numbers, options.Merges), 1e-6 * sizeOf(ranks, merged.Grid));
  }
  if (contradictory >= 0)
  {
    warnings.push_back(BlockWarnings::Contradiction(contradictory));
    options.ByIds = false;
    merged = makeOwn(ranks, tree, options);
  }
  const SharedPlaces places(ranks, nodesOf(merged, numbers, options.Merges));
  if (places.coinciding() > 0)
  {
    warnings.push_back(BlockWarnings::Coinciding(places.coinciding()));
  }
  merged.NodeIds = places.ids();
  SharedCells::MarkGhosts(ranks, places.ids(), places.isShared(), merged.Grid);
  merged.CellIds = SharedCells::Ids(ranks, merged.Grid);

  const RankSets sets{ ranks, leaves, numbers, static_cast<Index>(allPaths.size()), places };
  const std::vector<Index> hanging = sets.Follow(options.ByIds, merged, warnings);
  if (!hanging.empty()) // others may hang on these
  {
    for (const Index block : hanging)
    {
      given.Attached.insert(allPaths[block]);
    }
    return Make(tree, given);
  }
  sets.Name(merged);
  const auto behind = std::make_shared<RankBehind>(ranks, leaves, places, merged);
  merged.WorstBehind = [behind](vtkDataArray* values) { return behind->Worst(values); };
  setIds(ranks, merged.NodeIds, "MorphGlobalPointId", merged.Grid->GetPointData());
  setIds(ranks, merged.CellIds, "MorphGlobalCellId", merged.Grid->GetCellData());
  if (ranks.rank() == 0)
  {
    merged.Warnings = std::move(warnings);
  }
  return merged;
}

ShellGrid::Solid Thicken(vtkUnstructuredGrid* piece)
{
  constexpr int Layers = 2; // of other processes' cells: the most that a method asks for
  const Ranks ranks = GlobalRanks();
  morph::distributed::Piece own;
  ranks.together(
    [&] { own.mesh = BlockCells::Read(piece, "The input", GridMesh::UnknownCells::Refuse); });
  own.isGhost = SharedCells::Ghosts(piece);
  own.nodeIds = SharedCells::Numbers(piece->GetPointData()->GetGlobalIds());
  own.cellIds = SharedCells::Numbers(piece->GetCellData()->GetGlobalIds());
  morph::distributed::requireNodeIds(ranks, own);
  morph::distributed::requireCellIds(ranks, own);
  takeSomeNode(ranks, own);
  morph::Monitor serial;
  const morph::distributed::DistributedMesh whole(ranks, std::move(own), Layers, serial);
  const morph::distributed::RankCommunicator processes(whole);
  ShellGrid::Solid solid;
  ranks.together([&] { solid.Mesh = morph::thicken(whole.mesh(), processes); });
  solid.FrontIds = whole.nodeIds();
  solid.NextId = ranks.maximum(*std::max_element(solid.FrontIds.begin(), solid.FrontIds.end())) + 1;
  return solid;
}
}
