// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSimplexNaturalNeighborMorph.h"

#include "LinearMethods/SimplexNaturalNeighbor.h"
#include "Private/Options.h"

#include <vtkObjectFactory.h>

vtkStandardNewMacro(vtkSimplexNaturalNeighborMorph);

vtkSimplexNaturalNeighborMorph::vtkSimplexNaturalNeighborMorph()
  : Options(std::make_unique<morph::SimplexNaturalNeighborMorphOptions>())
{
}

vtkSimplexNaturalNeighborMorph::~vtkSimplexNaturalNeighborMorph() = default;

std::unique_ptr<morph::Morpher> vtkSimplexNaturalNeighborMorph::CreateMorpher()
{
  auto morpher = std::make_unique<morph::SimplexNaturalNeighbor>();
  morpher->setMemoryLimit(static_cast<std::size_t>(1e6 * this->Options->MemoryLimit));
  return morpher;
}
