// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Distributed/WholeSurface.h"

#include "Boundary/WallLayers.h"
#include "Distributed/RankCommunicator.h"
#include "Private/Data/Arrays.h"
#include "Private/Data/GridMesh.h"
#include "Private/Data/Surface.h"
#include "Private/Distributed/GatherData.h"
#include "Private/Distributed/GatheredSurface.h"
#include "Private/Distributed/RankMesh.h"
#include "Private/RankBlocks/GlobalRanks.h"
#include "Support/Error.h"

#include <vtkAppendPolyData.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <utility>

namespace morph::filters
{
using morph::Index;
using morph::distributed::DistributedMesh;

namespace
{
class GatheredBoundary : public WholeSurface
{
public:
  void Take(vtkUnstructuredGrid* piece, morph::Monitor& monitor,
    const std::function<std::vector<ListedZone>()>& list,
    const std::function<bool()>& needsAll) override;
  double Size() const override { return this->Whole().size(); }
  std::vector<Index> Places() const override;
  morph::BoundaryTargets Match(
    vtkPointSet* boundary, const BoundaryMatch::Options& options) const override;
  void KeepOwn(vtkPolyData* surface) const override;
  void MakeIdsGlobal(vtkPolyData* surface, vtkIdType count) const override;
  vtkSmartPointer<vtkPolyData> OfPiece(vtkPolyData* surface) const override;
  std::pair<double, double> MaximumAndMean(
    const std::vector<Index>& points, const std::vector<double>& values) const override;
  vtkSmartPointer<vtkPolyData> Gather(vtkPolyData* part) const override;

  const morph::Mesh& piece() const override { return this->Own.Grid(); }
  const morph::Mesh& mesh() const override { return this->Whole().mesh(); }
  const morph::HangingNodes& hanging() const override { return this->Own.Rest()->hanging(); }
  bool needsPieces() const override { return this->Own.Rest()->needsPieces(); }
  const std::shared_ptr<const morph::Communicator>& processes() const override
  {
    return this->Own.Rest()->processes();
  }
  Index nodeOf(Index node) const override
  {
    return this->Whole().nodeOf(this->Surface.NodeIds[node]);
  }
  void together(const std::function<void()>& work) const override;
  Flags nodeFlags(const Flags& ofPiece) const override;
  Flags anyFlags(const Flags& ofPiece) const override;
  std::vector<Index> ownInner(const Flags& ofPiece) const override;
  Columns findLayers(const morph::BoundaryFaces& faces, const Flags& isWall, Index most,
    const Flags& isLayer) const override;

private:
  const DistributedMesh& Whole() const { return this->Own.Whole(); }
  std::map<std::int64_t, Index> OwnCells() const;

  RankMesh Own;
  const vtkUnstructuredGrid* Piece = nullptr; ///< compared, never used
  vtkMTimeType PieceTime = 0;
};
}

std::unique_ptr<WholeSurface> WholeSurface::Make()
{
  return std::make_unique<GatheredBoundary>();
}

void GatheredBoundary::Take(vtkUnstructuredGrid* piece, morph::Monitor& monitor,
  const std::function<std::vector<ListedZone>()>& list, const std::function<bool()>& needsAll)
{
  const bool isNew = this->Own.Take(piece, 1, GridMesh::UnknownCells::Refuse, monitor);
  const bool same =
    !isNew && this->Surface.Grid && this->Piece == piece && this->PieceTime == piece->GetMTime();
  const auto gather = [&](bool all)
  { this->Surface.Gather(this->Own, piece, list ? list() : std::vector<ListedZone>(), all); };
  if (this->Own.Ranks().sum(Index(!same)) > 0)
  {
    this->Own.RequireVolumeCells();
    gather(false);
    this->Piece = piece;
    this->PieceTime = piece->GetMTime();
  }
  bool all = this->Surface.HasAll;
  this->together([&] { all = all || (needsAll && needsAll()); });
  if (all && !this->Surface.HasAll)
  {
    gather(true);
  }
}

std::vector<Index> GatheredBoundary::Places() const
{
  const DistributedMesh& whole = this->Whole();
  const morph::Mesh& piece = this->Own.Grid();
  const Index nodes = this->Surface.Shell.numberOfNodes();
  // By ids, since ghost cells of the piece may have points of their own.
  std::vector<Index> body = morph::bodyOfNodes(whole.mesh(), whole.bodies());
  for (Index& of : body)
  {
    of = of < 0 ? of : this->Surface.NumberOfBody[of];
  }
  const auto bodyOf = [&](Index n) -> Index& { return body[whole.nodeOf(whole.nodeId(n))]; };
  // Ghost cells beyond the first layer are no cells of the distributed mesh.
  for (bool changes = true; changes;)
  {
    changes = false;
    for (Index c = 0; c < piece.numberOfCells(); ++c)
    {
      if (whole.isGhost()[c] == 0 || GridMesh::Dimension(piece.types[c]) != 3)
      {
        continue;
      }
      Index known = -1;
      for (Index k = 0; k < piece.cellSize(c); ++k)
      {
        known = std::max(known, bodyOf(piece.cell(c)[k]));
      }
      for (Index k = 0; k < piece.cellSize(c); ++k)
      {
        Index& mine = bodyOf(piece.cell(c)[k]);
        changes = changes || mine != known;
        mine = known;
      }
    }
  }
  const auto bodies = static_cast<Index>(this->Surface.NumberOfBody.size());
  std::vector<Index> places;
  for (Index n = 0; n < whole.pieceNodes(); ++n)
  {
    const Index node = this->Surface.NodeOf(whole.nodeId(n));
    const bool isOuter = node >= 0 && std::binary_search(this->Surface.Faces.nodes.begin(),
                                        this->Surface.Faces.nodes.end(), node);
    const Index of = bodyOf(n);
    places.push_back(isOuter ? node : nodes + (of < 0 ? bodies : of));
  }
  return places;
}

morph::BoundaryTargets GatheredBoundary::Match(
  vtkPointSet* boundary, const BoundaryMatch::Options& options) const
{
  const morph::distributed::RankCommunicator processes(this->Whole());
  BoundaryMatch::Gathered gathered =
    BoundaryMatch::Gather(boundary, this->Own.Nodes(), processes, options);
  morph::BoundaryTargets result;
  processes.together(
    [&]
    {
      Index rounded = 0;
      const auto nodeOf = [this](Index id) { return this->Surface.NodeOf(id); };
      result = BoundaryMatch::TargetsOf(gathered,
        { this->Surface.Shell, this->Surface.Faces, this->Size(), &this->Surface.NodeIds, nodeOf },
        options, rounded);
      BoundaryMatch::Conclude(this->Size(), options, gathered.PointPrecision, rounded, result);
    });
  return result;
}

/// A message with ids says of what they are.
void GatheredBoundary::together(const std::function<void()>& work) const
{
  this->Own.Ranks().together(
    [&]
    {
      try
      {
        work();
      }
      catch (const morph::Error& error)
      {
        const std::string text = error.what();
        throw morph::Error(error.kind(),
          text.find(" ids ") == std::string::npos
            ? text
            : text + " On several MPI ranks these ids number the nodes and cells of the whole "
                     "boundary, in the order of their global ids.");
      }
    });
}

morph::InnerPieces::Flags GatheredBoundary::nodeFlags(const Flags& ofPiece) const
{
  std::vector<std::int64_t> ids;
  for (std::size_t n = 0; n < ofPiece.size(); ++n)
  {
    const std::int64_t id = this->Whole().nodeId(static_cast<Index>(n));
    if (ofPiece[n] != 0 && this->Surface.NodeOf(id) >= 0)
    {
      ids.push_back(id);
    }
  }
  Flags flags(this->Surface.NodeIds.size(), 0);
  for (const std::int64_t id : this->Own.Ranks().gather(ids))
  {
    flags[this->Surface.NodeOf(id)] = 1;
  }
  return flags;
}

morph::InnerPieces::Flags GatheredBoundary::anyFlags(const Flags& ofPiece) const
{
  const DistributedMesh& mesh = this->Whole();
  std::vector<Index> nodes;
  for (std::size_t n = 0; n < ofPiece.size(); ++n)
  {
    if (ofPiece[n] != 0) // by ids: ghost cells of the piece may have points of their own
    {
      nodes.push_back(mesh.nodeOf(mesh.nodeId(static_cast<Index>(n))));
    }
  }
  this->Own.All().spread(nodes);
  Flags result(mesh.pieceNodes(), 0);
  for (const Index node : nodes)
  {
    if (node < mesh.pieceNodes())
    {
      result[node] = 1;
    }
  }
  return result;
}

std::vector<Index> GatheredBoundary::ownInner(const Flags& ofPiece) const
{
  const DistributedMesh& mesh = this->Whole();
  const std::vector<Index>& outer = this->Own.Rest()->outerNodes().nodes;
  std::vector<Index> points;
  for (Index n = 0; n < static_cast<Index>(ofPiece.size()); ++n)
  {
    if (ofPiece[n] != 0 && mesh.owns(n) && !std::binary_search(outer.begin(), outer.end(), n))
    {
      points.push_back(n);
    }
  }
  return points;
}

/// Of the cells that count here, by their ids.
std::map<std::int64_t, Index> GatheredBoundary::OwnCells() const
{
  std::map<std::int64_t, Index> cellOf;
  for (Index c = 0; c < this->Whole().pieceCells(); ++c)
  {
    if (this->Whole().isGhost()[c] == 0)
    {
      cellOf.emplace(this->Whole().cellId(c), c);
    }
  }
  return cellOf;
}

morph::InnerPieces::Columns GatheredBoundary::findLayers(
  const morph::BoundaryFaces& faces, const Flags& isWall, Index most, const Flags& isLayer) const
{
  const DistributedMesh& mesh = this->Whole();
  const std::map<std::int64_t, Index> cellOf = this->OwnCells();
  morph::BoundaryFaces own;
  Flags isOwnWall;
  for (std::size_t f = 0; f < faces.cells.size(); ++f)
  {
    const auto cell = cellOf.find(this->Surface.CellIds[faces.cells[f]]);
    if (cell != cellOf.end())
    {
      std::vector<Index> corners(faces.connectivity.begin() + faces.offsets[f],
        faces.connectivity.begin() + faces.offsets[f + 1]);
      std::transform(corners.begin(), corners.end(), corners.begin(),
        [this](Index node) { return this->nodeOf(node); });
      own.cells.push_back(cell->second);
      own.add(corners.begin(), corners.end());
      isOwnWall.push_back(isWall[f]);
    }
  }
  own.takeNodes();
  const morph::WallLayers layers =
    morph::findWallLayers(mesh.mesh(), own, isOwnWall, most, isLayer, *this->processes());
  Columns columns;
  std::vector<std::array<Index, 2>> outer; // ids of nodes and their walls
  for (std::size_t i = 0; i < layers.walls.size(); ++i)
  {
    const auto column = static_cast<Index>(i);
    for (const Index* n = layers.columns.begin(column); n != layers.columns.end(column); ++n)
    {
      const Index node = this->Surface.NodeOf(mesh.nodeId(*n));
      if (std::binary_search(faces.nodes.begin(), faces.nodes.end(), node))
      {
        outer.push_back({ mesh.nodeId(*n), layers.walls[i] });
      }
      else
      {
        columns.points.emplace_back(*n, this->Surface.NodeOf(layers.walls[i]));
      }
    }
  }
  for (const auto& [node, wall] : mesh.ranks().gather(outer))
  {
    columns.nodes.emplace_back(this->Surface.NodeOf(node), this->Surface.NodeOf(wall));
  }
  return columns;
}

void GatheredBoundary::KeepOwn(vtkPolyData* surface) const
{
  vtkDataArray* behind = surface->GetCellData()->GetArray(GatheredSurface::CellName);
  vtkDataArray* nodeOf = surface->GetPointData()->GetArray(Surface::IdName);
  vtkNew<vtkIdList> cells, corners;
  for (vtkIdType cell = 0; cell < surface->GetNumberOfCells(); ++cell)
  {
    surface->GetCellPoints(cell, corners);
    const int owner =
      behind
        ? this->Surface.RankOfCell[static_cast<Index>(behind->GetComponent(cell, 0))]
        : this->Surface.RankOfNode[static_cast<Index>(nodeOf->GetComponent(corners->GetId(0), 0))];
    if (owner == this->Own.Ranks().rank())
    {
      cells->InsertNextId(cell);
    }
  }
  vtkNew<vtkPolyData> kept;
  kept->SetPoints(Arrays::MakePoints(surface->GetPoints()->GetDataType()));
  kept->AllocateEstimate(cells->GetNumberOfIds(), 4);
  kept->GetPointData()->CopyAllOn();
  kept->GetPointData()->CopyAllocate(surface->GetPointData());
  kept->GetCellData()->CopyAllOn();
  kept->GetCellData()->CopyAllocate(surface->GetCellData());
  kept->CopyCells(surface, cells);
  kept->GetFieldData()->ShallowCopy(surface->GetFieldData());
  renumber(kept->GetPointData(), Surface::IdName, kept->GetNumberOfPoints(),
    [this](vtkIdType node) { return static_cast<vtkIdType>(this->Surface.NodeIds[node]); });
  renumber(kept->GetCellData(), GatheredSurface::CellName, kept->GetNumberOfCells(),
    [this](vtkIdType of) { return static_cast<vtkIdType>(this->Surface.CellIds[of]); });
  surface->ShallowCopy(kept);
}

void GatheredBoundary::MakeIdsGlobal(vtkPolyData* surface, vtkIdType count) const
{
  const DistributedMesh& whole = this->Whole();
  const vtkIdType first = surface->GetNumberOfPoints() - count;
  vtkIdType point = 0;
  renumber(surface->GetPointData(), Surface::IdName, surface->GetNumberOfPoints(),
    [&](vtkIdType id) { return point++ < first ? id : static_cast<vtkIdType>(whole.nodeId(id)); });
}

vtkSmartPointer<vtkPolyData> GatheredBoundary::OfPiece(vtkPolyData* surface) const
{
  const DistributedMesh& whole = this->Whole();
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->ShallowCopy(surface);
  renumber(result->GetPointData(), Surface::IdName, result->GetNumberOfPoints(),
    [&whole](vtkIdType id) { return static_cast<vtkIdType>(whole.nodeOf(id)); });
  const std::map<std::int64_t, Index> cellOf = this->OwnCells();
  renumber(result->GetCellData(), GatheredSurface::CellName, result->GetNumberOfCells(),
    [&cellOf](vtkIdType id) { return cellOf.at(id); });
  return result;
}

std::pair<double, double> GatheredBoundary::MaximumAndMean(
  const std::vector<Index>& points, const std::vector<double>& values) const
{
  std::vector<std::array<double, 2>> mine; // ids below 2^52, and values
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    mine.push_back({ static_cast<double>(this->Whole().nodeId(points[i])), values[i] });
  }
  std::map<double, double> all;
  for (const auto& [id, value] : this->Own.Ranks().gather(mine))
  {
    double& known = all.try_emplace(id, value).first->second;
    known = std::min(known, value);
  }
  double most = std::numeric_limits<double>::quiet_NaN(), sum = 0;
  for (const auto& [id, value] : all)
  {
    most = std::fmax(most, value);
    sum += value;
  }
  return { most, sum / static_cast<double>(all.size()) };
}

vtkSmartPointer<vtkPolyData> GatheredBoundary::Gather(vtkPolyData* part) const
{
  std::size_t bytes = 0;
  const morph::distributed::Ranks ranks = GlobalRanks();
  const auto parts =
    gatherData<vtkXMLPolyDataWriter, vtkXMLPolyDataReader>(ranks, part, true, bytes);
  auto whole = vtkSmartPointer<vtkPolyData>::New();
  ranks.together(
    [&]
    {
      vtkNew<vtkAppendPolyData> append;
      for (const auto& one : parts)
      {
        if (one->GetNumberOfPoints() > 0)
        {
          append->AddInputData(one);
        }
      }
      if (append->GetNumberOfInputConnections(0) > 0)
      {
        append->Update();
        whole->ShallowCopy(append->GetOutput());
      }
    });
  return whole;
}
}
