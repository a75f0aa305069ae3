// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Pipeline/Input.h"

#include "Mesh/CellShape.h"
#include "Private/Blocks/BlockCells.h"
#include "Private/Blocks/Blocks.h"
#include "Private/Blocks/Leaves.h"
#include "Private/Data/DataCheck.h"
#include "Private/Data/GridMesh.h"
#include "Private/Data/Unchanged.h"
#include "Private/Data/Version.h"
#include "Private/Pipeline/Ranks.h"
#include "Private/RankBlocks/RankBlocks.h"
#include "Support/Error.h"

#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <exception>
#include <string>

namespace morph::filters
{
namespace
{
[[noreturn]] void refuse(vtkDataObject* input, const char* port, const char* needed)
{
  const std::string subject(port);
  if (!input)
  {
    throw morph::Error(subject + " has no data; " + needed + " is needed.");
  }
  const std::string type = input->GetClassName();
  if (vtkCompositeDataSet::SafeDownCast(input))
  {
    throw morph::Error(subject + " is composite data (" + type + "); " + needed +
                       " is needed. Apply Merge Blocks first.");
  }
  throw morph::Error(subject + " is a " + type + "; " + needed + " is needed.");
}

/// The input, or its blocks as one grid, which all processes make together if several have some.
vtkDataObject* gather(vtkDataObject* input, Blocks& blocks, int coincident,
  GridMesh::UnknownCells unknown, morph::Monitor& monitor)
{
  const bool isTree = Leaves::TreeOf(input);
  const bool areOnRanks =
    Ranks::TakePieces() && Ranks::Count(isTree) > 0 && Ranks::Count(Input::HasPoints(input)) > 1;
  if (!areOnRanks)
  {
    return blocks.Gather(input, coincident, unknown, monitor);
  }
  Ranks::Together(
    [&]
    {
      if (!isTree && Input::HasPoints(input))
      {
        throw morph::Error("The input is composite data on some MPI ranks, and a " +
                           std::string(input->GetClassName()) +
                           " on others. Give composite data on all ranks.");
      }
    });
  if (Ranks::Count(!blocks.IsKept(input, coincident, unknown)) > 0)
  {
    blocks.Forget();
    blocks.Keep(RankBlocks::Make(blocks.Tree(), Blocks::OptionsOf(coincident, unknown)));
  }
  return blocks.Tell(monitor);
}

bool hasVolumeCells(vtkDataObject* data)
{
  auto* grid = vtkUnstructuredGrid::SafeDownCast(data);
  vtkDataArray* types = grid ? Version::CellTypes(grid) : nullptr;
  const vtkIdType cells =
    types ? std::min(types->GetNumberOfValues(), grid->GetNumberOfCells()) : 0;
  for (vtkIdType cell = 0; cell < cells; ++cell)
  {
    const morph::CellShape* shape =
      morph::cellShape(static_cast<std::uint8_t>(types->GetComponent(cell, 0)));
    if (shape && shape->dimension == 3)
    {
      return true;
    }
  }
  return false;
}
}

namespace Input
{
vtkUnstructuredGrid* RequireGrid(vtkDataObject* input, const char* port)
{
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(input))
  {
    DataCheck::Require(grid, port, DataCheck::Cells::InCore);
    return grid;
  }
  refuse(input, port, "an unstructured grid (Append Datasets makes one of any data set)");
}

vtkUnstructuredGrid* RequireGrid(vtkDataObject* input, const char* port, Unchanged& checked)
{
  auto* grid = vtkUnstructuredGrid::SafeDownCast(input);
  if (grid && checked.Is(grid))
  {
    DataCheck::RequireLengths(grid, port);
    return grid;
  }
  grid = RequireGrid(input, port);
  checked.See(grid);
  return grid;
}

vtkPointSet* RequirePointSet(vtkDataObject* input, const char* port)
{
  if (auto* points = vtkPointSet::SafeDownCast(input))
  {
    DataCheck::Require(points, port);
    return points;
  }
  refuse(input, port, "a data set with points of its own (polygonal data or an unstructured grid)");
}

vtkPointSet* RequireBoundary(vtkDataObject* input)
{
  if (!input)
  {
    throw morph::Error(
      "Boundary: nothing is connected, so there is nothing to follow. Connect Boundary "
      "Displacement, or "
      "Extract Morph Boundary followed by a filter that moves points, Transform for instance (in "
      "ParaView's window: right-click this filter, Change Input).");
  }
  return RequirePointSet(input, "The boundary");
}

void RequireNotSwapped(vtkDataObject* input, vtkDataObject* boundary)
{
  auto* points = vtkPointSet::SafeDownCast(input);
  if (points && points->GetNumberOfCells() > 0 && !hasVolumeCells(input) &&
      hasVolumeCells(boundary))
  {
    throw morph::Error("Input and Boundary are swapped: Boundary has volume cells and Input has "
                       "none. Give the volume mesh as "
                       "Input and its displaced boundary as Boundary.");
  }
}

vtkPolyData* RequirePolyData(vtkDataObject* input, const char* port)
{
  if (auto* surface = vtkPolyData::SafeDownCast(input))
  {
    DataCheck::Require(surface, port);
    return surface;
  }
  refuse(input, port, "polygonal data (Extract Surface makes it)");
}

vtkPointSet* RequireGridOrPolyData(vtkDataObject* input, const char* port)
{
  if (vtkUnstructuredGrid::SafeDownCast(input))
  {
    return RequireGrid(input, port);
  }
  if (vtkPolyData::SafeDownCast(input))
  {
    return RequirePolyData(input, port);
  }
  refuse(input, port,
    "an unstructured grid (Append Datasets makes one of any data set), or its boundary from "
    "Extract Morph Boundary,");
}

vtkPointSet* RequireGridOrPolyData(vtkDataObject* input, const char* port, Unchanged& checked)
{
  return vtkUnstructuredGrid::SafeDownCast(input) ? RequireGrid(input, port, checked)
                                                  : RequireGridOrPolyData(input, port);
}

bool HasPoints(vtkDataObject* data)
{
  return data && data->GetNumberOfElements(vtkDataObject::POINT) > 0;
}

bool IsReadable(vtkDataObject* data)
{
  try
  {
    GridMesh::FromGrid(RequireGrid(data, "The input"), GridMesh::UnknownCells::Keep);
    return true;
  }
  catch (const std::exception&)
  {
    return false;
  }
}

Mesh TakeMesh(vtkDataObject* input, Blocks& blocks, int coincidentPoints, Use use,
  const char* filter, morph::Monitor& monitor, vtkDataObject* boundary)
{
  Mesh mesh = { nullptr, false, false, false };
  const auto unknown =
    use == Use::ToMeasure ? GridMesh::UnknownCells::Keep : GridMesh::UnknownCells::Refuse;
  std::exception_ptr problem;
  try
  {
    Input::RequireNotSwapped(input, boundary);
    mesh.Data = gather(input, blocks, coincidentPoints, unknown, monitor);
  }
  catch (...)
  {
    problem = std::current_exception(); // the other processes are about to communicate
  }
  auto* data = vtkDataSet::SafeDownCast(mesh.Data);
  // A process may have sets alone, whose nodes are those of others' cells.
  const bool hasCells =
    data && (data->GetNumberOfCells() > 0 || (blocks.Merged() && data->GetNumberOfPoints() > 0));
  const int ranks = Ranks::Count(hasCells);
  if (ranks > 1 && use == Use::ToMorph && !Ranks::TakePieces())
  {
    throw morph::Error(
      "The mesh is distributed over " + std::to_string(ranks) +
      " MPI ranks, and this plugin was built without MPI or hypre: " + filter +
      " needs the mesh on one rank. Build with MESHMORPHING_USE_MPI, or run on one rank.");
  }
  // Faces are measured as they are. A process may have only faces of another one's solid.
  const bool isShell = use != Use::ToMeasure && ShellGrid::IsShell(mesh.Data);
  const bool isOther = hasCells && !isShell && BlockCells::Dimension(data) > 1;
  ShellGrid& shell = blocks.Shell();
  if (Ranks::Count(isShell) == 0 || Ranks::Count(isOther || problem) > 0)
  {
    shell.Thicken(nullptr); // forgets an earlier one
  }
  else if (ranks > 1)
  {
    const bool isKept = Ranks::Count(!shell.IsKept(mesh.Data)) == 0;
    mesh.Data = isKept ? shell.Kept() : shell.ThickenBy(RankBlocks::Thicken, mesh.Data);
  }
  else
  {
    try
    {
      mesh.Data = shell.Thicken(mesh.Data);
    }
    catch (...)
    {
      problem = std::current_exception();
    }
  }
  mesh.IsDistributed = ranks > 1;
  mesh.IsElsewhere = ranks > 0 && !hasCells;
  mesh.IsEmpty = ranks == 0;
  const auto rethrow = [&]
  {
    if (problem)
    {
      std::rethrow_exception(problem);
    }
  };
  if (mesh.IsDistributed)
  {
    Ranks::Together(rethrow);
  }
  rethrow();
  return mesh;
}
}
}
