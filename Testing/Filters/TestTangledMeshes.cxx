// SPDX-License-Identifier: BSD-3-Clause
// The inversion-free morph on tangled meshes of other projects. They are not part of this one:
// where they are absent the tests are skipped.
#include "TestGrids.h"

#include "vtkInversionFreeMorph.h"

#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridReader.h>
#include <vtksys/SystemTools.hxx>

#include <gtest/gtest.h>

#include <ostream>

namespace
{
struct Tangled
{
  const char* file;
  double minimum; ///< scaled Jacobian to reach
  double mean;
};

std::ostream& operator<<(std::ostream& stream, const Tangled& mesh)
{
  return stream << mesh.file;
}

class TangledMeshes : public testing::TestWithParam<Tangled>
{
};
}

TEST_P(TangledMeshes, ComeOutValid)
{
  const std::string file = std::string(MESHMORPHING_OTHER_MESHES "/") + GetParam().file;
  if (!vtksys::SystemTools::FileExists(file))
  {
    GTEST_SKIP() << "There is no " << file << ".";
  }
  vtkNew<vtkUnstructuredGridReader> reader;
  reader->SetFileName(file.c_str());
  reader->ReadAllScalarsOn();
  reader->Update();
  vtkUnstructuredGrid* grid = reader->GetOutput();
  vtkDataArray* fixed = grid->GetPointData()->GetArray("fixed");
  ASSERT_NE(fixed, nullptr);
  std::vector<morph::Index> ids;
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
  {
    if (fixed->GetComponent(i, 0) != 0)
    {
      ids.push_back(i);
    }
  }
  const morph::Points rest = grids::points(grid);
  auto boundary = grids::cloud(meshes::rows(rest, ids));
  grids::addIds(boundary, "MorphPointId", ids);

  vtkNew<vtkInversionFreeMorph> filter;
  filter->SetInputData(grid);
  filter->SetBoundaryData(boundary);
  filter->HoldUnnamedBoundaryOff();
  filter->SetValidityToReport();
  filter->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  grids::Listener listener(filter);
  filter->Update();
  EXPECT_TRUE(listener.Errors.empty()) << listener.Errors[0];
  EXPECT_EQ(filter->GetInvertedCells() + filter->GetDegenerateCells(), 0);
  EXPECT_GE(filter->GetMinScaledJacobian(), GetParam().minimum);
  EXPECT_GE(filter->GetMeanScaledJacobian(), GetParam().mean);
  std::cout << GetParam().file << ": minimum scaled Jacobian " << filter->GetMinScaledJacobian()
            << ", mean " << filter->GetMeanScaledJacobian() << "\n";
  EXPECT_TRUE(meshes::rows(grids::points(filter->GetOutput()), ids) == meshes::rows(rest, ids));
}

// Of the first, 0.5456 and 0.8043 are the published results of Mesquite.
INSTANTIATE_TEST_SUITE_P(All, TangledMeshes,
  testing::Values(Tangled{ "par_untangle_original_hex_mesh.1.0.vtk", 0.5456, 0.8043 },
    Tangled{ "hex_5_tangled.vtk", 0.01, 0.01 }, Tangled{ "mixed-hex-pyr-tet.vtk", 1e-9, 0.01 },
    Tangled{ "tire.vtk", 0.005, 0.01 }, Tangled{ "cub_fru.vtk", 0.5, 0.9 }),
  [](const auto& info) { return "Mesh" + std::to_string(info.index); });
