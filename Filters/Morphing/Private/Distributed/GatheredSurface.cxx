// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Distributed/GatheredSurface.h"

#include "Boundary/WholeBoundary.h"
#include "Mesh/Topology.h"
#include "Private/Blocks/BlockArrays.h"
#include "Private/Data/Arrays.h"
#include "Private/Data/GridMesh.h"
#include "Private/Data/SubGrid.h"
#include "Private/Data/Surface.h"
#include "Private/Distributed/GatherData.h"
#include "Private/Distributed/RankMesh.h"
#include "Private/RankBlocks/SharedCells.h"
#include "Support/Lists.h"

#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace morph::filters
{
using morph::Index;
using morph::distributed::DistributedMesh;
using morph::distributed::Ranks;

namespace
{
constexpr const char* BodyName = "MorphBodyOfCell";

/// The cells of the piece with an outer face, and its own two-dimensional cells, or all of its own.
std::vector<Index> cellsOfSurface(const RankMesh& mesh, bool all)
{
  std::vector<Index> cells = mesh.Rest()->outerFaces().cells;
  for (Index c = 0; c < mesh.Whole().pieceCells(); ++c)
  {
    const bool isTaken = all || GridMesh::Dimension(mesh.Grid().types[c]) == 2;
    if (isTaken && mesh.Whole().isGhost()[c] == 0)
    {
      cells.push_back(c);
    }
  }
  morph::sortUnique(cells);
  return cells;
}

/// Removes an array of whole numbers, and returns them.
std::vector<std::int64_t> take(vtkDataSetAttributes* data, const char* name)
{
  std::vector<std::int64_t> values = SharedCells::Numbers(data->GetArray(name));
  data->RemoveArray(name);
  return values;
}

/// The distinct ids of all parts, ascending, and the number of each part's item among them.
std::vector<std::int64_t> numberIds(
  const std::vector<std::vector<std::int64_t>>& parts, std::vector<vtkSmartPointer<vtkIdList>>& to)
{
  std::vector<std::int64_t> all = morph::distributed::joined(parts);
  morph::sortUnique(all);
  for (const auto& part : parts)
  {
    auto& numbers = to.emplace_back(vtkSmartPointer<vtkIdList>::New());
    for (const std::int64_t id : part)
    {
      numbers->InsertNextId(std::lower_bound(all.begin(), all.end(), id) - all.begin());
    }
  }
  return all;
}
}

vtkSmartPointer<vtkIdList> firstNumbers(vtkIdType count)
{
  auto ids = vtkSmartPointer<vtkIdList>::New();
  ids->SetNumberOfIds(count);
  for (vtkIdType i = 0; i < count; ++i)
  {
    ids->SetId(i, i);
  }
  return ids;
}

/// The order of the bodies' lowest cells, which is the serial one.
void GatheredSurface::NumberBodies(const DistributedMesh& whole)
{
  const auto count = static_cast<std::size_t>(whole.bodies().count);
  std::vector<double> first(count, -HUGE_VAL); // its negative, of which all tell the maximum
  for (Index c = 0; c < whole.pieceCells(); ++c)
  {
    const Index body = whole.bodies().ofCell[c];
    if (body >= 0 && whole.isGhost()[c] == 0)
    {
      first[body] = std::max(first[body], -static_cast<double>(whole.cellId(c)));
    }
  }
  whole.ranks().maximum(first.data(), count);
  std::vector<double> order = first;
  std::sort(order.rbegin(), order.rend());
  this->NumberOfBody.clear();
  for (const double cell : first)
  {
    this->NumberOfBody.push_back(
      std::lower_bound(order.begin(), order.end(), cell, std::greater<>()) - order.begin());
  }
}

void GatheredSurface::Gather(const RankMesh& mesh, vtkUnstructuredGrid* piece, bool all)
{
  const DistributedMesh& whole = mesh.Whole();
  this->Grid = nullptr; // in case of an error
  this->NumberBodies(whole);
  const Ranks& ranks = whole.ranks();
  vtkNew<vtkUnstructuredGrid> mine;
  ranks.together(
    [&]
    {
      const std::vector<Index> cells = cellsOfSurface(mesh, all);
      if (cells.empty())
      {
        return;
      }
      vtkNew<vtkIdList> ids;
      std::for_each(cells.begin(), cells.end(), [&](Index cell) { ids->InsertNextId(cell); });
      SubGrid::Extract(piece, ids, mine);
      mesh.WriteGlobalIds(mine);
      mine->GetCellData()->AddArray(Arrays::MakeOf<vtkIdTypeArray>(BodyName, cells,
        [&](Index cell)
        {
          const Index body = whole.bodies().ofCell[cell];
          return body < 0 ? body : this->NumberOfBody[body];
        }));
      mine->GetPointData()->RemoveArray(vtkDataSetAttributes::GhostArrayName());
      mine->GetCellData()->RemoveArray(vtkDataSetAttributes::GhostArrayName());
      mine->GetFieldData()->ShallowCopy(piece->GetFieldData());
    });
  const morph::WholeBoundary& boundary = mesh.Rest()->boundary();
  const Index front = mesh.Grid().layer.nodes,
              behind = ranks.maximum(front > 0 ? whole.nodeId(front) - whole.nodeId(0) : 0);
  this->Bytes = boundary.bytes();
  const auto parts = gatherData<vtkXMLUnstructuredGridWriter, vtkXMLUnstructuredGridReader>(
    ranks, mine.Get(), false, this->Bytes);
  ranks.together(
    [&]
    {
      this->Assemble(parts);
      this->MarkLayer(mesh.Grid().layer, behind);
      this->DescribeFaces(boundary, whole.hasHanging());
    });
  this->HasAll = all;
}

/// A node may be in several parts, a cell is in one.
void GatheredSurface::Assemble(const std::vector<vtkSmartPointer<vtkUnstructuredGrid>>& parts)
{
  std::vector<vtkSmartPointer<vtkIdList>> nodeNumbers, cellNumbers, from;
  std::vector<std::vector<std::int64_t>> nodes, cells, bodies;
  for (const auto& part : parts)
  {
    nodes.push_back(take(part->GetPointData(), Surface::IdName));
    cells.push_back(take(part->GetCellData(), CellName));
    bodies.push_back(take(part->GetCellData(), BodyName));
  }
  this->NodeIds = numberIds(nodes, nodeNumbers);
  this->CellIds = numberIds(cells, cellNumbers);
  const auto nodeCount = static_cast<vtkIdType>(this->NodeIds.size());
  const auto cellCount = static_cast<vtkIdType>(this->CellIds.size());
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataType(VTK_FLOAT);
  std::vector<vtkIdType> numberInPart(this->CellIds.size());
  std::vector<BlockArrays::Part> ofPoints, ofCells;
  this->RankOfNode.assign(this->NodeIds.size(), -1);
  this->RankOfCell.assign(this->CellIds.size(), -1);
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    if (cells[p].empty())
    {
      continue;
    }
    vtkUnstructuredGrid* part = parts[p];
    if (part->GetPoints()->GetDataType() != VTK_FLOAT)
    {
      points->SetDataTypeToDouble();
    }
    from.push_back(firstNumbers(part->GetNumberOfPoints()));
    ofPoints.push_back({ part->GetPointData(), from.back(), nodeNumbers[p] });
    from.push_back(firstNumbers(part->GetNumberOfCells()));
    ofCells.push_back({ part->GetCellData(), from.back(), cellNumbers[p] });
    if (ofCells.size() == 1)
    {
      grid->GetFieldData()->ShallowCopy(part->GetFieldData());
    }
    for (vtkIdType c = 0; c < part->GetNumberOfCells(); ++c)
    {
      this->RankOfCell[cellNumbers[p]->GetId(c)] = static_cast<int>(p);
      numberInPart[cellNumbers[p]->GetId(c)] = c;
    }
  }
  points->SetNumberOfPoints(nodeCount);
  for (std::size_t p = parts.size(); p-- > 0;)
  {
    for (vtkIdType n = 0; n < parts[p]->GetNumberOfPoints(); ++n)
    {
      points->SetPoint(nodeNumbers[p]->GetId(n), parts[p]->GetPoint(n));
      this->RankOfNode[nodeNumbers[p]->GetId(n)] = static_cast<int>(p);
    }
  }
  grid->SetPoints(points);
  grid->Allocate(cellCount);
  for (vtkIdType c = 0; c < cellCount; ++c)
  {
    const int p = this->RankOfCell[c];
    SubGrid::InsertCell(
      parts[p], numberInPart[c], [&](vtkIdType node) { return nodeNumbers[p]->GetId(node); }, grid);
  }
  BlockArrays::Merge(ofPoints, nodeCount, grid->GetPointData());
  BlockArrays::Merge(ofCells, cellCount, grid->GetCellData());
  this->Shell = GridMesh::FromGrid(grid);
  this->BodyOfNode.assign(this->NodeIds.size(), -1);
  for (vtkIdType c = 0; c < cellCount; ++c)
  {
    const std::int64_t body = bodies[this->RankOfCell[c]][numberInPart[c]];
    for (Index k = 0; body >= 0 && k < this->Shell.cellSize(c); ++k)
    {
      this->BodyOfNode[this->Shell.cell(c)[k]] = body;
    }
  }
  this->Grid = grid;
}

/// `layer`: of a piece. `behind`: by which the ids of images are above those of their nodes.
void GatheredSurface::MarkLayer(morph::ShellLayer layer, Index behind)
{
  layer.nodes =
    std::lower_bound(this->NodeIds.begin(), this->NodeIds.end(), behind) - this->NodeIds.begin();
  this->Shell.layer = layer;
  GridMesh::MarkLayer(layer, layer.nodes, this->Grid);
}

/// `divided`: nodes hang on edges of the faces.
void GatheredSurface::DescribeFaces(const morph::WholeBoundary& boundary, bool divided)
{
  std::vector<std::pair<Index, int>> places;
  for (const Index f : boundary.faces().cells)
  {
    const auto cell =
      std::lower_bound(this->CellIds.begin(), this->CellIds.end(), boundary.cells()[f]);
    places.emplace_back(cell - this->CellIds.begin(), boundary.faces().sides[f]);
  }
  this->Faces = morph::facesAt(this->Shell, places);
  this->Orientation.assign(this->CellIds.size(), 1);
  for (const Index f : boundary.faces().cells)
  {
    this->Orientation[this->Faces.cells[f]] = boundary.orientation()[f];
  }
  if (divided)
  {
    std::vector<Index> corners;
    for (const Index node : boundary.faces().connectivity)
    {
      corners.push_back(this->NodeOf(boundary.nodes()[node]));
    }
    morph::setCorners(boundary.faces().offsets, std::move(corners), this->Faces);
  }
}
}
