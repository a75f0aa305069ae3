// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Distributed/WholeSurface.h"

#include "Private/Data/GridMesh.h"
#include "Private/Data/Surface.h"
#include "Private/Distributed/GatherData.h"
#include "Private/Distributed/GatheredSurface.h"
#include "Private/Distributed/RankMatch.h"
#include "Private/Distributed/RankMesh.h"
#include "Private/Distributed/WholeVolume.h"
#include "Private/RankBlocks/GlobalRanks.h"
#include "Support/Error.h"

#include <vtkAppendPolyData.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

namespace morph::filters
{
using morph::Index;
using morph::distributed::DistributedMesh;
using morph::distributed::Ranks;

namespace
{
class GatheredBoundary : public WholeSurface
{
public:
  void Take(vtkUnstructuredGrid* piece, morph::Monitor& monitor) override;
  vtkUnstructuredGrid* Grid() const override { return this->Own.Surface.Grid; }
  const morph::Mesh& Mesh() const override { return this->Own.Surface.Shell; }
  const morph::BoundaryFaces& Faces() const override { return this->Own.Surface.Faces; }
  const std::vector<Index>& BodyOfNode() const override { return this->Own.Surface.BodyOfNode; }
  const std::vector<std::int8_t>& Orientation() const override
  {
    return this->Own.Surface.Orientation;
  }
  double Size() const override { return this->Own.Whole().size(); }
  std::size_t Bytes() const override { return this->Own.Surface.Bytes; }
  const RankMesh& Pieces() const override { return this->Own.Mesh; }
  Index NumberOfBodies() const override
  {
    return static_cast<Index>(this->Own.Surface.NumberOfBody.size());
  }
  std::vector<Index> Places() const override;
  Index NodeOf(std::int64_t id) const override;
  const std::vector<std::int64_t>& NodeIds() const override { return this->Own.Surface.NodeIds; }
  const std::vector<std::int64_t>& CellIds() const override { return this->Own.Surface.CellIds; }
  morph::BoundaryTargets Match(
    vtkPointSet* boundary, const BoundaryMatch::Options& options) const override;
  void Together(const std::function<void()>& work) const override;
  std::vector<std::uint8_t> AnyFlags(const std::vector<std::uint8_t>& ofPiece) const override;
  void KeepOwn(vtkPolyData* surface) const override;
  void MakeIdsGlobal(vtkPolyData* surface, vtkIdType count) const override;
  vtkSmartPointer<vtkPolyData> OfPiece(vtkPolyData* surface) const override;
  std::vector<std::int64_t> IdsOfPiece(const std::vector<Index>& points) const override;
  std::pair<double, double> MaximumAndMean(
    const std::vector<std::int64_t>& ids, const std::vector<double>& values) const override;
  vtkSmartPointer<vtkPolyData> Gather(vtkPolyData* part) const override;
  std::unique_ptr<morph::InnerPieces> Volume() const override
  {
    return std::make_unique<WholeVolume>(*this);
  }

private:
  struct Internals
  {
    RankMesh Mesh;
    const vtkUnstructuredGrid* Piece = nullptr; ///< compared, never used
    vtkMTimeType PieceTime = 0;
    GatheredSurface Surface;

    const DistributedMesh& Whole() const { return this->Mesh.Whole(); }
  };
  Internals Own;
};
}

std::unique_ptr<WholeSurface> WholeSurface::Make()
{
  return std::make_unique<GatheredBoundary>();
}

void GatheredBoundary::Take(vtkUnstructuredGrid* piece, morph::Monitor& monitor)
{
  Internals& own = this->Own;
  const bool isNew = own.Mesh.Take(piece, 1, GridMesh::UnknownCells::Refuse, monitor);
  const bool same =
    !isNew && own.Surface.Grid && own.Piece == piece && own.PieceTime == piece->GetMTime();
  if (own.Mesh.Ranks().sum(Index(!same)) == 0)
  {
    return;
  }
  own.Surface.Grid = nullptr;
  own.Mesh.RequireVolumeCells();
  own.Surface.Gather(own.Mesh, piece);
  own.Piece = piece;
  own.PieceTime = piece->GetMTime();
}

std::vector<Index> GatheredBoundary::Places() const
{
  const Internals& own = this->Own;
  const DistributedMesh& whole = own.Whole();
  const morph::Mesh& piece = own.Mesh.Grid();
  const Index nodes = own.Surface.Shell.numberOfNodes();
  // By ids, since ghost cells of the piece may have points of their own.
  std::vector<Index> body(whole.mesh().numberOfNodes(), -1);
  for (Index c = 0; c < whole.mesh().numberOfCells(); ++c)
  {
    for (Index k = 0; whole.bodies().ofCell[c] >= 0 && k < whole.mesh().cellSize(c); ++k)
    {
      body[whole.mesh().cell(c)[k]] = own.Surface.NumberOfBody[whole.bodies().ofCell[c]];
    }
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
  std::vector<Index> places;
  for (Index n = 0; n < whole.pieceNodes(); ++n)
  {
    const Index node = this->NodeOf(whole.nodeId(n));
    const bool isOuter = node >= 0 && std::binary_search(own.Surface.Faces.nodes.begin(),
                                        own.Surface.Faces.nodes.end(), node);
    const Index of = bodyOf(n);
    places.push_back(isOuter ? node : nodes + (of < 0 ? this->NumberOfBodies() : of));
  }
  return places;
}

Index GatheredBoundary::NodeOf(std::int64_t id) const
{
  const std::vector<std::int64_t>& ids = this->Own.Surface.NodeIds;
  const auto found = std::lower_bound(ids.begin(), ids.end(), id);
  return found != ids.end() && *found == id ? static_cast<Index>(found - ids.begin()) : -1;
}

morph::BoundaryTargets GatheredBoundary::Match(
  vtkPointSet* boundary, const BoundaryMatch::Options& options) const
{
  const Internals& own = this->Own;
  RankMatch::Gathered gathered = RankMatch::Gather(boundary, own.Whole(), options);
  morph::BoundaryTargets result;
  own.Mesh.Ranks().together(
    [&]
    {
      morph::NamedPoints& named = gathered.Points;
      if (gathered.ByPosition)
      {
        named.pairs = BoundaryMatch::FindByPosition(named.positions, own.Surface.Shell,
          own.Surface.Faces.nodes, options.matchTolerance * this->Size(), named.unmatched);
      }
      else
      {
        std::vector<std::pair<Index, Index>> pairs;
        for (const auto& [point, id] : named.pairs)
        {
          if (const Index node = this->NodeOf(id); node >= 0)
          {
            pairs.emplace_back(point, node);
          }
        }
        named.pairs = std::move(pairs);
      }
      const Index rounded =
        BoundaryMatch::TakeBackRounding(gathered.PointPrecision, own.Surface.Shell, named);
      result = morph::findTargets(std::move(named), own.Surface.Shell, own.Surface.Faces,
        this->Size(), options, &own.Surface.NodeIds);
      BoundaryMatch::Conclude(this->Size(), options, gathered.PointPrecision, rounded, result);
    });
  return result;
}

void GatheredBoundary::Together(const std::function<void()>& work) const
{
  this->Own.Mesh.Ranks().together(
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

std::vector<std::uint8_t> GatheredBoundary::AnyFlags(const std::vector<std::uint8_t>& ofPiece) const
{
  std::vector<std::int64_t> ids;
  for (std::size_t n = 0; n < ofPiece.size(); ++n)
  {
    const std::int64_t id = this->Own.Whole().nodeId(static_cast<Index>(n));
    if (ofPiece[n] != 0 && this->NodeOf(id) >= 0)
    {
      ids.push_back(id);
    }
  }
  std::vector<std::uint8_t> flags(this->Own.Surface.NodeIds.size(), 0);
  for (const std::int64_t id : this->Own.Mesh.Ranks().gather(ids))
  {
    flags[this->NodeOf(id)] = 1;
  }
  return flags;
}

void GatheredBoundary::KeepOwn(vtkPolyData* surface) const
{
  const Internals& own = this->Own;
  const int rank = own.Mesh.Ranks().rank();
  vtkDataArray* behind = surface->GetCellData()->GetArray(GatheredSurface::CellName);
  vtkDataArray* nodeOf = surface->GetPointData()->GetArray(Surface::IdName);
  std::vector<vtkIdType> number(static_cast<std::size_t>(surface->GetNumberOfPoints()), -1);
  vtkNew<vtkIdList> points, cells, corners;
  vtkNew<vtkPolyData> kept;
  vtkIdType cell = 0;
  const auto keep = [&](vtkCellArray* from)
  {
    vtkNew<vtkCellArray> to;
    for (vtkIdType i = 0; i < from->GetNumberOfCells(); ++i, ++cell)
    {
      from->GetCellAtId(i, corners);
      const bool isOwn =
        behind
          ? own.Surface.RankOfCell[static_cast<Index>(behind->GetComponent(cell, 0))] == rank
          : own.Surface
                .RankOfNode[static_cast<Index>(nodeOf->GetComponent(corners->GetId(0), 0))] == rank;
      if (!isOwn)
      {
        continue;
      }
      for (vtkIdType k = 0; k < corners->GetNumberOfIds(); ++k)
      {
        vtkIdType& mine = number[corners->GetId(k)];
        if (mine < 0)
        {
          mine = points->InsertNextId(corners->GetId(k));
        }
        corners->SetId(k, mine);
      }
      to->InsertNextCell(corners);
      cells->InsertNextId(cell);
    }
    return vtkSmartPointer<vtkCellArray>(to);
  };
  kept->SetVerts(keep(surface->GetVerts()));
  kept->SetLines(keep(surface->GetLines()));
  kept->SetPolys(keep(surface->GetPolys()));
  vtkNew<vtkPoints> places;
  places->SetDataType(surface->GetPoints()->GetDataType());
  surface->GetPoints()->GetPoints(points, places);
  kept->SetPoints(places);
  kept->GetPointData()->CopyAllOn();
  kept->GetPointData()->CopyAllocate(surface->GetPointData(), points->GetNumberOfIds());
  kept->GetPointData()->CopyData(
    surface->GetPointData(), points, firstNumbers(points->GetNumberOfIds()));
  kept->GetCellData()->CopyAllOn();
  kept->GetCellData()->CopyAllocate(surface->GetCellData(), cells->GetNumberOfIds());
  kept->GetCellData()->CopyData(
    surface->GetCellData(), cells, firstNumbers(cells->GetNumberOfIds()));
  kept->GetFieldData()->ShallowCopy(surface->GetFieldData());
  renumber(kept->GetPointData(), Surface::IdName, kept->GetNumberOfPoints(),
    [&own](vtkIdType node) { return static_cast<vtkIdType>(own.Surface.NodeIds[node]); });
  renumber(kept->GetCellData(), GatheredSurface::CellName, kept->GetNumberOfCells(),
    [&own](vtkIdType of) { return static_cast<vtkIdType>(own.Surface.CellIds[of]); });
  surface->ShallowCopy(kept);
}

void GatheredBoundary::MakeIdsGlobal(vtkPolyData* surface, vtkIdType count) const
{
  const DistributedMesh& whole = this->Own.Whole();
  const vtkIdType first = surface->GetNumberOfPoints() - count;
  vtkIdType point = 0;
  renumber(surface->GetPointData(), Surface::IdName, surface->GetNumberOfPoints(),
    [&](vtkIdType id) { return point++ < first ? id : static_cast<vtkIdType>(whole.nodeId(id)); });
}

vtkSmartPointer<vtkPolyData> GatheredBoundary::OfPiece(vtkPolyData* surface) const
{
  const DistributedMesh& whole = this->Own.Whole();
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->ShallowCopy(surface);
  renumber(result->GetPointData(), Surface::IdName, result->GetNumberOfPoints(),
    [&whole](vtkIdType id) { return static_cast<vtkIdType>(whole.nodeOf(id)); });
  std::vector<std::pair<std::int64_t, Index>> cells;
  for (Index c = 0; c < whole.pieceCells(); ++c)
  {
    if (whole.isGhost()[c] == 0)
    {
      cells.emplace_back(whole.cellId(c), c);
    }
  }
  std::sort(cells.begin(), cells.end());
  renumber(result->GetCellData(), GatheredSurface::CellName, result->GetNumberOfCells(),
    [&cells](vtkIdType id)
    {
      const auto found =
        std::lower_bound(cells.begin(), cells.end(), std::pair<std::int64_t, Index>(id, -1));
      return static_cast<vtkIdType>(found->second);
    });
  return result;
}

std::vector<std::int64_t> GatheredBoundary::IdsOfPiece(const std::vector<Index>& points) const
{
  std::vector<std::int64_t> ids;
  for (const Index point : points)
  {
    ids.push_back(this->Own.Whole().nodeId(point));
  }
  return ids;
}

std::pair<double, double> GatheredBoundary::MaximumAndMean(
  const std::vector<std::int64_t>& ids, const std::vector<double>& values) const
{
  struct Value
  {
    std::int64_t id;
    double value;
  };
  std::vector<Value> all;
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    all.push_back({ ids[i], values[i] });
  }
  all = this->Own.Mesh.Ranks().gather(all);
  std::sort(all.begin(), all.end(),
    [](const Value& a, const Value& b)
    { return std::tie(a.id, a.value) < std::tie(b.id, b.value); });
  double most = std::numeric_limits<double>::quiet_NaN(), sum = 0;
  Index count = 0;
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    if (i == 0 || all[i].id != all[i - 1].id)
    {
      most = count == 0 ? all[i].value : std::max(most, all[i].value);
      sum += all[i].value;
      ++count;
    }
  }
  return { most, count > 0 ? sum / static_cast<double>(count) : most };
}

vtkSmartPointer<vtkPolyData> GatheredBoundary::Gather(vtkPolyData* part) const
{
  std::size_t bytes = 0;
  const Ranks ranks = GlobalRanks();
  const auto parts = gatherData<vtkPolyData>(ranks, part, true, bytes);
  auto whole = vtkSmartPointer<vtkPolyData>::New();
  ranks.together(
    [&]
    {
      vtkNew<vtkAppendPolyData> append;
      for (const auto& one : parts)
      {
        if (one && one->GetNumberOfPoints() > 0)
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
