// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/BoundaryFields.h"

#include "Private/Data/AffineArrays.h"

#include <vtkPolyData.h>

#include <algorithm>

namespace morph::filters
{
namespace
{
/// Whether the rest of the boundary answers each coordinate of a motion alike, and linearly.
bool isLinear(const Surroundings::Options& rest, const Surroundings::Result& result)
{
  if (!rest.Sliding.empty())
  {
    return false;
  }
  return rest.How == Surroundings::Kind::Stay || rest.How == Surroundings::Kind::Fade ||
         std::count(result.Roles.begin(), result.Roles.end(), Surroundings::Follows) == 0;
}
}

void BoundaryFields::Write(const BoundaryModel& model, const Choice::Result& choice,
  const Motion::Options& motion, const Surroundings::Options& rest,
  const Surroundings::Result& result, Surroundings& spread, vtkPolyData* output,
  morph::Monitor& monitor)
{
  AffineArrays::Remove(output);
  if (!isLinear(rest, result))
  {
    return;
  }
  if (!this->Fields || this->MotionVersion != model.MotionVersion() || this->How != rest.How ||
      this->Radius != rest.Radius || this->Moving != choice.Moving || this->Held != choice.Held ||
      this->Free != rest.Free)
  {
    this->Fields = nullptr; // in case it throws
    this->Compute(model, choice, rest, spread, monitor);
    this->MotionVersion = model.MotionVersion();
    this->How = rest.How;
    this->Radius = rest.Radius;
    this->Free = rest.Free;
    this->Moving = choice.Moving;
    this->Held = choice.Held;
  }
  if (const auto affine = Motion::Affine(model, choice, motion, this->Centre))
  {
    AffineArrays::Write(this->Fields, *affine, output);
  }
}

void BoundaryFields::Compute(const BoundaryModel& model, const Choice::Result& choice,
  const Surroundings::Options& rest, Surroundings& spread, morph::Monitor& monitor)
{
  // The answers to p = x - centre, and to a shift along x by the model's size, which keeps the
  // digits of w.
  Surroundings::Options options = rest;
  if (options.How != Surroundings::Kind::Fade)
  {
    options.How = Surroundings::Kind::Stay;
  }
  this->Centre = Motion::Centre(model, choice);
  const morph::Points from = model.Points()(choice.Moving, morph::allColumns);
  const Eigen::RowVector3d shift(model.Size() > 0 ? model.Size() : 1, 0, 0);
  const morph::Points place =
    spread.Spread(model, choice, (2 * from).rowwise() - this->Centre, options, monitor).Moved -
    model.Points();
  const morph::Points weight =
    spread.Spread(model, choice, from.rowwise() + shift, options, monitor).Moved - model.Points();

  this->Fields = vtkSmartPointer<vtkDoubleArray>::New();
  this->Fields->SetName(AffineArrays::FieldsName);
  this->Fields->SetNumberOfComponents(4);
  this->Fields->SetNumberOfTuples(static_cast<vtkIdType>(model.NodeOfPoint().size()));
  for (std::size_t i = 0; i < model.NodeOfPoint().size(); ++i)
  {
    const morph::Index node = model.NodeOfPoint()[i];
    const auto tuple = static_cast<vtkIdType>(i);
    this->Fields->SetTypedComponent(tuple, 0, weight(node, 0) / shift[0]);
    for (int j = 0; j < 3; ++j)
    {
      this->Fields->SetTypedComponent(tuple, 1 + j, place(node, j));
    }
  }
}
}
