// SPDX-License-Identifier: BSD-3-Clause
// The methods on real meshes: the small meshes of the paper's models, in Data/Models/small.
#include "MorphFilters.h"
#include "TestGrids.h"

#include "vtkLBWarpMorph.h"

#include <vtkXMLUnstructuredGridReader.h>

#include <gtest/gtest.h>

#include <ostream>

namespace
{
const char* const Names[] = { "bore_hex", "bore_tet", "pipe_hex", "pipe_tet", "canister_hex",
  "canister_tet", "courier_hex", "courier_tet" };

class Models : public testing::TestWithParam<const char*>
{
};

vtkSmartPointer<vtkUnstructuredGrid> read(const std::string& name)
{
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  const std::string file = MESHMORPHING_MODELS "/" + name + "_small.vtu";
  reader->SetFileName(file.c_str());
  reader->Update();
  return reader->GetOutput();
}
}

TEST_P(Models, AffineMotionsComeOutExactly)
{
  auto grid = read(GetParam());
  ASSERT_GT(grid->GetNumberOfCells(), 1000);
  const morph::Points rest = grids::points(grid);
  const morph::Points expected = grids::mapped(rest, grids::affine);
  auto boundary = grids::boundary(grid, grids::affine);
  for (const grids::MorphFilter& method : grids::morphFilters())
  {
    if (method.name == "SimplexNaturalNeighbor")
    {
      continue; // too slow for every run; its own tests cover random sets of sites
    }
    SCOPED_TRACE(method.name);
    auto filter = method.of(grid, boundary);
    filter->Update();
    EXPECT_LT((grids::points(filter->GetOutput()) - expected).cwiseAbs().maxCoeff(),
      1e-10 * meshes::size(expected));
    if (auto* logBarrier = vtkLBWarpMorph::SafeDownCast(filter))
    {
      EXPECT_EQ(logBarrier->GetOutsideHullNodes(), 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
  All, Models, testing::ValuesIn(Names), [](const auto& info) { return std::string(info.param); });
