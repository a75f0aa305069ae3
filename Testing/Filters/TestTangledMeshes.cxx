// SPDX-License-Identifier: BSD-3-Clause
// The inversion-free morph on tangled meshes of other projects. They are not part of this one:
// where they are absent the tests are skipped.
#include "TestGrids.h"

#include "vtkInversionFreeMorph.h"
#include "vtkSmoothingMorph.h"

#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridReader.h>
#include <vtksys/SystemTools.hxx>

#include <gtest/gtest.h>

#include <ostream>
#include <random>

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

/// Morphs one of the meshes with its boundary fixed.
class FixedBoundary
{
public:
  /// Grid is null if there is no such file.
  explicit FixedBoundary(const char* name)
    : File(std::string(MESHMORPHING_OTHER_MESHES "/") + name)
  {
    if (!vtksys::SystemTools::FileExists(this->File))
    {
      return;
    }
    this->Reader->SetFileName(this->File.c_str());
    this->Reader->ReadAllScalarsOn();
    this->Reader->Update();
    this->Grid = this->Reader->GetOutput();
    this->Rest = grids::points(this->Grid);
    vtkDataArray* fixed = this->Grid->GetPointData()->GetArray("fixed");
    for (vtkIdType i = 0; i < this->Grid->GetNumberOfPoints(); ++i)
    {
      (fixed->GetComponent(i, 0) != 0 ? this->Ids : this->Free).push_back(i);
    }
  }

  std::string File;
  vtkUnstructuredGrid* Grid = nullptr;
  morph::Points Rest;
  std::vector<morph::Index> Ids, Free; ///< of fixed nodes and of the others

  /// Places the nodes that are not fixed at random in the box of the mesh; with `seed` 0 all of
  /// them in its middle.
  void Scramble(unsigned seed)
  {
    const Eigen::RowVector3d low = this->Rest.colwise().minCoeff(),
                             high = this->Rest.colwise().maxCoeff();
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> part(0, 1);
    vtkNew<vtkPoints> points;
    points->SetDataType(VTK_DOUBLE);
    points->DeepCopy(this->Grid->GetPoints());
    for (morph::Index node : this->Free)
    {
      double x[3];
      for (int j = 0; j < 3; ++j)
      {
        x[j] = low[j] + (seed == 0 ? 0.5 : part(random)) * (high[j] - low[j]);
      }
      points->SetPoint(node, x);
    }
    this->Grid->SetPoints(points);
  }

  void Run(vtkMorphAlgorithm* filter)
  {
    auto boundary = grids::cloud(meshes::rows(this->Rest, this->Ids));
    grids::addIds(boundary, "MorphPointId", this->Ids);
    filter->SetInputData(this->Grid);
    filter->SetBoundaryData(boundary);
    filter->FixUnnamedBoundaryOff();
    filter->SetValidityToReport();
    filter->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
    grids::update(filter);
    EXPECT_TRUE(meshes::rows(grids::points(filter->GetOutput()), this->Ids) ==
                meshes::rows(this->Rest, this->Ids));
  }

private:
  vtkNew<vtkUnstructuredGridReader> Reader;
};
}

TEST_P(TangledMeshes, ComeOutValid)
{
  FixedBoundary mesh(GetParam().file);
  if (!mesh.Grid)
  {
    GTEST_SKIP() << "There is no " << mesh.File << ".";
  }
  vtkNew<vtkInversionFreeMorph> filter;
  mesh.Run(filter);
  EXPECT_EQ(filter->GetInvertedCells() + filter->GetDegenerateCells(), 0);
  EXPECT_GE(filter->GetMinScaledJacobian(), GetParam().minimum);
  EXPECT_GE(filter->GetMeanScaledJacobian(), GetParam().mean);
  std::cout << GetParam().file << ": minimum scaled Jacobian " << filter->GetMinScaledJacobian()
            << ", mean " << filter->GetMeanScaledJacobian() << "\n";
}

TEST_P(TangledMeshes, ComeOutValidWithTheirInnerNodesAnywhere)
{
  FixedBoundary mesh(GetParam().file);
  if (!mesh.Grid)
  {
    GTEST_SKIP() << "There is no " << mesh.File << ".";
  }
  vtkNew<vtkSmoothingMorph> smoothing;
  mesh.Run(smoothing);
  ASSERT_EQ(smoothing->GetInvertedCells(), 0);
  for (unsigned seed = 0; seed <= 10; ++seed)
  {
    SCOPED_TRACE(seed);
    mesh.Scramble(seed);
    vtkNew<vtkInversionFreeMorph> filter;
    mesh.Run(filter);
    EXPECT_EQ(filter->GetInvertedCells() + filter->GetDegenerateCells(), 0);
    EXPECT_GE(filter->GetMinScaledJacobian(), smoothing->GetMinScaledJacobian() - 1e-12);
    EXPECT_LE(filter->GetNewtonSteps(), 50);
  }
}

// Of the first, 0.5456 and 0.8043 are the published results of Mesquite.
INSTANTIATE_TEST_SUITE_P(All, TangledMeshes,
  testing::Values(Tangled{ "par_untangle_original_hex_mesh.1.0.vtk", 0.5456, 0.8043 },
    Tangled{ "hex_5_tangled.vtk", 0.01, 0.01 }, Tangled{ "mixed-hex-pyr-tet.vtk", 1e-9, 0.01 },
    Tangled{ "tire.vtk", 0.005, 0.01 }, Tangled{ "cub_fru.vtk", 0.5, 0.9 }),
  [](const auto& info) { return "Mesh" + std::to_string(info.index); });
