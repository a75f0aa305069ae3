// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Distributed/GatheredSurface.h"

#include "Boundary/WholeBoundary.h"
#include "Mesh/FacesOfCells.h"
#include "Private/Blocks/BlockArrays.h"
#include "Private/Data/GridMesh.h"
#include "Private/Data/SubGrid.h"
#include "Private/Data/Surface.h"
#include "Private/Distributed/FieldTexts.h"
#include "Private/Distributed/GatherData.h"

#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

namespace morph::filters
{
using morph::Index;
using morph::distributed::DistributedMesh;
using morph::distributed::Ranks;

/// What a process tells of its cells with outer faces, beside their arrays.
struct GatheredSurface::CellRecord
{
  std::int64_t id, sign, body;
};

namespace
{
/// Where an item of the whole is: the number that a part has for it.
struct Origin
{
  std::int64_t id;
  int part;
  Index number;
};

template <typename Item>
std::vector<std::vector<Item>> gatherParts(
  const Ranks& ranks, const std::vector<Item>& mine, std::size_t& bytes)
{
  auto parts =
    ranks.exchange(std::vector<std::vector<Item>>(static_cast<std::size_t>(ranks.count()), mine));
  for (const std::vector<Item>& part : parts)
  {
    bytes += part.size() * sizeof(Item);
  }
  return parts;
}

/// The cells of the piece with an outer face, and its own two-dimensional cells.
vtkSmartPointer<vtkIdList> cellsOfSurface(const RankMesh& mesh)
{
  std::vector<Index> cells = mesh.Whole().outerFaces().cells;
  for (Index c = 0; c < mesh.Whole().pieceCells(); ++c)
  {
    if (mesh.Whole().isGhost()[c] == 0 && GridMesh::Dimension(mesh.Grid().types[c]) == 2)
    {
      cells.push_back(c);
    }
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  auto ids = vtkSmartPointer<vtkIdList>::New();
  for (const Index cell : cells)
  {
    ids->InsertNextId(static_cast<vtkIdType>(cell));
  }
  return ids;
}

/// Removes an array of ids, and returns them as global ones.
std::vector<std::int64_t> takeIds(
  vtkDataSetAttributes* data, const char* name, const std::vector<std::int64_t>& global)
{
  std::vector<std::int64_t> ids;
  auto* local = vtkIdTypeArray::SafeDownCast(data->GetAbstractArray(name));
  for (vtkIdType i = 0; i < local->GetNumberOfValues(); ++i)
  {
    ids.push_back(global[static_cast<std::size_t>(local->GetValue(i))]);
  }
  data->RemoveArray(name);
  data->RemoveArray(vtkDataSetAttributes::GhostArrayName());
  return ids;
}

/// The distinct ids of all parts, ascending, and the number of each part's item among them.
std::vector<std::int64_t> numberIds(
  const std::vector<std::vector<std::int64_t>>& parts, std::vector<vtkSmartPointer<vtkIdList>>& to)
{
  std::vector<std::int64_t> all;
  for (const auto& part : parts)
  {
    all.insert(all.end(), part.begin(), part.end());
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
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
  std::vector<std::int64_t> lowest(count, std::numeric_limits<std::int64_t>::max());
  for (Index c = 0; c < whole.pieceCells(); ++c)
  {
    const Index body = whole.bodies().ofCell[c];
    if (body >= 0 && whole.isGhost()[c] == 0)
    {
      lowest[body] = std::min(lowest[body], whole.cellId(c));
    }
  }
  const std::vector<std::int64_t> all = whole.ranks().gather(lowest);
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    lowest[i % count] = std::min(lowest[i % count], all[i]);
  }
  std::vector<std::int64_t> order = lowest;
  std::sort(order.begin(), order.end());
  this->NumberOfBody.clear();
  for (const std::int64_t cell : lowest)
  {
    this->NumberOfBody.push_back(
      std::lower_bound(order.begin(), order.end(), cell) - order.begin());
  }
}

void GatheredSurface::Gather(const RankMesh& mesh, vtkUnstructuredGrid* piece)
{
  const DistributedMesh& whole = mesh.Whole();
  this->NumberBodies(whole);
  const Ranks& ranks = whole.ranks();
  vtkNew<vtkUnstructuredGrid> mine;
  std::vector<std::int64_t> nodeIds, cellIds;
  std::vector<CellRecord> cells;
  std::vector<char> texts;
  ranks.together(
    [&]
    {
      const vtkSmartPointer<vtkIdList> chosen = cellsOfSurface(mesh);
      if (chosen->GetNumberOfIds() == 0)
      {
        return;
      }
      SubGrid::Extract(piece, chosen, mine);
      mine->GetFieldData()->ShallowCopy(piece->GetFieldData());
      texts = FieldTexts::Take(mine->GetFieldData());
      nodeIds = takeIds(mine->GetPointData(), Surface::IdName, whole.nodeIds());
      cellIds = takeIds(mine->GetCellData(), CellName, whole.cellIds());
      for (vtkIdType i = 0; i < chosen->GetNumberOfIds(); ++i)
      {
        const auto cell = static_cast<std::size_t>(chosen->GetId(i));
        const Index body = whole.bodies().ofCell[cell];
        cells.push_back({ whole.cellId(static_cast<Index>(cell)), whole.orientation()[cell],
          body < 0 ? body : this->NumberOfBody[body] });
      }
    });
  this->Bytes = 0;
  const auto parts = gatherData<vtkUnstructuredGrid>(ranks, mine, false, this->Bytes);
  const auto allNodes = gatherParts(ranks, nodeIds, this->Bytes);
  const auto allCells = gatherParts(ranks, cells, this->Bytes);
  const auto allTexts = gatherParts(ranks, texts, this->Bytes);
  const morph::WholeBoundary& boundary = mesh.Rest()->boundary();
  this->Bytes += boundary.bytes();
  ranks.together(
    [&]
    {
      for (std::size_t p = 0; p < parts.size(); ++p)
      {
        if (parts[p])
        {
          FieldTexts::Add(allTexts[p], parts[p]->GetFieldData());
        }
      }
      this->Assemble(parts, allNodes, allCells);
      this->DescribeFaces(boundary, whole.hasHanging());
    });
}

void GatheredSurface::Assemble(const std::vector<vtkSmartPointer<vtkUnstructuredGrid>>& parts,
  const std::vector<std::vector<std::int64_t>>& nodes,
  const std::vector<std::vector<CellRecord>>& cells)
{
  std::vector<vtkSmartPointer<vtkIdList>> nodeNumbers, cellNumbers, fromNodes, fromCells;
  std::vector<std::vector<std::int64_t>> cellIds;
  for (const std::vector<CellRecord>& part : cells)
  {
    auto& ids = cellIds.emplace_back();
    for (const CellRecord& cell : part)
    {
      ids.push_back(cell.id);
    }
  }
  this->NodeIds = numberIds(nodes, nodeNumbers);
  this->CellIds = numberIds(cellIds, cellNumbers);
  const auto nodeCount = static_cast<vtkIdType>(this->NodeIds.size());
  const auto cellCount = static_cast<vtkIdType>(this->CellIds.size());

  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataType(VTK_FLOAT);
  std::vector<Origin> origins;
  std::vector<BlockArrays::Part> ofPoints, ofCells;
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
    fromNodes.push_back(firstNumbers(part->GetNumberOfPoints()));
    fromCells.push_back(firstNumbers(part->GetNumberOfCells()));
    ofPoints.push_back({ part->GetPointData(), fromNodes.back(), nodeNumbers[p] });
    ofCells.push_back({ part->GetCellData(), fromCells.back(), cellNumbers[p] });
    for (std::size_t c = 0; c < cellIds[p].size(); ++c)
    {
      origins.push_back({ cellIds[p][c], static_cast<int>(p), static_cast<Index>(c) });
    }
  }
  points->SetNumberOfPoints(nodeCount);
  this->RankOfNode.assign(this->NodeIds.size(), std::numeric_limits<int>::max());
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    for (std::size_t n = 0; n < nodes[p].size(); ++n)
    {
      const vtkIdType node = nodeNumbers[p]->GetId(static_cast<vtkIdType>(n));
      points->SetPoint(node, parts[p]->GetPoint(static_cast<vtkIdType>(n)));
      this->RankOfNode[node] = std::min(this->RankOfNode[node], static_cast<int>(p));
    }
  }
  grid->SetPoints(points);
  std::sort(origins.begin(), origins.end(),
    [](const Origin& a, const Origin& b)
    { return std::tie(a.id, a.part) < std::tie(b.id, b.part); });
  grid->Allocate(cellCount);
  for (std::size_t i = 0; i < origins.size(); ++i)
  {
    if (i == 0 || origins[i].id != origins[i - 1].id)
    {
      vtkIdList* numbers = nodeNumbers[origins[i].part];
      SubGrid::InsertCell(
        parts[origins[i].part], origins[i].number,
        [numbers](vtkIdType node) { return numbers->GetId(node); }, grid);
    }
  }
  BlockArrays::Merge(ofPoints, nodeCount, grid->GetPointData());
  BlockArrays::Merge(ofCells, cellCount, grid->GetCellData());
  if (!origins.empty())
  {
    grid->GetFieldData()->ShallowCopy(parts[origins.front().part]->GetFieldData());
  }
  this->Shell = GridMesh::FromGrid(grid);

  this->DescribeCells(cells, cellNumbers);
  this->Grid = grid;
}

/// `divided`: nodes hang on edges of the faces.
void GatheredSurface::DescribeFaces(const morph::WholeBoundary& boundary, bool divided)
{
  const auto numberOf = [](const std::vector<std::int64_t>& ids, std::int64_t id)
  { return std::lower_bound(ids.begin(), ids.end(), id) - ids.begin(); };
  std::vector<std::pair<Index, int>> places;
  for (const Index f : boundary.faces().cells)
  {
    places.emplace_back(numberOf(this->CellIds, boundary.cells()[f]), boundary.faces().sides[f]);
  }
  this->Faces = morph::facesAt(this->Shell, places);
  if (divided)
  {
    std::vector<Index> corners;
    for (const Index node : boundary.faces().connectivity)
    {
      corners.push_back(numberOf(this->NodeIds, boundary.nodes()[node]));
    }
    morph::setCorners(boundary.faces().offsets, std::move(corners), this->Faces);
  }
}

void GatheredSurface::DescribeCells(const std::vector<std::vector<CellRecord>>& cells,
  const std::vector<vtkSmartPointer<vtkIdList>>& numbers)
{
  this->Orientation.assign(this->CellIds.size(), 1);
  this->RankOfCell.assign(this->CellIds.size(), std::numeric_limits<int>::max());
  this->BodyOfNode.assign(this->Shell.numberOfNodes(), -1);
  for (std::size_t p = 0; p < cells.size(); ++p)
  {
    for (std::size_t c = 0; c < cells[p].size(); ++c)
    {
      const auto cell = static_cast<Index>(numbers[p]->GetId(static_cast<vtkIdType>(c)));
      this->Orientation[cell] = static_cast<std::int8_t>(cells[p][c].sign);
      this->RankOfCell[cell] = std::min(this->RankOfCell[cell], static_cast<int>(p));
      for (Index k = 0; cells[p][c].body >= 0 && k < this->Shell.cellSize(cell); ++k)
      {
        this->BodyOfNode[this->Shell.cell(cell)[k]] = cells[p][c].body;
      }
    }
  }
}
}
