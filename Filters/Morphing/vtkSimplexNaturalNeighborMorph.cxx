// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSimplexNaturalNeighborMorph.h"

#include "LinearMethods/SimplexNaturalNeighbor.h"
#include "Private/Pipeline/Property.h"

#include <vtkObjectFactory.h>

#include <sstream>

vtkStandardNewMacro(vtkSimplexNaturalNeighborMorph);

morphSetNumberMacro(vtkSimplexNaturalNeighborMorph, MemoryLimit, 0.0, 1e12)

  vtkSimplexNaturalNeighborMorph::vtkSimplexNaturalNeighborMorph() = default;
vtkSimplexNaturalNeighborMorph::~vtkSimplexNaturalNeighborMorph() = default;

std::unique_ptr<morph::Morpher> vtkSimplexNaturalNeighborMorph::CreateMorpher()
{
  auto morpher = std::make_unique<morph::SimplexNaturalNeighbor>();
  morpher->setMemoryLimit(static_cast<std::size_t>(1e6 * this->MemoryLimit));
  return morpher;
}

std::string vtkSimplexNaturalNeighborMorph::PrepareOptions()
{
  std::ostringstream text;
  text.precision(17);
  text << this->MemoryLimit;
  return text.str();
}

void vtkSimplexNaturalNeighborMorph::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MemoryLimit: " << this->MemoryLimit << "\n";
}
