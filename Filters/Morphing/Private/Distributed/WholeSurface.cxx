// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Distributed/WholeSurface.h"

#include "Mesh/FacesOfCells.h"
#include "Private/Blocks/BlockArrays.h"
#include "Private/Data/GridMesh.h"
#include "Private/Data/SubGrid.h"
#include "Private/Data/Surface.h"
#include "Private/Distributed/RankMatch.h"
#include "Private/Distributed/RankMesh.h"
#include "Support/Error.h"

#include <vtkAppendPolyData.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCharArray.h>
#include <vtkCommunicator.h>
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
namespace
{
using morph::Index;
using morph::distributed::DistributedMesh;
using morph::distributed::Ranks;

constexpr const char* CellName = "MorphCellId";

/// What a process tells of its cells with outer faces, beside their arrays.
struct CellRecord
{
  std::int64_t id, sign, body;
};

struct FaceRecord
{
  std::int64_t cell, side;
};

/// Where an item of the whole is: the number that a part has for it.
struct Origin
{
  std::int64_t id;
  int part;
  Index number;
};

/// All processes' data objects. `onlyDistinct`: without those that are equal to an earlier one.
template <typename Data>
std::vector<vtkSmartPointer<Data>> gather(
  const Ranks& ranks, Data* mine, bool onlyDistinct, std::size_t& bytes)
{
  vtkNew<vtkCharArray> buffer;
  ranks.together(
    [&]
    {
      if (!vtkCommunicator::MarshalDataObject(mine, buffer))
      {
        throw morph::Error("The boundary cannot be sent to the other MPI ranks.");
      }
    });
  const std::vector<char> packed(
    buffer->GetPointer(0), buffer->GetPointer(0) + buffer->GetNumberOfValues());
  const auto messages =
    ranks.exchange(std::vector<std::vector<char>>(static_cast<std::size_t>(ranks.count()), packed));
  std::vector<vtkSmartPointer<Data>> result;
  ranks.together(
    [&]
    {
      for (auto message = messages.begin(); message != messages.end(); ++message)
      {
        const std::vector<char>& one = *message;
        bytes += one.size();
        if (onlyDistinct && std::find(messages.begin(), message, one) != message)
        {
          continue;
        }
        buffer->SetNumberOfValues(static_cast<vtkIdType>(one.size()));
        std::copy(one.begin(), one.end(), buffer->GetPointer(0));
        result.emplace_back(Data::SafeDownCast(vtkCommunicator::UnMarshalDataObject(buffer.Get())));
      }
    });
  return result;
}

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
    if (mesh.Whole().isGhost()[c] == 0 && GridMesh::Dimension(mesh.Piece().types[c]) == 2)
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

void translate(vtkDataSetAttributes* data, const char* name, vtkIdType count,
  const std::function<vtkIdType(vtkIdType)>& number)
{
  vtkDataArray* before = data->GetArray(name);
  if (!before)
  {
    return;
  }
  vtkNew<vtkIdTypeArray> after; // others may share the array
  after->SetName(name);
  after->SetNumberOfValues(count);
  for (vtkIdType i = 0; i < count; ++i)
  {
    const auto value = static_cast<vtkIdType>(before->GetComponent(i, 0));
    after->SetValue(i, value < 0 ? value : number(value));
  }
  data->AddArray(after);
}
}

class WholeSurface::Internals
{
public:
  RankMesh Mesh;
  const vtkUnstructuredGrid* Piece = nullptr; ///< compared, never used
  vtkMTimeType PieceTime = 0;
  vtkSmartPointer<vtkUnstructuredGrid> Grid;
  morph::Mesh Shell; ///< Grid as a mesh
  morph::BoundaryFaces Faces;
  std::vector<Index> BodyOfNode;
  std::vector<std::int8_t> Orientation;
  std::vector<std::int64_t> NodeIds, CellIds; ///< of Grid
  std::vector<int> RankOfNode, RankOfCell;    ///< of Grid: the lowest one
  std::vector<Index> NumberOfBody;            ///< by the number that the distributed mesh has
  std::size_t Bytes = 0;

  const DistributedMesh& Whole() const { return this->Mesh.Whole(); }
  void NumberBodies();
  void Gather(vtkUnstructuredGrid* piece);
  void Assemble(const std::vector<vtkSmartPointer<vtkUnstructuredGrid>>& parts,
    const std::vector<std::vector<std::int64_t>>& nodes,
    const std::vector<std::vector<CellRecord>>& cells,
    const std::vector<std::vector<FaceRecord>>& faces);
  void DescribeCells(const std::vector<std::vector<CellRecord>>& cells,
    const std::vector<vtkSmartPointer<vtkIdList>>& numbers);
};

/// The order of the bodies' lowest cells, which is the serial one.
void WholeSurface::Internals::NumberBodies()
{
  const DistributedMesh& whole = this->Whole();
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

void WholeSurface::Internals::Gather(vtkUnstructuredGrid* piece)
{
  const DistributedMesh& whole = this->Whole();
  const Ranks& ranks = whole.ranks();
  vtkNew<vtkUnstructuredGrid> mine;
  std::vector<std::int64_t> nodeIds, cellIds;
  std::vector<CellRecord> cells;
  std::vector<FaceRecord> faces;
  ranks.together(
    [&]
    {
      const vtkSmartPointer<vtkIdList> chosen = cellsOfSurface(this->Mesh);
      if (chosen->GetNumberOfIds() == 0)
      {
        return;
      }
      SubGrid::Extract(piece, chosen, mine);
      mine->GetFieldData()->ShallowCopy(piece->GetFieldData());
      nodeIds = takeIds(mine->GetPointData(), Surface::IdName, whole.nodeIds());
      cellIds = takeIds(mine->GetCellData(), CellName, whole.cellIds());
      for (vtkIdType i = 0; i < chosen->GetNumberOfIds(); ++i)
      {
        const auto cell = static_cast<std::size_t>(chosen->GetId(i));
        const Index body = whole.bodies().ofCell[cell];
        cells.push_back({ whole.cellId(static_cast<Index>(cell)), whole.orientation()[cell],
          body < 0 ? body : this->NumberOfBody[body] });
      }
      const morph::BoundaryFaces& outer = whole.outerFaces();
      for (std::size_t f = 0; f < outer.cells.size(); ++f)
      {
        faces.push_back({ whole.cellId(outer.cells[f]), outer.sides[f] });
      }
    });
  this->Bytes = 0;
  const auto parts = gather<vtkUnstructuredGrid>(ranks, mine, false, this->Bytes);
  const auto allNodes = gatherParts(ranks, nodeIds, this->Bytes);
  const auto allCells = gatherParts(ranks, cells, this->Bytes);
  const auto allFaces = gatherParts(ranks, faces, this->Bytes);
  ranks.together([&] { this->Assemble(parts, allNodes, allCells, allFaces); });
}

void WholeSurface::Internals::Assemble(
  const std::vector<vtkSmartPointer<vtkUnstructuredGrid>>& parts,
  const std::vector<std::vector<std::int64_t>>& nodes,
  const std::vector<std::vector<CellRecord>>& cells,
  const std::vector<std::vector<FaceRecord>>& faces)
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

  std::vector<std::pair<Index, int>> places;
  for (const std::vector<FaceRecord>& part : faces)
  {
    for (const FaceRecord& face : part)
    {
      places.emplace_back(std::lower_bound(this->CellIds.begin(), this->CellIds.end(), face.cell) -
                            this->CellIds.begin(),
        static_cast<int>(face.side));
    }
  }
  std::sort(places.begin(), places.end());
  this->Faces = morph::facesAt(this->Shell, places);
  this->DescribeCells(cells, cellNumbers);
  this->Grid = grid;
}

void WholeSurface::Internals::DescribeCells(const std::vector<std::vector<CellRecord>>& cells,
  const std::vector<vtkSmartPointer<vtkIdList>>& numbers)
{
  this->Orientation.assign(this->CellIds.size(), 1);
  this->RankOfCell.assign(this->CellIds.size(), std::numeric_limits<int>::max());
  const std::vector<Index> isCorner = morph::connectedComponents(this->Shell).ofNode;
  this->BodyOfNode.assign(isCorner.size(), -1);
  for (std::size_t p = 0; p < cells.size(); ++p)
  {
    for (std::size_t c = 0; c < cells[p].size(); ++c)
    {
      const auto cell = static_cast<Index>(numbers[p]->GetId(static_cast<vtkIdType>(c)));
      this->Orientation[cell] = static_cast<std::int8_t>(cells[p][c].sign);
      this->RankOfCell[cell] = std::min(this->RankOfCell[cell], static_cast<int>(p));
      for (Index k = 0; cells[p][c].body >= 0 && k < this->Shell.cellSize(cell); ++k)
      {
        const Index node = this->Shell.cell(cell)[k];
        this->BodyOfNode[node] = isCorner[node] < 0 ? -1 : cells[p][c].body;
      }
    }
  }
}

WholeSurface::WholeSurface()
  : Own(new Internals)
{
}

WholeSurface::~WholeSurface() = default;

void WholeSurface::Take(vtkUnstructuredGrid* piece, morph::Monitor& monitor)
{
  Internals& own = *this->Own;
  const bool isNew = own.Mesh.Take(piece, 1, GridMesh::UnknownCells::Refuse, monitor);
  const bool same = !isNew && own.Grid && own.Piece == piece && own.PieceTime == piece->GetMTime();
  if (own.Mesh.Ranks().sum(Index(!same)) == 0)
  {
    return;
  }
  own.Grid = nullptr;
  own.Mesh.RequireVolumeCells();
  own.NumberBodies();
  own.Gather(piece);
  own.Piece = piece;
  own.PieceTime = piece->GetMTime();
}

vtkUnstructuredGrid* WholeSurface::Grid() const
{
  return this->Own->Grid;
}

const morph::Mesh& WholeSurface::Mesh() const
{
  return this->Own->Shell;
}

const morph::BoundaryFaces& WholeSurface::Faces() const
{
  return this->Own->Faces;
}

const std::vector<Index>& WholeSurface::BodyOfNode() const
{
  return this->Own->BodyOfNode;
}

const std::vector<std::int8_t>& WholeSurface::Orientation() const
{
  return this->Own->Orientation;
}

double WholeSurface::Size() const
{
  return this->Own->Whole().size();
}

std::size_t WholeSurface::Bytes() const
{
  return this->Own->Bytes;
}

Index WholeSurface::NumberOfBodies() const
{
  return static_cast<Index>(this->Own->NumberOfBody.size());
}

std::vector<Index> WholeSurface::Places() const
{
  const Internals& own = *this->Own;
  const DistributedMesh& whole = own.Whole();
  const morph::Mesh& piece = own.Mesh.Piece();
  const Index nodes = own.Shell.numberOfNodes();
  // By ids, since ghost cells of the piece may have points of their own.
  std::vector<Index> body(whole.mesh().numberOfNodes(), -1);
  for (Index c = 0; c < whole.mesh().numberOfCells(); ++c)
  {
    for (Index k = 0; whole.bodies().ofCell[c] >= 0 && k < whole.mesh().cellSize(c); ++k)
    {
      body[whole.mesh().cell(c)[k]] = own.NumberOfBody[whole.bodies().ofCell[c]];
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
    const bool isOuter =
      node >= 0 && std::binary_search(own.Faces.nodes.begin(), own.Faces.nodes.end(), node);
    const Index of = bodyOf(n);
    places.push_back(isOuter ? node : nodes + (of < 0 ? this->NumberOfBodies() : of));
  }
  return places;
}

Index WholeSurface::NodeOf(std::int64_t id) const
{
  const std::vector<std::int64_t>& ids = this->Own->NodeIds;
  const auto found = std::lower_bound(ids.begin(), ids.end(), id);
  return found != ids.end() && *found == id ? static_cast<Index>(found - ids.begin()) : -1;
}

BoundaryMatch::Result WholeSurface::Match(
  vtkPointSet* boundary, const BoundaryMatch::Options& options) const
{
  const Internals& own = *this->Own;
  RankMatch::Gathered gathered = RankMatch::Gather(boundary, own.Whole(), options);
  BoundaryMatch::Result result;
  own.Mesh.Ranks().together(
    [&]
    {
      BoundaryMatch::NamedPoints& named = gathered.Points;
      if (gathered.ByPosition)
      {
        named.Pairs = BoundaryMatch::FindByPosition(named.Positions, own.Shell, own.Faces.nodes,
          options.MatchTolerance * this->Size(), named.Unmatched);
      }
      else
      {
        std::vector<std::pair<Index, Index>> pairs;
        for (const auto& [point, id] : named.Pairs)
        {
          if (const Index node = this->NodeOf(id); node >= 0)
          {
            pairs.emplace_back(point, node);
          }
        }
        named.Pairs = std::move(pairs);
      }
      result = BoundaryMatch::FindTargets(
        std::move(named), own.Shell, own.Faces, this->Size(), options, &own.NodeIds);
    });
  return result;
}

void WholeSurface::Together(const std::function<void()>& work) const
{
  this->Own->Mesh.Ranks().together(
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

std::vector<std::uint8_t> WholeSurface::AnyFlags(const std::vector<std::uint8_t>& ofPiece) const
{
  std::vector<std::int64_t> ids;
  for (std::size_t n = 0; n < ofPiece.size(); ++n)
  {
    const std::int64_t id = this->Own->Whole().nodeId(static_cast<Index>(n));
    if (ofPiece[n] != 0 && this->NodeOf(id) >= 0)
    {
      ids.push_back(id);
    }
  }
  std::vector<std::uint8_t> flags(this->Own->NodeIds.size(), 0);
  for (const std::int64_t id : this->Own->Mesh.Ranks().gather(ids))
  {
    flags[this->NodeOf(id)] = 1;
  }
  return flags;
}

void WholeSurface::KeepOwn(vtkPolyData* surface) const
{
  const Internals& own = *this->Own;
  const int rank = own.Mesh.Ranks().rank();
  vtkDataArray* behind = surface->GetCellData()->GetArray(CellName);
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
          ? own.RankOfCell[static_cast<Index>(behind->GetComponent(cell, 0))] == rank
          : own.RankOfNode[static_cast<Index>(nodeOf->GetComponent(corners->GetId(0), 0))] == rank;
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
  translate(kept->GetPointData(), Surface::IdName, kept->GetNumberOfPoints(),
    [&own](vtkIdType node) { return static_cast<vtkIdType>(own.NodeIds[node]); });
  translate(kept->GetCellData(), CellName, kept->GetNumberOfCells(),
    [&own](vtkIdType of) { return static_cast<vtkIdType>(own.CellIds[of]); });
  surface->ShallowCopy(kept);
}

vtkSmartPointer<vtkPolyData> WholeSurface::OfPiece(vtkPolyData* surface) const
{
  const DistributedMesh& whole = this->Own->Whole();
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->ShallowCopy(surface);
  translate(result->GetPointData(), Surface::IdName, result->GetNumberOfPoints(),
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
  translate(result->GetCellData(), CellName, result->GetNumberOfCells(),
    [&cells](vtkIdType id)
    {
      const auto found =
        std::lower_bound(cells.begin(), cells.end(), std::pair<std::int64_t, Index>(id, -1));
      return static_cast<vtkIdType>(found->second);
    });
  return result;
}

std::vector<std::int64_t> WholeSurface::IdsOfPiece(const std::vector<Index>& points) const
{
  std::vector<std::int64_t> ids;
  for (const Index point : points)
  {
    ids.push_back(this->Own->Whole().nodeId(point));
  }
  return ids;
}

std::pair<double, double> WholeSurface::MaximumAndMean(
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
  all = this->Own->Mesh.Ranks().gather(all);
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

vtkSmartPointer<vtkPolyData> WholeSurface::Gather(vtkPolyData* part)
{
  std::size_t bytes = 0;
  const Ranks ranks = GlobalRanks();
  const auto parts = gather<vtkPolyData>(ranks, part, true, bytes);
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
