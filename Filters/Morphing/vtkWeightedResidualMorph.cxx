// SPDX-License-Identifier: BSD-3-Clause
#include "vtkWeightedResidualMorph.h"

#include "LinearMethods/WeightedResidual.h"
#include "Private/Options.h"

#include <vtkObjectFactory.h>

vtkStandardNewMacro(vtkWeightedResidualMorph);

vtkWeightedResidualMorph::vtkWeightedResidualMorph()
  : Options(std::make_unique<morph::WeightedResidualMorphOptions>())
{
}

vtkWeightedResidualMorph::~vtkWeightedResidualMorph() = default;

std::unique_ptr<morph::Morpher> vtkWeightedResidualMorph::CreateMorpher()
{
  auto morpher = std::make_unique<morph::WeightedResidual>();
  morpher->setNumberOfNeighbors(this->Options->NumberOfNeighbors);
  return morpher;
}
