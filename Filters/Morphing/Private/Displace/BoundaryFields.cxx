// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/BoundaryFields.h"

#include "Private/Data/AffineArrays.h"
#include "Private/Data/Arrays.h"

#include <vtkPolyData.h>

#include <algorithm>

namespace morph::filters
{
namespace
{
bool follows(const Surroundings::Options& rest, const Surroundings::Result& result)
{
  return (rest.how == Surroundings::Kind::Follow || rest.how == Surroundings::Kind::FollowAll) &&
         std::count(result.roles.begin(), result.roles.end(), Surroundings::Follows) > 0;
}
}

void BoundaryFields::Write(const InputBoundary& model, const Choice& choice,
  const Motion::Options& motion, const Surroundings::Options& rest,
  const Surroundings::Result& result, Surroundings& spread, vtkPolyData* output,
  morph::Monitor& monitor)
{
  AffineArrays::Remove(output);
  Surroundings::Options linear = rest;
  linear.sliding.clear(); // has no effect on what is linear
  linear.follow.linear = true;
  if (!follows(rest, result))
  {
    linear.how = rest.how == Surroundings::Kind::Fade ? rest.how : Surroundings::Kind::Stay;
  }
  else if (rest.follow.method != morph::SurfaceMorphOptions::Method::WeightedResidual)
  {
    return;
  }
  if (!this->Fields || this->MotionVersion != model.motionVersion || !(this->Rest == linear) ||
      !(this->Chosen == choice))
  {
    this->Fields = nullptr; // in case it throws
    this->Compute(model, choice, linear, spread, monitor);
    this->MotionVersion = model.motionVersion;
    this->Rest = linear;
    this->Chosen = choice;
  }
  const auto affine = Motion::Affine(model, choice, motion, this->Center);
  if (affine && this->Give(*affine, model, result.moved))
  {
    AffineArrays::Write(this->Fields, *affine, output);
  }
}

bool BoundaryFields::Give(
  const morph::AffineMotion& motion, const InputBoundary& model, const morph::Points& moved) const
{
  const std::vector<morph::Index>& nodes = model.NodeOfPoint();
  double before = 0, after = 0;
  for (const morph::Index node : nodes)
  {
    before = std::max(before, model.points().row(node).cwiseAbs().maxCoeff());
    after = std::max(after, moved.row(node).cwiseAbs().maxCoeff());
  }
  const double tolerance = AffineArrays::Rounding(before + after, false);
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    const morph::Index node = nodes[i];
    Eigen::Matrix<double, 1, 4> fields(0, 0, 0, 0); // GCC 14 does not see that it is filled
    this->Fields->GetTypedTuple(static_cast<vtkIdType>(i), fields.data());
    const Eigen::RowVector3d place =
      model.points().row(node) + morph::affineDisplacement(motion, fields);
    if (!((place - moved.row(node)).cwiseAbs().maxCoeff() <= tolerance)) // NaN, too
    {
      return false;
    }
  }
  return true;
}

void BoundaryFields::Compute(const InputBoundary& model, const Choice& choice,
  const Surroundings::Options& options, Surroundings& spread, morph::Monitor& monitor)
{
  // The answers to p = x - center, and to a shift along x by the model's size, which keeps the
  // digits of w.
  this->Center = morph::centerOfMoving(model, choice);
  const morph::Points from = model.points()(choice.moving, morph::allColumns);
  const Eigen::RowVector3d shift(model.size > 0 ? model.size : 1, 0, 0);
  const morph::Points place =
    spread.spread(model, choice, (2 * from).rowwise() - this->Center, options, monitor).moved -
    model.points();
  const morph::Points weight =
    spread.spread(model, choice, from.rowwise() + shift, options, monitor).moved - model.points();

  this->Fields = Arrays::Make<vtkDoubleArray>(
    AffineArrays::FieldsName, static_cast<vtkIdType>(model.NodeOfPoint().size()), 4);
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
