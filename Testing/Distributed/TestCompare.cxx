// SPDX-License-Identifier: BSD-3-Clause
// vtkCompareMorphMethods on random partitions: the tables of one rank, the same on all.
#include "Meshes.h"
#include "Pieces.h"
#include "RankGrids.h"
#include "RankParts.h"
#include "TestGrids.h"

#include <vtkCompareMorphMethods.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVariant.h>

#include <gtest/gtest.h>

#include <cmath>

namespace
{
using morph::Index;
using morph::distributed::Ranks;

void configure(vtkCompareMorphMethods* filter, vtkUnstructuredGrid* grid)
{
  filter->SetInputData(grid);
  filter->SetBoundaryData(grids::boundary(grid, grids::twist));
  filter->SetNumberOfSteps(3);
  filter->SetPercentile(20);
  filter->RelativeOn();
}

vtkTable* table(vtkCompareMorphMethods* filter, int port)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(port));
}

double number(vtkTable* table, vtkIdType row, const char* column)
{
  return table->GetValueByName(row, column).ToDouble();
}

/// That all ranks have the same bits in a column.
void expectShared(const Ranks& ranks, vtkTable* table, const char* column)
{
  for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
  {
    const double value = number(table, row, column);
    EXPECT_EQ(ranks.minimum(value), ranks.maximum(value)) << column << ", row " << row;
  }
}

void compare(const Ranks& ranks, vtkCompareMorphMethods* filter, vtkCompareMorphMethods* serial)
{
  vtkTable* mine = table(filter, 0);
  vtkTable* whole = table(serial, 0);
  EXPECT_EQ(ranks.minimum(static_cast<Index>(mine->GetNumberOfRows())), whole->GetNumberOfRows());
  EXPECT_EQ(ranks.maximum(static_cast<Index>(mine->GetNumberOfRows())), whole->GetNumberOfRows());
  if (mine->GetNumberOfRows() != whole->GetNumberOfRows())
  {
    return;
  }
  for (vtkIdType row = 0; row < whole->GetNumberOfRows(); ++row)
  {
    for (const char* column : { "Method", "Stepping", "Step" })
    {
      EXPECT_EQ(mine->GetValueByName(row, column), whole->GetValueByName(row, column));
    }
    const vtkStdString method = whole->GetValueByName(row, "Method").ToString();
    const bool minimizes = method == "Smoothing" || method == "Inversion-free";
    EXPECT_NEAR(number(mine, row, "Time"), number(whole, row, "Time"), 1e-12);
    for (const char* column : { "MinScaledJacobian", "MeanScaledJacobian", "LowScaledJacobian" })
    {
      const double expected = number(whole, row, column);
      // Where these end depends on rounding.
      EXPECT_NEAR(number(mine, row, column), expected, minimizes ? 0.01 * expected : 1e-6)
        << method << ", " << column << ", row " << row;
    }
    for (const char* column : { "InvertedCells", "DegenerateCells", "BoundaryInvertedCells" })
    {
      EXPECT_EQ(number(mine, row, column), number(whole, row, column)) << column;
    }
  }
}

void compareTables(const Ranks& ranks, vtkCompareMorphMethods* filter)
{
  for (const char* column : { "MinScaledJacobian", "LowScaledJacobian", "PrepareSeconds",
         "EvaluateSeconds", "PeakMegabytes" })
  {
    expectShared(ranks, table(filter, 0), column);
  }
  for (const char* column : { "Rank", "FirstInvertedStep", "Seconds" })
  {
    expectShared(ranks, table(filter, 2), column);
  }
}
}

TEST(RankCompare, HasTheTablesOfOneRank)
{
  const Ranks ranks = pieces::world();
  unsigned seed = meshes::seed();
  for (auto& [name, mesh] :
    { std::pair("hexes", meshes::hexes(4, 4, 3)), std::pair("tets", meshes::tets(3, 3, 3)) })
  {
    SCOPED_TRACE(name);
    const auto whole = grids::make(mesh);
    vtkNew<vtkCompareMorphMethods> serial, filter;
    rank_grids::alone(
      [&]
      {
        configure(serial, whole);
        serial->Update();
      });
    EXPECT_EQ(table(serial, 0)->GetNumberOfRows(), 4 * 2 * 8);
    configure(filter, rank_grids::part(ranks, whole, mesh, ++seed));
    grids::update(filter);
    compare(ranks, filter, serial);
    compareTables(ranks, filter);
    EXPECT_NE(std::string(filter->GetBestMethod()), "");
  }
}

TEST(RankCompare, TakesAMeshThatOneRankHas)
{
  const Ranks ranks = pieces::world();
  const auto whole = grids::make(meshes::hexes(3, 3, 3));
  vtkNew<vtkCompareMorphMethods> serial, filter;
  rank_grids::alone(
    [&]
    {
      configure(serial, whole);
      serial->Update();
    });
  vtkNew<vtkUnstructuredGrid> none;
  configure(filter, ranks.rank() == ranks.count() - 1 ? whole.Get() : none.Get());
  grids::update(filter);
  compare(ranks, filter, serial);
  compareTables(ranks, filter);
}

TEST(RankCompare, GivesOneErrorWithoutABoundary)
{
  const Ranks ranks = pieces::world();
  const morph::Mesh mesh = meshes::hexes(3, 3, 3);
  const auto piece = rank_grids::part(ranks, grids::make(mesh), mesh, meshes::seed());
  vtkNew<vtkCompareMorphMethods> filter;
  configure(filter, piece);
  filter->RelativeOff();
  for (const bool isBoundaryThere : { true, false })
  {
    if (!isBoundaryThere)
    {
      filter->SetBoundaryData(nullptr);
    }
    const grids::Run listener(filter);
    EXPECT_EQ(ranks.sum(static_cast<Index>(listener.Errors.size())), isBoundaryThere ? 0 : 1);
    EXPECT_EQ(table(filter, 2)->GetNumberOfRows(), isBoundaryThere ? 8 : 0);
  }
}

TEST(RankCompare, AnAbortOnOneRankEndsAllWithoutAMessage)
{
  const Ranks ranks = pieces::world();
  const morph::Mesh mesh = meshes::hexes(3, 3, 3);
  const auto piece = rank_grids::part(ranks, grids::make(mesh), mesh, meshes::seed());
  vtkNew<vtkCompareMorphMethods> filter;
  configure(filter, piece);
  rank_grids::abortOnLastRank(ranks, filter);
  grids::update(filter);
  EXPECT_EQ(table(filter, 0)->GetNumberOfRows(), 0);
}
