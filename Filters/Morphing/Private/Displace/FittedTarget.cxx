// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/FittedTarget.h"

#include "BoundaryMover/FitToTarget.h"
#include "Private/Project/TargetData.h"
#include "Support/ProgressRange.h"

#include <vtkPolyData.h>

namespace morph::filters
{
void FittedTarget::Update(vtkPolyData* target, const morph::BoundaryModel& model,
  const morph::Choice* choice, bool align, const morph::Target::Options& options,
  morph::Monitor& monitor)
{
  const std::vector<morph::Index> onto =
    align && choice ? choice->moving : std::vector<morph::Index>();
  const auto isMade = [&](const morph::Target::Options& made)
  {
    return made.featureAngle == options.featureAngle && made.normalAngle == options.normalAngle &&
           made.reach == options.reach;
  };
  if (this->Place && this->Input == target && this->InputTime == target->GetMTime() &&
      this->MotionVersion == model.motionVersion && this->AlignedOnto == onto &&
      this->IsAligned == align && isMade(this->Place->options()))
  {
    return;
  }
  this->Place.reset(); // in case it throws
  morph::ProgressRange making(monitor, 0, 0.05), aligning(monitor, 0.05, 0.5);
  auto place = TargetData::Make(target, model.points(), model.size, options, this->Warning, making);
  if (align)
  {
    const Eigen::Isometry3d motion = morph::alignedOnto(model, choice, *place, aligning);
    const Eigen::Matrix3Xd points = motion * place->points().transpose();
    place = std::make_unique<morph::Target>(
      points.transpose(), place->triangles(), model.points(), place->options(), making);
  }
  this->Input = target;
  this->InputTime = target->GetMTime();
  this->MotionVersion = model.motionVersion;
  this->AlignedOnto = onto;
  this->IsAligned = align;
  this->Triangles = TargetData::Surface(*place);
  this->Place = std::move(place);
}
}
