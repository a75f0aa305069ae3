// SPDX-License-Identifier: BSD-3-Clause
#include "vtkWeightedResidualMorph.h"

#include "LinearMethods/WeightedResidual.h"

#include <vtkObjectFactory.h>

vtkStandardNewMacro(vtkWeightedResidualMorph);

vtkWeightedResidualMorph::vtkWeightedResidualMorph() = default;
vtkWeightedResidualMorph::~vtkWeightedResidualMorph() = default;

std::unique_ptr<morph::Morpher> vtkWeightedResidualMorph::CreateMorpher()
{
  auto morpher = std::make_unique<morph::WeightedResidual>();
  morpher->setNumberOfNeighbors(this->NumberOfNeighbors);
  return morpher;
}

std::string vtkWeightedResidualMorph::PrepareOptions()
{
  return std::to_string(this->NumberOfNeighbors);
}

void vtkWeightedResidualMorph::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "NumberOfNeighbors: " << this->NumberOfNeighbors << "\n";
}
