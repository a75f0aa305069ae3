// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Distributed/WholeSurface.h"

#include "Distributed/RankCommunicator.h"
#include "Private/Data/Arrays.h"
#include "Private/Data/GridMesh.h"
#include "Private/Data/Surface.h"
#include "Private/Distributed/GatherData.h"
#include "Private/Distributed/GatheredSurface.h"
#include "Private/Distributed/RankMesh.h"
#include "Private/Distributed/WholeVolume.h"
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
using morph::distributed::Ranks;

namespace
{
class GatheredBoundary : public WholeSurface
{
public:
  void Take(vtkUnstructuredGrid* piece, morph::Monitor& monitor,
    const std::function<bool()>& needsAll) override;
  double Size() const override { return this->Whole().size(); }
  const RankMesh& Pieces() const override { return this->Own; }
  std::vector<Index> Places() const override;
  morph::BoundaryTargets Match(
    vtkPointSet* boundary, const BoundaryMatch::Options& options) const override;
  void Together(const std::function<void()>& work) const override;
  std::vector<std::uint8_t> AnyFlags(const std::vector<std::uint8_t>& ofPiece) const override;
  void KeepOwn(vtkPolyData* surface) const override;
  void MakeIdsGlobal(vtkPolyData* surface, vtkIdType count) const override;
  vtkSmartPointer<vtkPolyData> OfPiece(vtkPolyData* surface) const override;
  std::pair<double, double> MaximumAndMean(
    const std::vector<Index>& points, const std::vector<double>& values) const override;
  vtkSmartPointer<vtkPolyData> Gather(vtkPolyData* part) const override;
  std::unique_ptr<morph::InnerPieces> Volume() const override
  {
    return std::make_unique<WholeVolume>(*this);
  }

private:
  const DistributedMesh& Whole() const { return this->Own.Whole(); }

  RankMesh Own;
  const vtkUnstructuredGrid* Piece = nullptr; ///< compared, never used
  vtkMTimeType PieceTime = 0;
};
}

std::unique_ptr<WholeSurface> WholeSurface::Make()
{
  return std::make_unique<GatheredBoundary>();
}

void GatheredBoundary::Take(
  vtkUnstructuredGrid* piece, morph::Monitor& monitor, const std::function<bool()>& needsAll)
{
  const bool isNew = this->Own.Take(piece, 1, GridMesh::UnknownCells::Refuse, monitor);
  const bool same =
    !isNew && this->Surface.Grid && this->Piece == piece && this->PieceTime == piece->GetMTime();
  if (this->Own.Ranks().sum(Index(!same)) > 0)
  {
    this->Own.RequireVolumeCells();
    this->Surface.Gather(this->Own, piece, false);
    this->Piece = piece;
    this->PieceTime = piece->GetMTime();
  }
  bool all = this->Surface.HasAll;
  this->Together([&] { all = all || (needsAll && needsAll()); });
  if (all && !this->Surface.HasAll)
  {
    this->Surface.Gather(this->Own, piece, true);
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

void GatheredBoundary::Together(const std::function<void()>& work) const
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

std::vector<std::uint8_t> GatheredBoundary::AnyFlags(const std::vector<std::uint8_t>& ofPiece) const
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
  std::vector<std::uint8_t> flags(this->Surface.NodeIds.size(), 0);
  for (const std::int64_t id : this->Own.Ranks().gather(ids))
  {
    flags[this->Surface.NodeOf(id)] = 1;
  }
  return flags;
}

void GatheredBoundary::KeepOwn(vtkPolyData* surface) const
{
  const int rank = this->Own.Ranks().rank();
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
    if (owner == rank)
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
  std::map<vtkIdType, vtkIdType> cellOf;
  for (Index c = 0; c < whole.pieceCells(); ++c)
  {
    if (whole.isGhost()[c] == 0)
    {
      cellOf.emplace(whole.cellId(c), c);
    }
  }
  renumber(result->GetCellData(), GatheredSurface::CellName, result->GetNumberOfCells(),
    [&cellOf](vtkIdType id) { return cellOf.at(id); });
  return result;
}

std::pair<double, double> GatheredBoundary::MaximumAndMean(
  const std::vector<Index>& points, const std::vector<double>& values) const
{
  struct Value
  {
    std::int64_t id;
    double value;
  };
  std::vector<Value> mine;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    mine.push_back({ this->Whole().nodeId(points[i]), values[i] });
  }
  std::map<std::int64_t, double> all;
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
  const Ranks ranks = GlobalRanks();
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
