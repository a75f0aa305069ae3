// SPDX-License-Identifier: BSD-3-Clause
#include "vtkLBWarpMorph.h"

#include "LinearMethods/LogBarrierWarp.h"
#include "Private/Options.h"

#include <vtkObjectFactory.h>

#include <sstream>

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
  return morpher;
}

std::string vtkLBWarpMorph::PrepareOptions()
{
  return std::to_string(this->Options->OutsideHull);
}

void vtkLBWarpMorph::SetEvaluateOptions(morph::Morpher& morpher)
{
  static_cast<morph::LogBarrierWarp&>(morpher).setTolerance(this->Options->Tolerance);
}

std::string vtkLBWarpMorph::EvaluateOptions()
{
  std::ostringstream text;
  text.precision(17);
  text << this->Options->Tolerance;
  return text.str();
}

void vtkLBWarpMorph::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  this->PrintOptions(os, indent);
}
