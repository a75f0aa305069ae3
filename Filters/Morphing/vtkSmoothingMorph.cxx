// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSmoothingMorph.h"

#include "Private/Pipeline/Property.h"
#include "Untangling/Smoothing.h"

#include <vtkObjectFactory.h>

vtkStandardNewMacro(vtkSmoothingMorph);

morphSetNumberMacro(vtkSmoothingMorph, StopMove, 1e-12, 1.0)

  vtkSmoothingMorph::vtkSmoothingMorph() = default;
vtkSmoothingMorph::~vtkSmoothingMorph() = default;

std::unique_ptr<morph::Morpher> vtkSmoothingMorph::CreateMorpher()
{
  return std::make_unique<morph::Smoothing>();
}

void vtkSmoothingMorph::SetEvaluateOptions(morph::Morpher& morpher)
{
  morph::SmoothingOptions options;
  options.target = this->TargetShape == TARGET_SHAPE_INITIAL ? morph::SmoothingTarget::Initial
                                                             : morph::SmoothingTarget::Ideal;
  options.objective = static_cast<morph::SmoothingObjective>(this->Objective);
  options.iterationLimit = this->IterationLimit;
  options.stopMove = this->StopMove;
  static_cast<morph::Smoothing&>(morpher).setOptions(options);
}

void vtkSmoothingMorph::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "TargetShape: " << this->TargetShape << "\n";
  os << indent << "Objective: " << this->Objective << "\n";
  os << indent << "IterationLimit: " << this->IterationLimit << "\n";
  os << indent << "StopMove: " << this->StopMove << "\n";
}
