// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Distributed/RankMesh.h"

#include "Distributed/RankCommunicator.h"
#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Morpher/SiteMethod.h"
#include "Private/Data/Arrays.h"
#include "Private/Data/GridMesh.h"
#include "Private/Data/Surface.h"
#include "Private/Distributed/OnRanks.h"
#include "Private/RankBlocks/GlobalRanks.h"
#include "Private/RankBlocks/SharedCells.h"
#include "Support/Error.h"

#include <vtkCellData.h>
#include <vtkDataSetAttributes.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

namespace morph::filters
{
void renumber(vtkDataSetAttributes* data, const char* name, vtkIdType count,
  const std::function<vtkIdType(vtkIdType)>& number)
{
  vtkDataArray* before = data->GetArray(name);
  if (!before)
  {
    return;
  }
  auto after = Arrays::Make<vtkIdTypeArray>(name, count); // others may share the old one
  for (vtkIdType i = 0; i < count; ++i)
  {
    const auto value = static_cast<vtkIdType>(before->GetComponent(i, 0));
    after->SetValue(i, value < 0 ? value : number(value));
  }
  data->AddArray(after);
}

RankMesh::RankMesh()
  : Processes(GlobalRanks())
{
}

bool RankMesh::Take(vtkUnstructuredGrid* grid, const std::string& method,
  const CreateMorpher& create, morph::Monitor& monitor)
{
  const std::unique_ptr<morph::Morpher> sample = morph::onProcesses(create());
  if (!sample)
  {
    throw morph::Error(method +
                       " needs one MPI rank, and the mesh is distributed over several. Run on one, "
                       "or use another method, Morph Inversion Free for instance.");
  }
  const bool isTaken = this->Take(grid, sample->layers(), GridMesh::UnknownCells::Refuse, monitor);
  this->RequireVolumeCells();
  return isTaken;
}

bool RankMesh::Take(
  vtkUnstructuredGrid* grid, int layers, GridMesh::UnknownCells unknown, morph::Monitor& monitor)
{
  const morph::distributed::Ranks& ranks = this->Processes;
  std::vector<std::int64_t> nodeIds = SharedCells::Numbers(grid->GetPointData()->GetGlobalIds());
  std::vector<std::int64_t> cellIds = SharedCells::Numbers(grid->GetCellData()->GetGlobalIds());
  std::vector<std::uint8_t> ghosts = SharedCells::Ghosts(grid);
  const bool same = this->Distributed && this->Layers >= layers && nodeIds == this->NodeIds &&
                    cellIds == this->CellIds && ghosts == this->Ghosts &&
                    GridMesh::SameCells(grid, this->Copy) && GridMesh::SamePoints(grid, this->Copy);
  this->Front = GridMesh::PointsOfFront(grid);
  if (ranks.sum(morph::Index(!same)) == 0)
  {
    return false;
  }
  this->Layers = 0; // until all is made
  this->Distributed.reset();
  this->Undeformed.reset();
  ranks.together(
    [&]
    {
      try
      {
        this->Copy = GridMesh::FromGrid(grid, unknown);
      }
      catch (const morph::Error& error)
      {
        throw morph::Error(error.kind(), std::string(error.what()) + " Ids are those of MPI rank " +
                                           std::to_string(ranks.rank()) + "'s piece.");
      }
    });
  morph::distributed::Piece piece{ this->Copy, ghosts, nodeIds, cellIds };
  morph::distributed::requireNodeIds(ranks, piece);
  morph::distributed::requireCellIds(ranks, piece);
  auto whole =
    std::make_shared<morph::distributed::DistributedMesh>(ranks, std::move(piece), layers, monitor);
  const morph::Index others = whole->mesh().numberOfNodes() - this->Copy.numberOfNodes();
  if (this->Copy.layer.nodes > 0 && ranks.sum(others) > 0) // a layer is one on all processes
  {
    throw morph::Error("Edges of the mesh of triangles and quadrilaterals are divided on one side "
                       "alone, which several MPI ranks cannot morph. Divide both sides alike, or "
                       "run on one rank.");
  }
  const morph::Index cells = whole->pieceCells();
  this->Skip.assign(whole->isGhost().begin(), whole->isGhost().begin() + cells);
  // Of the whole mesh, in which one of several copies of a cell counts.
  const auto dimension = [&whole](morph::Index c)
  { return GridMesh::Dimension(whole->mesh().types[c]); };
  morph::Index highest = 0;
  for (morph::Index c = 0; c < cells; ++c)
  {
    highest = std::max<morph::Index>(highest, dimension(c));
  }
  this->Dimension = static_cast<int>(ranks.maximum(highest));
  for (morph::Index c = 0; c < cells; ++c)
  {
    this->Skip[c] |= dimension(c) < this->Dimension;
  }
  this->NodeIds = std::move(nodeIds);
  this->CellIds = std::move(cellIds);
  this->Ghosts = std::move(ghosts);
  this->Undeformed = morph::distributed::undeformedMesh(whole, monitor);
  this->Distributed = std::move(whole);
  this->Polygons = {};
  ranks.together(
    [&] {
      this->Polygons.Make(grid, this->Copy, this->FacesOfPiece(), &this->Undeformed->orientation());
    });
  this->Layers = layers;
  return true;
}

void RankMesh::SetFeatureLines(bool on, morph::Monitor& monitor)
{
  const morph::distributed::DistributedMesh& whole = *this->Distributed;
  const auto isBefore = [&](morph::Index a, morph::Index b)
  { return whole.cellId(a) < whole.cellId(b); };
  // The lowest cell at an edge is known where any is: all cells around the piece's nodes are here.
  const auto isDrawn = [&](const std::vector<morph::Index>& cells)
  { return whole.isGhost()[*std::min_element(cells.begin(), cells.end(), isBefore)] == 0; };
  this->Processes.together(
    [&]
    {
      if (on != this->Polygons.HasFeatureLines())
      {
        const morph::BoundaryFaces faces =
          on ? morph::boundaryFaces(
                 whole.mesh(), morph::facesOfOneCell(whole.mesh(), monitor), whole.hanging())
             : morph::BoundaryFaces();
        this->Polygons.SetFeatureLines(on, whole.mesh(), faces, isDrawn);
      }
    });
}

morph::BoundaryFaces RankMesh::FacesOfPiece() const
{
  const morph::BoundaryFaces& all = this->Undeformed->outerFaces();
  const morph::Mesh& mesh = this->Whole().mesh();
  if (this->Whole().hanging().empty())
  {
    return all;
  }
  morph::BoundaryFaces faces =
    morph::facesOfCells(mesh, all, std::vector<std::uint8_t>(mesh.types.size(), 1));
  std::vector<morph::Index> offsets = { 0 }, connectivity;
  for (std::size_t f = 0; f < all.cells.size(); ++f)
  {
    std::copy_if(all.connectivity.begin() + all.offsets[f],
      all.connectivity.begin() + all.offsets[f + 1], std::back_inserter(connectivity),
      [this](morph::Index node) { return node < this->Whole().pieceNodes(); });
    offsets.push_back(static_cast<morph::Index>(connectivity.size()));
  }
  morph::setCorners(std::move(offsets), std::move(connectivity), faces);
  return faces;
}

const morph::Points& RankMesh::OfGrid(const morph::Points& moved, morph::Points& memory) const
{
  memory = moved;
  this->Whole().copyToDoubles(memory);
  memory.conservativeResize(this->Copy.numberOfNodes(), 3);
  return memory;
}

BoundaryMatch::Nodes RankMesh::Nodes() const
{
  const morph::distributed::DistributedMesh& whole = this->Whole();
  return { whole.mesh(), this->Undeformed->outerNodes(), whole.size(), &whole.nodeIds(),
    [&whole](morph::Index id) { return whole.nodeOf(id); }, this->Front };
}

void RankMesh::RequireVolumeCells() const
{
  if (this->Distributed->volumeCells() == 0)
  {
    throw morph::Error("None of the input's cells is a volume cell. Tetrahedra, hexahedra, wedges "
                       "or pyramids are needed.");
  }
  morph::requireExtent(this->Distributed->size(), "The input's volume mesh");
}

void RankMesh::WriteUndeformedSurface(vtkUnstructuredGrid* grid, vtkPolyData* output) const
{
  output->Initialize();
  if (this->Distributed && grid->GetNumberOfCells() > 0 && GridMesh::SameCells(grid, this->Copy))
  {
    this->Polygons.Write(grid->GetPoints(), output);
    this->WriteGlobalIds(output);
  }
}

void RankMesh::WriteGlobalIds(vtkDataSet* output) const
{
  const morph::distributed::DistributedMesh& whole = *this->Distributed;
  renumber(output->GetPointData(), Surface::IdName, output->GetNumberOfPoints(),
    [&](vtkIdType node) { return static_cast<vtkIdType>(whole.nodeId(node)); });
  renumber(output->GetCellData(), "MorphCellId", output->GetNumberOfCells(),
    [&](vtkIdType cell) { return static_cast<vtkIdType>(whole.cellId(cell)); });
}

std::unique_ptr<KeptMesh> OnRanks::MakeMesh()
{
  return std::make_unique<RankMesh>();
}
}
