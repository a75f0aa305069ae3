// SPDX-License-Identifier: BSD-3-Clause
#include "vtkLBWarpMorph.h"

#include "LinearMethods/LogBarrierWarp.h"
#include "Private/Pipeline/Property.h"

#include <vtkObjectFactory.h>

#include <sstream>

vtkStandardNewMacro(vtkLBWarpMorph);

morphSetNumberMacro(vtkLBWarpMorph, Tolerance, 1e-15, 0.999)

  vtkLBWarpMorph::vtkLBWarpMorph() = default;
vtkLBWarpMorph::~vtkLBWarpMorph() = default;

std::unique_ptr<morph::Morpher> vtkLBWarpMorph::CreateMorpher()
{
  auto morpher = std::make_unique<morph::LogBarrierWarp>();
  morpher->setOutsideHull(this->OutsideHull == OUTSIDE_HULL_RELAX
                            ? morph::LogBarrierWarp::OutsideHull::Relax
                            : morph::LogBarrierWarp::OutsideHull::Error);
  return morpher;
}

std::string vtkLBWarpMorph::PrepareOptions()
{
  return std::to_string(this->OutsideHull);
}

void vtkLBWarpMorph::SetEvaluateOptions(morph::Morpher& morpher)
{
  static_cast<morph::LogBarrierWarp&>(morpher).setTolerance(this->Tolerance);
}

std::string vtkLBWarpMorph::EvaluateOptions()
{
  std::ostringstream text;
  text.precision(17);
  text << this->Tolerance;
  return text.str();
}

void vtkLBWarpMorph::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "OutsideHull: " << this->OutsideHull << "\n";
}
