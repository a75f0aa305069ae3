// SPDX-License-Identifier: BSD-3-Clause
#include "RankGrids.h"

#include "Mesh/CellShape.h"
#include "Meshes.h"
#include "Pieces.h"
#include "TestGrids.h"

#include <vtkCallbackCommand.h>
#include <vtkCellData.h>
#include <vtkCommand.h>
#include <vtkDummyController.h>
#include <vtkIdTypeArray.h>
#include <vtkMultiProcessController.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace rank_grids
{
using morph::Index;

namespace
{
void setGlobalIds(vtkDataSetAttributes* data, const std::vector<std::int64_t>& ids)
{
  vtkNew<vtkIdTypeArray> array;
  array->SetName("GlobalIds");
  for (const std::int64_t id : ids)
  {
    array->InsertNextValue(static_cast<vtkIdType>(id));
  }
  data->SetGlobalIds(array);
}
}

vtkSmartPointer<vtkUnstructuredGrid> piece(
  const morph::distributed::Ranks& ranks, const morph::Mesh& whole)
{
  const auto mine = pieces::pieceOf(
    whole, pieces::randomOwners(whole, ranks.count(), meshes::seed()), ranks.rank());
  vtkSmartPointer<vtkUnstructuredGrid> grid = grids::make(mine.mesh);
  setGlobalIds(grid->GetPointData(), mine.nodeIds);
  setGlobalIds(grid->GetCellData(), mine.cellIds);
  return grid;
}

morph::Mesh fork()
{
  const morph::Mesh block = meshes::hexes(12, 2, 8);
  morph::Mesh whole;
  whole.points = block.points;
  for (Index c = 0; c < block.numberOfCells(); ++c)
  {
    const grids::Row low = block.points.row(block.cell(c)[0]);
    if (low[0] < 5 || low[0] > 6 || low[2] < 2)
    {
      meshes::add(whole, block.types[c], { block.cell(c), block.cell(c) + block.cellSize(c) });
    }
  }
  return whole;
}

grids::Map intoTheGap(double way)
{
  return [way](const grids::Row& x)
  { return x[0] == 5 && x[2] > 2 ? grids::Row(x + grids::Row(way, 0, 0)) : x; };
}

morph::Mesh sheet(const grids::Map& place)
{
  constexpr Index Cells = 8, Row = Cells + 1; // along a side
  morph::Mesh mesh;
  mesh.points.resize(Row * Row, 3);
  for (Index i = 0; i < mesh.points.rows(); ++i)
  {
    mesh.points.row(i) = place(grids::Row(double(i % Row), double(i / Row), 0) / Cells);
  }
  for (Index cell = 0; cell < Cells * Cells; ++cell)
  {
    const Index a = cell / Cells * Row + cell % Cells, b = a + 1, c = b + Row, d = a + Row;
    if (cell % 3 == 0)
    {
      mesh.add(morph::Triangle, { a, b, c });
      mesh.add(morph::Triangle, { a, c, d });
    }
    else
    {
      cell % 5 == 0 ? mesh.add(morph::Quad, { d, c, b, a }) : mesh.add(morph::Quad, { a, b, c, d });
    }
  }
  return mesh;
}

grids::Row dome(const grids::Row& x)
{
  return { x[0], x[1], 0.4 * x[0] * (1 - x[0]) + 0.5 * x[1] * (1 - x[1]) };
}

std::vector<Index> globalIds(vtkDataSet* data, const char* name)
{
  vtkDataArray* array = data->GetPointData()->GetArray(name);
  std::vector<Index> ids;
  for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
  {
    ids.push_back(static_cast<Index>(array->GetComponent(i, 0)));
  }
  return ids;
}

void alone(const std::function<void()>& work)
{
  vtkSmartPointer<vtkMultiProcessController> all = vtkMultiProcessController::GetGlobalController();
  vtkNew<vtkDummyController> one;
  vtkMultiProcessController::SetGlobalController(one);
  work();
  vtkMultiProcessController::SetGlobalController(all);
}

void abortOnLastRank(const morph::distributed::Ranks& ranks, vtkAlgorithm* filter)
{
  vtkNew<vtkCallbackCommand> stop;
  stop->SetCallback([](vtkObject* caller, unsigned long, void*, void*)
    { static_cast<vtkAlgorithm*>(caller)->SetAbortExecute(1); });
  if (ranks.rank() == ranks.count() - 1)
  {
    filter->AddObserver(vtkCommand::ProgressEvent, stop);
  }
}

void expectOneError(
  const morph::distributed::Ranks& ranks, vtkAlgorithm* filter, const std::string& telling)
{
  const grids::Run run(filter);
  EXPECT_EQ(ranks.sum(static_cast<morph::Index>(run.Errors.size())), 1);
  for (const std::string& error : run.Errors)
  {
    EXPECT_NE(error.find(telling), std::string::npos) << error;
  }
}

double distance(
  const morph::distributed::Ranks& ranks, vtkUnstructuredGrid* piece, vtkUnstructuredGrid* whole)
{
  const std::vector<Index> ids = globalIds(piece, "GlobalIds");
  double largest = 0;
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    double a[3], b[3];
    piece->GetPoint(static_cast<vtkIdType>(i), a);
    whole->GetPoint(static_cast<vtkIdType>(ids[i]), b);
    for (int j = 0; j < 3; ++j)
    {
      largest = std::max(largest, std::abs(a[j] - b[j]));
    }
  }
  return ranks.maximum(largest);
}
}
