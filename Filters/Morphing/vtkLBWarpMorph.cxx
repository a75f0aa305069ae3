// SPDX-License-Identifier: BSD-3-Clause
#include "vtkLBWarpMorph.h"

#include "LinearMethods/LogBarrierWarp.h"
#include "Private/Options.h"

#include <vtkObjectFactory.h>

vtkStandardNewMacro(vtkLBWarpMorph);

vtkLBWarpMorph::vtkLBWarpMorph()
  : Options(std::make_unique<morph::LBWarpMorphOptions>())
{
}

vtkLBWarpMorph::~vtkLBWarpMorph() = default;

std::unique_ptr<morph::Morpher> vtkLBWarpMorph::CreateMorpher()
{
  auto morpher = std::make_unique<morph::LogBarrierWarp>();
  morpher->setOutsideHull(this->Options->OutsideHull == OUTSIDE_HULL_RELAX
                            ? morph::LogBarrierWarp::OutsideHull::Relax
                            : morph::LogBarrierWarp::OutsideHull::Error);
  morpher->setTolerance(this->Options->Tolerance);
  return morpher;
}
