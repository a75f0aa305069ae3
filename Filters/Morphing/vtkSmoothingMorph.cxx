// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSmoothingMorph.h"

#include "Private/Options.h"
#include "Untangling/Smoothing.h"

#include <vtkObjectFactory.h>

vtkStandardNewMacro(vtkSmoothingMorph);

vtkSmoothingMorph::vtkSmoothingMorph()
  : Options(std::make_unique<morph::SmoothingMorphOptions>())
{
}

vtkSmoothingMorph::~vtkSmoothingMorph() = default;

std::unique_ptr<morph::Morpher> vtkSmoothingMorph::CreateMorpher()
{
  morph::SmoothingOptions options;
  options.target = this->Options->TargetShape == TARGET_SHAPE_INITIAL
                     ? morph::SmoothingTarget::Initial
                     : morph::SmoothingTarget::Ideal;
  options.objective = static_cast<morph::SmoothingObjective>(this->Options->Objective);
  options.iterationLimit = this->Options->IterationLimit;
  options.stopMove = this->Options->StopMove;
  auto morpher = std::make_unique<morph::Smoothing>();
  morpher->setOptions(options);
  return morpher;
}
