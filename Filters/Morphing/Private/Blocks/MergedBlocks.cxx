// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Blocks/MergedBlocks.h"

#include "Geometry/NearestNodes.h"
#include "Mesh/Polyhedra.h"
#include "Private/Blocks/BlockArrays.h"
#include "Private/Blocks/BlockCells.h"
#include "Private/Blocks/BlockSets.h"
#include "Private/Blocks/BlockWarnings.h"
#include "Private/Blocks/Leaves.h"
#include "Private/Blocks/SharedNodes.h"
#include "Private/Blocks/SplitNodes.h"
#include "Private/Data/Arrays.h"
#include "Private/Data/DataCheck.h"
#include "Private/Data/Version.h"
#include "Support/Error.h"
#include "Support/Lists.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataObjectTree.h>
#include <vtkDataSet.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkStructuredGrid.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <deque>
#include <iterator>
#include <limits>
#include <map>

namespace morph::filters
{
namespace
{
using morph::Index;
using Block = MergedBlocks::Block;

/// A block that is a part of the mesh, while it is merged.
struct Part
{
  std::size_t Place; ///< among all blocks
  vtkDataSet* Data;
  unsigned int FlatIndex;
  Index Group; ///< in which nodes are shared
  morph::Mesh Mesh;
  bool IsAttached = false; ///< of lower dimension than the mesh
};

/// The cells of all parts, of which those with the same nodes are one.
struct Cells
{
  std::vector<std::pair<Index, Index>> Owners; ///< part and its cell
  std::vector<std::vector<Index>> OfPart;      ///< the cell of each part's cell
};

void reorder(const std::vector<Index>& order, std::vector<Index>& numbers)
{
  std::vector<Index> rank(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    rank[order[i]] = static_cast<Index>(i);
  }
  for (Index& number : numbers)
  {
    number = rank[number];
  }
}

bool isStructured(vtkDataSet* data)
{
  return vtkStructuredGrid::SafeDownCast(data) || !vtkPointSet::SafeDownCast(data);
}

double sizeOf(const std::vector<Part>& parts)
{
  Eigen::RowVector3d low, high;
  low.setConstant(std::numeric_limits<double>::infinity());
  high = -low;
  for (const Part& part : parts)
  {
    if (part.Mesh.numberOfNodes() > 0)
    {
      low = low.cwiseMin(part.Mesh.points.colwise().minCoeff());
      high = high.cwiseMax(part.Mesh.points.colwise().maxCoeff());
    }
  }
  return (high - low).norm();
}

/// On ranks parts that hang on others have none: they get those of the nodes at their places.
std::vector<Index> idsOf(const Part& part, const MergedBlocks::Options& options)
{
  return options.ByIds && !(options.AreOnRanks && part.IsAttached)
           ? BlockCells::GlobalIds(part.Data->GetPointData(), part.Mesh.numberOfNodes())
           : std::vector<Index>();
}

SharedNodes numberNodes(
  const std::vector<Part>& parts, const MergedBlocks::Options& options, MergedBlocks& merged)
{
  SharedNodes nodes;
  for (const Part& part : parts)
  {
    merged.All[part.Place].Nodes = nodes.Add({ part.Mesh.points, idsOf(part, options),
      options.Merges && isStructured(part.Data), part.Group });
  }
  return nodes;
}

/// Tells sets whose coordinates are rounded: a point of theirs is next to a node, but not on it.
class Neighbors
{
public:
  bool AreRounded(
    const std::vector<Part>& parts, const morph::Points& points, const std::vector<Index>& found)
  {
    while (this->Near.size() < parts.size())
    {
      this->Near.emplace_back(parts[this->Near.size()].Mesh.points);
    }
    const double reach = 1e-6 * sizeOf(parts);
    for (std::size_t i = 0; i < found.size(); ++i)
    {
      const auto isNext = [&](const morph::NearestNodes& near)
      { return near.distance(points.row(static_cast<Index>(i))) <= reach; };
      if (found[i] < 0 && std::any_of(this->Near.begin(), this->Near.end(), isNext))
      {
        return true;
      }
    }
    return false;
  }

private:
  std::deque<morph::NearestNodes> Near; ///< of each part
};

/// Blocks of lower dimension, such as shells and beams, become parts of the mesh where they hang on
/// it by some of their points, and so on with those that hang on these. A block that is on it with
/// all of its points is a set of its faces, edges or nodes. On ranks options.Attached tells which.
void attachParts(const std::vector<Leaves::Leaf>& leaves, const MergedBlocks::Options& options,
  SharedNodes& nodes, std::vector<Part>& parts, MergedBlocks& merged)
{
  Neighbors neighbors;
  for (bool isAny = options.Merges; isAny;)
  {
    isAny = false;
    for (std::size_t i = 0; i < leaves.size(); ++i)
    {
      Block& block = merged.All[i];
      auto* data = vtkPointSet::SafeDownCast(leaves[i].Data);
      if (block.IsMesh || !data || BlockCells::Dimension(data) < 1)
      {
        continue;
      }
      DataCheck::Require(data, block.Name.c_str());
      const morph::Points points = BlockCells::ReadPoints(data);
      const std::vector<Index> found = nodes.Find({ points, {} });
      const auto missing = std::count(found.begin(), found.end(), -1);
      bool hangs = missing > 0 && missing < points.rows();
      if (options.AreOnRanks) // all have to choose alike
      {
        hangs = options.Attached.count(leaves[i].Path) > 0;
        block.MayHang = missing == 0 || hangs || !neighbors.AreRounded(parts, points, found);
      }
      else
      {
        hangs = hangs && !neighbors.AreRounded(parts, points, found);
      }
      if (!hangs)
      {
        continue;
      }
      parts.push_back({ i, data, leaves[i].FlatIndex, 0,
        BlockCells::Read(data, block.Name, options.Unknown), true });
      // A point at a node is that node, whatever ids they have.
      std::vector<Index> ids = idsOf(parts.back(), options);
      for (std::size_t k = 0; k < ids.size(); ++k)
      {
        ids[k] = found[k] < 0 ? ids[k] : -1;
      }
      block.IsMesh = isAny = true;
      block.Nodes = nodes.Add({ points, ids });
    }
  }
}

/// Lets faces decide where places do not; returns the number of nodes.
Index joinSplitNodes(const std::vector<Part>& parts, const SharedNodes& nodes, MergedBlocks& merged)
{
  std::vector<SplitNodes::Part> blocks;
  for (const Part& part : parts)
  {
    blocks.push_back({ part.Mesh, merged.All[part.Place].Nodes });
  }
  Index number = nodes.Number();
  const std::vector<Index> renamed = SplitNodes::Join(nodes, blocks, number);
  for (Block& block : merged.All)
  {
    for (Index& node : block.Nodes)
    {
      node = block.IsMesh || node < 0 ? node : renamed[node];
    }
  }
  return number;
}

bool isGhost(vtkDataSet* data, Index cell)
{
  vtkUnsignedCharArray* ghosts = data->GetCellGhostArray();
  return ghosts && (ghosts->GetValue(cell) & vtkDataSetAttributes::DUPLICATECELL);
}

/// Whether nodes are of more than one part.
std::vector<std::uint8_t> sharedNodes(
  const std::vector<Part>& parts, const MergedBlocks& merged, Index number)
{
  std::vector<Index> first(number, -1);
  std::vector<std::uint8_t> isShared(number, 0);
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    for (const Index node : merged.All[parts[p].Place].Nodes)
    {
      first[node] = first[node] < 0 ? static_cast<Index>(p) : first[node];
      isShared[node] |= first[node] != static_cast<Index>(p);
    }
  }
  return isShared;
}

Cells numberCells(const std::vector<Part>& parts, const MergedBlocks& merged, Index numberOfNodes)
{
  const std::vector<std::uint8_t> isShared = sharedNodes(parts, merged, numberOfNodes);
  Cells cells;
  // Type and sorted nodes of cells with shared nodes alone: no other cell can be there twice.
  std::map<std::pair<std::uint8_t, std::vector<Index>>, Index> known;
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    const morph::Mesh& mesh = parts[p].Mesh;
    const std::vector<Index>& nodes = merged.All[parts[p].Place].Nodes;
    std::vector<Index>& numbers = cells.OfPart.emplace_back(mesh.numberOfCells());
    for (Index c = 0; c < mesh.numberOfCells(); ++c)
    {
      const Index next = static_cast<Index>(cells.Owners.size());
      numbers[c] = next;
      std::vector<Index> corners(mesh.cell(c), mesh.cell(c) + mesh.cellSize(c));
      const bool maySame = !corners.empty() && std::all_of(corners.begin(), corners.end(),
                                                 [&](Index n) { return isShared[nodes[n]] != 0; });
      if (maySame)
      {
        std::transform(
          corners.begin(), corners.end(), corners.begin(), [&](Index n) { return nodes[n]; });
        std::sort(corners.begin(), corners.end());
        Index& number =
          known.try_emplace({ mesh.types[c], std::move(corners) }, next).first->second;
        if (number != next && cells.Owners[number].first != static_cast<Index>(p))
        {
          numbers[c] = number;
          auto& [part, cell] = cells.Owners[number];
          if (isGhost(parts[part].Data, cell))
          {
            part = static_cast<Index>(p);
            cell = c;
          }
          continue;
        }
      }
      cells.Owners.emplace_back(static_cast<Index>(p), c);
    }
  }
  return cells;
}

/// Renumbers the cells by their global ids, if all have one of their own.
void orderCells(const std::vector<Part>& parts, Cells& cells)
{
  std::vector<std::vector<Index>> ids;
  for (const Part& part : parts)
  {
    ids.push_back(BlockCells::GlobalIds(part.Data->GetCellData(), part.Mesh.numberOfCells()));
    if (ids.back().empty() && part.Mesh.numberOfCells() > 0)
    {
      return;
    }
  }
  const auto idOf = [&](Index cell)
  { return ids[cells.Owners[cell].first][cells.Owners[cell].second]; };
  std::vector<Index> order = consecutive(cells.Owners.size());
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return idOf(a) < idOf(b); });
  if (std::adjacent_find(order.begin(), order.end(),
        [&](Index a, Index b) { return idOf(a) == idOf(b); }) != order.end())
  {
    return;
  }
  std::vector<std::pair<Index, Index>> owners;
  for (const Index cell : order)
  {
    owners.push_back(cells.Owners[cell]);
  }
  cells.Owners = std::move(owners);
  for (std::vector<Index>& numbers : cells.OfPart)
  {
    reorder(order, numbers);
  }
}

void writeCells(const std::vector<Part>& parts, const Cells& cells, MergedBlocks& merged)
{
  vtkNew<vtkUnsignedCharArray> types;
  vtkNew<vtkIdTypeArray> offsets, connectivity;
  vtkNew<vtkIntArray> blocks;
  blocks->SetName("MorphBlockId");
  offsets->InsertNextValue(0);
  const bool hasPolyhedra = std::any_of(
    parts.begin(), parts.end(), [](const Part& part) { return morph::hasPolyhedra(part.Mesh); });
  std::vector<Index> faceOffsets(hasPolyhedra ? 1 : 0, 0), faces;
  for (const auto& [p, c] : cells.Owners)
  {
    const Part& part = parts[p];
    const std::vector<Index>& nodes = merged.All[part.Place].Nodes;
    types->InsertNextValue(part.Mesh.types[c]);
    for (const Index* node = part.Mesh.cell(c); node != part.Mesh.cell(c + 1); ++node)
    {
      connectivity->InsertNextValue(nodes[*node]);
    }
    offsets->InsertNextValue(connectivity->GetNumberOfValues());
    if (morph::isPolyhedron(part.Mesh, c))
    {
      morph::forEachFace(part.Mesh, c,
        [&](const Index* corners, Index size)
        {
          faces.push_back(size);
          std::transform(corners, corners + size, std::back_inserter(faces),
            [&](Index node) { return nodes[node]; });
        });
    }
    if (hasPolyhedra)
    {
      faceOffsets.push_back(static_cast<Index>(faces.size()));
    }
    blocks->InsertNextValue(static_cast<int>(part.FlatIndex));
    merged.BlockOfCell.push_back(static_cast<Index>(part.Place));
  }
  vtkNew<vtkCellArray> array;
  array->SetData(offsets, connectivity);
  Version::SetCells(merged.Grid.Get(), types.Get(), array.Get(), faceOffsets, faces);
  merged.Grid->GetCellData()->AddArray(blocks);
}

/// For each part the ids of tuples to copy: those that own a node or cell.
class Owned
{
public:
  explicit Owned(std::size_t parts)
  {
    for (std::size_t p = 0; p < parts; ++p)
    {
      this->From.push_back(vtkSmartPointer<vtkIdList>::New());
      this->To.push_back(vtkSmartPointer<vtkIdList>::New());
    }
  }
  void Add(std::size_t part, Index from, Index to)
  {
    this->From[part]->InsertNextId(from);
    this->To[part]->InsertNextId(to);
  }
  BlockArrays::Part Of(std::size_t part, vtkDataSetAttributes* from, bool mayLack) const
  {
    return { from, this->From[part], this->To[part], mayLack };
  }

private:
  std::vector<vtkSmartPointer<vtkIdList>> From, To;
};

void writeNodes(const std::vector<Part>& parts, Index number, MergedBlocks& merged)
{
  const bool isFloat = std::all_of(parts.begin(), parts.end(),
    [](const Part& part)
    {
      auto* set = vtkPointSet::SafeDownCast(part.Data);
      return set && set->GetPoints() && set->GetPoints()->GetDataType() == VTK_FLOAT;
    });
  auto points = Arrays::MakePoints(isFloat ? VTK_FLOAT : VTK_DOUBLE, number);
  std::vector<std::uint8_t> isWritten(number, 0);
  Owned owned(parts.size());
  std::vector<BlockArrays::Part> sources;
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    const std::vector<Index>& nodes = merged.All[parts[p].Place].Nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
      if (!isWritten[nodes[i]])
      {
        isWritten[nodes[i]] = 1;
        points->SetPoint(nodes[i], parts[p].Mesh.points.row(static_cast<Index>(i)).data());
        owned.Add(p, static_cast<Index>(i), nodes[i]);
      }
    }
    sources.push_back(owned.Of(p, parts[p].Data->GetPointData(), parts[p].IsAttached));
  }
  merged.Grid->SetPoints(points);
  BlockArrays::Merge(sources, number, merged.Grid->GetPointData());
}

void writeCellArrays(const std::vector<Part>& parts, const Cells& cells, MergedBlocks& merged)
{
  Owned owned(parts.size());
  for (std::size_t c = 0; c < cells.Owners.size(); ++c)
  {
    owned.Add(cells.Owners[c].first, cells.Owners[c].second, static_cast<Index>(c));
  }
  std::vector<BlockArrays::Part> sources;
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    sources.push_back(owned.Of(p, parts[p].Data->GetCellData(), parts[p].IsAttached));
  }
  BlockArrays::Merge(
    sources, static_cast<vtkIdType>(cells.Owners.size()), merged.Grid->GetCellData());
}

/// Finds the nodes of a block that is no part of the mesh. Returns whether it has some.
bool follow(
  vtkDataObject* data, const SharedNodes& nodes, bool byIds, Block& block, MergedBlocks& merged)
{
  auto* set = vtkPointSet::SafeDownCast(data);
  if (!set)
  {
    return false;
  }
  DataCheck::Require(set, block.Name.c_str());
  const morph::Points points = BlockCells::ReadPoints(set);
  const std::vector<Index> ids =
    byIds ? BlockCells::GlobalIds(set->GetPointData(), set->GetNumberOfPoints())
          : std::vector<Index>();
  block.Nodes = nodes.Find({ points, ids });
  const auto missing = std::count(block.Nodes.begin(), block.Nodes.end(), -1);
  if (missing == points.rows())
  {
    block.Nodes.clear();
    return false;
  }
  if (missing > 0)
  {
    merged.Warnings.push_back(BlockWarnings::Missing(block.Name, missing, points.rows()));
  }
  return true;
}

bool isEmpty(vtkDataObject* data)
{
  auto* set = vtkDataSet::SafeDownCast(data);
  return set && set->GetNumberOfPoints() == 0;
}

/// Finds the nodes of all blocks that are no part of the mesh.
void followAll(const std::vector<Leaves::Leaf>& leaves, const SharedNodes& nodes, bool byIds,
  MergedBlocks& merged)
{
  std::vector<std::string> unchanged;
  for (std::size_t i = 0; i < leaves.size(); ++i)
  {
    Block& block = merged.All[i];
    if (!block.IsMesh && !isEmpty(leaves[i].Data) &&
        !follow(leaves[i].Data, nodes, byIds, block, merged))
    {
      unchanged.push_back(block.Name);
    }
  }
  if (const std::string text = BlockWarnings::Unchanged(unchanged); !text.empty())
  {
    merged.Warnings.push_back(text);
  }
}

/// Renumbers the nodes in ascending order of their ids, if all have one.
void orderNodes(const SharedNodes& nodes, MergedBlocks& merged)
{
  const std::vector<Index> order = nodes.Order();
  if (order.empty())
  {
    return;
  }
  std::vector<Index> rank = consecutive(order.size());
  reorder(order, rank);
  for (Block& block : merged.All)
  {
    for (Index& node : block.Nodes)
    {
      node = node < 0 ? node : rank[node];
    }
  }
}

/// The parts of the mesh: the blocks with cells of the highest dimension.
std::vector<Part> readParts(const std::vector<Leaves::Leaf>& leaves,
  const MergedBlocks::Options& options, MergedBlocks& merged)
{
  std::vector<int> dimensions;
  int highest = options.Dimension;
  for (const Leaves::Leaf& leaf : leaves)
  {
    auto* data = vtkDataSet::SafeDownCast(leaf.Data);
    dimensions.push_back(data ? BlockCells::Dimension(data) : -1);
    highest = std::max(highest, dimensions.back());
  }
  std::vector<Part> parts;
  std::map<std::string, Index> groups;
  for (std::size_t i = 0; i < leaves.size(); ++i)
  {
    merged.All.push_back({ leaves[i].Name, {}, {}, dimensions[i] == highest, {}, false });
    if (dimensions[i] == highest)
    {
      auto* data = vtkDataSet::SafeDownCast(leaves[i].Data);
      const Index group =
        options.Merges
          ? 0
          : groups.try_emplace(leaves[i].Path, static_cast<Index>(groups.size())).first->second;
      parts.push_back({ i, data, leaves[i].FlatIndex, group,
        BlockCells::Read(data, leaves[i].Name, options.Unknown) });
    }
  }
  return parts;
}

void noteIds(
  const std::vector<Part>& parts, const MergedBlocks::Options& options, MergedBlocks& merged)
{
  merged.NodeIds.assign(merged.Grid->GetNumberOfPoints(), -1);
  for (const Part& part : parts)
  {
    const std::vector<Index> ids = idsOf(part, options);
    const std::vector<Index>& nodes = merged.All[part.Place].Nodes;
    for (std::size_t i = 0; i < ids.size(); ++i)
    {
      merged.NodeIds[nodes[i]] = ids[i];
    }
  }
}
}

MergedBlocks MergedBlocks::Make(vtkDataObjectTree* tree, const Options& options)
{
  MergedBlocks merged;
  merged.Grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  merged.Grid->GetFieldData()->ShallowCopy(tree->GetFieldData());
  const std::vector<Leaves::Leaf> leaves = Leaves::Of(tree);
  std::vector<Part> parts = readParts(leaves, options, merged);
  SharedNodes nodes = numberNodes(parts, options, merged);
  attachParts(leaves, options, nodes, parts, merged);
  if (parts.empty())
  {
    return merged;
  }
  Options chosen = options;
  merged.Contradiction = nodes.Contradiction(1e-6 * sizeOf(parts));
  if (merged.Contradiction)
  {
    if (options.AreOnRanks)
    {
      return merged; // all processes have to choose alike
    }
    merged.Warnings.push_back(BlockWarnings::Contradiction(*merged.Contradiction));
    chosen.ByIds = false;
    nodes = numberNodes(parts, chosen, merged);
  }
  if (!options.AreOnRanks)
  {
    if (nodes.Coinciding() > 0)
    {
      merged.Warnings.push_back(BlockWarnings::Coinciding(nodes.Coinciding()));
    }
    followAll(leaves, nodes, chosen.ByIds, merged);
  }
  const Index number = joinSplitNodes(parts, nodes, merged);
  orderNodes(nodes, merged);
  Cells cells = numberCells(parts, merged, number);
  orderCells(parts, cells);
  writeNodes(parts, number, merged);
  writeCellArrays(parts, cells, merged);
  writeCells(parts, cells, merged);
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    merged.All[parts[p].Place].Cells = std::move(cells.OfPart[p]);
  }
  if (options.AreOnRanks)
  {
    noteIds(parts, chosen, merged);
    return merged;
  }
  BlockSets::Name(leaves, merged);
  BlockSets::FindBehind(leaves, merged);
  return merged;
}
}
