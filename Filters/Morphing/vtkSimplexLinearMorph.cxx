// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSimplexLinearMorph.h"

#include "LinearMethods/SimplexLinear.h"

#include <vtkObjectFactory.h>

vtkStandardNewMacro(vtkSimplexLinearMorph);

vtkSimplexLinearMorph::vtkSimplexLinearMorph() = default;
vtkSimplexLinearMorph::~vtkSimplexLinearMorph() = default;

std::unique_ptr<morph::Morpher> vtkSimplexLinearMorph::CreateMorpher()
{
  return std::make_unique<morph::SimplexLinear>();
}
