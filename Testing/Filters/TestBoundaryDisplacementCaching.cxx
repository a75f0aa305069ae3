// SPDX-License-Identifier: BSD-3-Clause
#include "DisplacedBoundaries.h"

#include "../Core/BoundaryShapes.h"
#include "vtkClassifyBoundary.h"

#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkDoubleArray.h>
#include <vtkExtractSelection.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSelection.h>
#include <vtkSelectionNode.h>
#include <vtkTransform.h>

#include <gtest/gtest.h>

using namespace displaced;
using grids::Row;

namespace
{
struct Counts
{
  int classify, choose, prepare;

  explicit Counts(vtkBoundaryDisplacement* filter)
    : classify(filter->GetClassifyCount())
    , choose(filter->GetChooseCount())
    , prepare(filter->GetPrepareCount())
  {
  }
  Counts(int a, int b, int c)
    : classify(a)
    , choose(b)
    , prepare(c)
  {
  }
  bool operator==(const Counts& other) const
  {
    return this->classify == other.classify && this->choose == other.choose &&
           this->prepare == other.prepare;
  }
};

std::ostream& operator<<(std::ostream& stream, const Counts& counts)
{
  return stream << counts.classify << ' ' << counts.choose << ' ' << counts.prepare;
}

/// A side of the box with a hole is moved, and the rest follows.
vtkSmartPointer<vtkBoundaryDisplacement> dragged(vtkDataObject* input, vtkTransform* transform)
{
  auto filter = displaced::make(input);
  filter->SetMovingToSurfaces();
  filter->AddSurface("Surface 1");
  filter->SetTransform(transform);
  return filter;
}

/// Selects what the selection leaves out, and counts its executions.
class InverseExtractor : public vtkExtractSelection
{
public:
  static InverseExtractor* New();
  vtkTypeMacro(InverseExtractor, vtkExtractSelection);
  int Executions = 0;

protected:
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override
  {
    ++this->Executions;
    vtkInformation* info = inputVector[1]->GetInformationObject(0);
    const vtkSmartPointer<vtkSelection> given = vtkSelection::GetData(info);
    vtkNew<vtkSelection> inverse;
    inverse->DeepCopy(given);
    inverse->GetNode(0)->GetProperties()->Set(vtkSelectionNode::INVERSE(), 1);
    info->Set(vtkDataObject::DATA_OBJECT(), inverse);
    const int result = this->Superclass::RequestData(request, inputVector, outputVector);
    info->Set(vtkDataObject::DATA_OBJECT(), given);
    return result;
  }
};
vtkStandardNewMacro(InverseExtractor);

morph::Points result(vtkBoundaryDisplacement* filter)
{
  filter->Update();
  return grids::points(filter->GetOutput());
}
}

TEST(BoundaryDisplacementCaching, DraggingRepeatsNothing)
{
  auto grid = grids::make(shapes::boxWithHole(16, 4, 4));
  for (int surroundings = 0; surroundings < 3; ++surroundings)
  {
    vtkNew<vtkTransform> transform;
    transform->Translate(0.1, 0.2, 0.3);
    auto filter = dragged(grid, transform);
    filter->SetSurroundings(surroundings);
    filter->Update();
    const Counts first(filter);
    EXPECT_EQ(first.classify, 1);
    EXPECT_EQ(first.choose, 1);
    EXPECT_EQ(first.prepare > 0, surroundings != vtkBoundaryDisplacement::SURROUNDINGS_STAY);
    for (int step = 0; step < 4; ++step)
    {
      transform->RotateWXYZ(5, 0.1 * step, 1, 0);
      filter->SetScaleFactor(1 + 0.1 * step);
      const morph::Points moved = result(filter);
      EXPECT_EQ(Counts(filter), first);
      // From scratch it is the same, bit for bit.
      auto fresh = dragged(grid, transform);
      fresh->SetSurroundings(surroundings);
      fresh->SetScaleFactor(1 + 0.1 * step);
      EXPECT_EQ(result(fresh), moved);
    }
  }
}

TEST(BoundaryDisplacementCaching, TheLastMotionLeavesNoTrace)
{
  auto grid = grids::make(shapes::boxWithHole(16, 4, 4));
  vtkNew<vtkTransform> transform;
  auto filter = dragged(grid, transform);
  vtkNew<vtkCallbackCommand> stop;
  stop->SetCallback([](vtkObject* caller, unsigned long, void*, void*)
    { static_cast<vtkAlgorithm*>(caller)->SetAbortExecute(1); });
  for (int step = 0; step < 9; ++step)
  {
    transform->Translate(0.1, 0.02 * step, 0.1);
    filter->SetSurroundings(step % 3);
    filter->SetMoving(step % 2 == 0 ? vtkBoundaryDisplacement::MOVING_SURFACES
                                    : vtkBoundaryDisplacement::MOVING_NOTHING);
    if (step % 4 == 0)
    {
      // Stopped on its way, with what it had in hand.
      const unsigned long tag = filter->AddObserver(vtkCommand::ProgressEvent, stop);
      filter->Update();
      EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
      filter->RemoveObserver(tag);
      filter->SetAbortExecute(0);
      filter->Modified();
    }
    auto fresh = dragged(grid, transform);
    fresh->SetSurroundings(step % 3);
    fresh->SetMoving(filter->GetMoving());
    EXPECT_EQ(result(filter), result(fresh));
  }
}

TEST(BoundaryDisplacementCaching, WhatIsChosenAnewPreparesAlone)
{
  auto grid = grids::make(shapes::boxWithHole(16, 4, 4));
  vtkNew<vtkTransform> transform;
  transform->Translate(0.1, 0.2, 0.3);
  auto filter = dragged(grid, transform);
  filter->Update();
  const Counts first(filter);
  filter->AddSurface("Surface 2");
  const morph::Points both = result(filter);
  EXPECT_EQ(filter->GetClassifyCount(), 1);
  EXPECT_EQ(filter->GetChooseCount(), 2);
  EXPECT_GT(filter->GetPrepareCount(), first.prepare);
  auto fresh = dragged(grid, transform);
  fresh->AddSurface("Surface 2");
  EXPECT_EQ(result(fresh), both);

  // A list that is sent again, as ParaView does.
  const Counts second(filter);
  filter->RemoveAllSurfaces();
  filter->AddSurface("Surface 2");
  filter->AddSurface("Surface 1");
  EXPECT_EQ(result(filter), both);
  EXPECT_EQ(Counts(filter), second);
}

TEST(BoundaryDisplacementCaching, InputsAreComparedByContent)
{
  auto grid = grids::make(shapes::boxWithHole(16, 4, 4));
  vtkNew<vtkTransform> transform;
  transform->Translate(0.1, 0.2, 0.3);
  auto filter = dragged(grid, transform);
  const morph::Points moved = result(filter);
  const Counts first(filter);

  // The same mesh again, with another value of an array that is passed on.
  auto again = grids::copy(grid);
  again->GetPointData()->GetArray("Number")->SetComponent(0, 0, 77);
  filter->SetInputData(again);
  EXPECT_EQ(result(filter), moved);
  EXPECT_EQ(filter->GetClassifyCount(), first.classify);
  EXPECT_EQ(filter->GetPrepareCount(), first.prepare);
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetArray("Number")->GetComponent(0, 0), 77);

  // In place: a node of the boundary.
  double x[3];
  again->GetPoint(0, x);
  x[0] -= 0.05;
  again->GetPoints()->SetPoint(0, x);
  again->GetPoints()->Modified();
  const morph::Points other = result(filter);
  EXPECT_EQ(filter->GetClassifyCount(), first.classify + 1);
  EXPECT_EQ(result(dragged(again, transform)), other);
  EXPECT_NE(other, moved);

  // The arrays that tell the geometry.
  auto classify = grids::of<vtkClassifyBoundary>(grid);
  classify->Update();
  filter->SetInputData(classify->GetOutput());
  EXPECT_LE((result(filter) - moved).cwiseAbs().maxCoeff(), 1e-13);
  const Counts third(filter);
  classify->GetOutput()->GetPointData()->GetArray("CurveParameter")->Modified();
  filter->Update();
  EXPECT_EQ(filter->GetClassifyCount(), third.classify + 1);
}

TEST(BoundaryDisplacementCaching, AnErrorLeavesNothingBehind)
{
  auto grid = grids::make(shapes::boxWithHole(16, 4, 4));
  vtkNew<vtkTransform> transform;
  transform->Translate(0.1, 0.2, 0.3);
  auto filter = dragged(grid, transform);
  const morph::Points moved = result(filter);
  grids::Listener listener(filter);
  filter->AddSurface("Surface 99");
  filter->Update();
  filter->RemoveAllSurfaces();
  filter->AddSurface("Surface 1");
  EXPECT_EQ(result(filter), moved);
  auto broken = grids::copy(grid);
  broken->GetPoints()->SetPoint(0, NAN, 0, 0);
  filter->SetInputData(broken);
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_EQ(filter->GetMovingPoints(), 0);
  filter->SetInputData(grid);
  EXPECT_EQ(result(filter), moved);
  EXPECT_EQ(listener.Errors.size(), 2u);
}

TEST(BoundaryDisplacementCaching, WhatIsNotInUseExecutesNothing)
{
  auto grid = grids::hexes(3);
  vtkNew<vtkTransform> transform;
  auto filter = dragged(grid, transform);
  filter->SetDisplacementToVector();
  filter->Update();
  const vtkMTimeType time = filter->GetOutput()->GetMTime();
  transform->Translate(1, 2, 3);
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetMTime(), time);
  filter->SetDisplacementToTransform();
  filter->Update();
  EXPECT_GT(filter->GetOutput()->GetMTime(), time);
}

TEST(BoundaryDisplacementCaching, ASelectionThatChangesIsEvaluatedAgain)
{
  auto grid = grids::hexes(3);
  auto filter = displaced::make(grid);
  filter->SetMovingToSelection();
  auto selection = indices(vtkSelectionNode::POINT, { 0, 1 });
  filter->SetSelectionData(selection);
  filter->Update();
  EXPECT_EQ(filter->GetMovingPoints(), 2);
  grids::moveBy(filter, 1, 0, 0);
  filter->Update();
  EXPECT_EQ(filter->GetChooseCount(), 1);
  auto* ids = vtkIdTypeArray::SafeDownCast(selection->GetNode(0)->GetSelectionList());
  ids->InsertNextValue(2);
  ids->Modified();
  selection->GetNode(0)->Modified();
  selection->Modified();
  filter->Update();
  EXPECT_EQ(filter->GetMovingPoints(), 3);
  EXPECT_EQ(filter->GetChooseCount(), 2);
}

TEST(BoundaryDisplacementCaching, AnotherExtractorEvaluatesTheSelectionAgain)
{
  auto filter = displaced::make(grids::hexes(3));
  filter->SetMovingToSelection();
  filter->SetSelectionData(indices(vtkSelectionNode::POINT, { 0, 1 }));
  filter->Update();
  EXPECT_EQ(filter->GetMovingPoints(), 2);
  vtkNew<InverseExtractor> extractor;
  filter->SetSelectionExtractor(extractor);
  filter->Update();
  EXPECT_EQ(filter->GetMovingPoints(), 54); // of 56 points on the boundary
  EXPECT_EQ(extractor->Executions, 1);
  EXPECT_EQ(filter->GetChooseCount(), 2);
  // The same extractor changes nothing, and a motion does not need it.
  const vtkMTimeType time = filter->GetMTime();
  filter->SetSelectionExtractor(extractor);
  EXPECT_EQ(filter->GetMTime(), time);
  grids::moveBy(filter, 1, 0, 0);
  filter->Update();
  EXPECT_EQ(extractor->Executions, 1);
  filter->SetSelectionExtractor(nullptr);
  filter->Update();
  EXPECT_EQ(filter->GetMovingPoints(), 2);
  EXPECT_EQ(extractor->Executions, 1);
  EXPECT_EQ(filter->GetChooseCount(), 3);
}
