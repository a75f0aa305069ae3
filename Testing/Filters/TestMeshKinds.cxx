// SPDX-License-Identifier: BSD-3-Clause
// Kinds of cells and nodes of engineers' meshes in all that morphs or measures a mesh.
#include "MeshKinds.h"
#include "MorphFilters.h"
#include "TestGrids.h"

#include "vtkCompareMorphMethods.h"
#include "vtkFEMWarpMorph.h"
#include "vtkMorphAdjoint.h"
#include "vtkMorphShapes.h"
#include "vtkScaledJacobian.h"

#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkTable.h>

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace
{
using grids::Row;
using morph::Index;
using morph::Points;

class MeshKinds : public testing::TestWithParam<meshes::Kind>
{
protected:
  const vtkSmartPointer<vtkUnstructuredGrid> Grid = grids::make(GetParam().mesh);
  const Points Rest = grids::points(this->Grid);
  const Points Target = grids::mapped(this->Rest, grids::affine);

  template <typename Filter>
  vtkSmartPointer<Filter> Moved(const grids::Map& map = grids::affine) const
  {
    return grids::morphed<Filter>(this->Grid, map);
  }
  double Off(vtkPointSet* output, const Points& wanted) const
  {
    const Index count = this->Rest.rows() - GetParam().turned;
    return (grids::points(output) - wanted).topRows(count).cwiseAbs().maxCoeff();
  }
};
}

TEST_P(MeshKinds, GoAlongInSteps)
{
  for (const bool isRelative : { false, true })
  {
    auto morph = this->Moved<vtkFEMWarpMorph>();
    morph->SetNumberOfSteps(3);
    morph->SetStepping(isRelative);
    const grids::Listener listener(morph);
    morph->UpdateTimeStep(3);
    EXPECT_TRUE(listener.Errors.empty());
    EXPECT_LT(this->Off(morph->GetOutput(), this->Target), 1e-8);
    EXPECT_STREQ(morph->GetMorphStatus(), "Valid");
  }
}

TEST_P(MeshKinds, FollowWeightedShapes)
{
  auto shapes = grids::of<vtkMorphShapes>(this->Grid);
  shapes->AddShapeData(grids::boundary(this->Grid, grids::affine));
  shapes->SetWeight(0, 0.5);
  grids::update(shapes);
  EXPECT_LT(this->Off(shapes->GetOutput(), (this->Rest + this->Target) / 2), 1e-8);
  EXPECT_STREQ(shapes->GetMorphStatus(), "Valid");
}

TEST_P(MeshKinds, AreComparedWithAllMethods)
{
  vtkNew<vtkCompareMorphMethods> compare;
  compare->SetInputData(this->Grid);
  compare->SetBoundaryData(grids::boundary(this->Grid, grids::affine));
  compare->SetNumberOfSteps(1);
  grids::update(compare);
  vtkTable* table = compare->GetOutput(0);
  std::set<std::string> methods;
  for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
  {
    methods.insert(table->GetValueByName(row, "Method").ToString());
    for (const char* count : { "InvertedCells", "DegenerateCells" })
    {
      EXPECT_EQ(table->GetValueByName(row, count).ToInt(), 0) << *methods.rbegin();
    }
    EXPECT_GT(table->GetValueByName(row, "MinScaledJacobian").ToDouble(), 0);
  }
  EXPECT_EQ(methods.size(), 8u);
}

TEST_P(MeshKinds, HaveTheTransposeAsAdjoint)
{
  static constexpr double Small = 1e-5; // a beam's turn is not linear
  const auto bulged = [](const Row& x) -> Row
  { return x + Small * Row(std::sin(x[1]), x[0] * x[2], std::sin(x[0])); };
  auto morph = this->Moved<vtkFEMWarpMorph>(bulged);
  morph->SetTolerance(1e-12);
  morph->SetValidityToNone();
  grids::update(morph);
  const Points moved = grids::points(morph->GetOutput()) - this->Rest;
  const Points gradient = this->Rest.array().sin() - 0.2;
  auto carrier = grids::copy(this->Grid);
  grids::addVectors(carrier, "Gradient", gradient);
  auto boundary = grids::boundary(this->Grid, bulged);

  vtkNew<vtkMorphAdjoint> adjoint;
  adjoint->SetInputData(this->Grid);
  adjoint->SetBoundaryData(boundary);
  adjoint->SetGradientData(carrier);
  adjoint->SetGradientArray("Gradient");
  adjoint->SetMorph(morph);
  grids::update(adjoint);

  vtkDataArray* slopes = adjoint->GetOutput()->GetPointData()->GetArray("MorphGradient");
  vtkDataArray* rest = boundary->GetPointData()->GetArray("RestPosition");
  double sum = 0;
  for (vtkIdType p = 0; p < boundary->GetNumberOfPoints(); ++p)
  {
    for (int j = 0; j < 3; ++j)
    {
      sum += slopes->GetComponent(p, j) * (boundary->GetPoint(p)[j] - rest->GetComponent(p, j));
    }
  }
  EXPECT_NEAR(sum / Small, moved.cwiseProduct(gradient).sum() / Small, 1e-4);
}

TEST_P(MeshKinds, AreMeasuredAndCertified)
{
  auto measure = grids::of<vtkScaledJacobian>(this->Grid);
  measure->CertifyOn();
  grids::update(measure);
  EXPECT_GT(measure->GetMinScaledJacobian(), 0);
  EXPECT_EQ(measure->GetInvertedCells() + measure->GetDegenerateCells(), 0);
  auto morph = this->Moved<vtkFEMWarpMorph>();
  morph->CertifyOn();
  const grids::Run run(morph);
  EXPECT_TRUE(run.Errors.empty());
  const vtkIdType volumes = GetParam().name == "AttachedBeam" ? 27 : this->Grid->GetNumberOfCells();
  EXPECT_EQ(morph->GetCertifiedCells() + morph->GetUndecidedCells(), volumes);
  const bool isSaid = std::any_of(run.Warnings.begin(), run.Warnings.end(),
    [](const std::string& text) { return text.find("is undecided") != std::string::npos; });
  EXPECT_EQ(isSaid, morph->GetUndecidedCells() > 0);
}

INSTANTIATE_TEST_SUITE_P(All, MeshKinds, testing::ValuesIn(meshes::kinds()),
  [](const testing::TestParamInfo<meshes::Kind>& kind) { return kind.param.name; });
