// SPDX-License-Identifier: BSD-3-Clause
#include "vtkFEMWarpMorph.h"

#include "LinearMethods/FemWarp.h"
#include "Private/Morph/Stiffness.h"
#include "Private/Options.h"

#include <vtkObjectFactory.h>

vtkStandardNewMacro(vtkFEMWarpMorph);

vtkFEMWarpMorph::vtkFEMWarpMorph()
  : Taken(std::make_unique<morph::CellStiffness>())
  , Options(std::make_unique<morph::FEMWarpMorphOptions>())
{
}

vtkFEMWarpMorph::~vtkFEMWarpMorph() = default;

void vtkFEMWarpMorph::TakeInputs(vtkUnstructuredGrid* rest, vtkDataObject* boundary)
{
  namespace stiffness = morph::filters::Stiffness;
  *this->Taken = stiffness::Take(stiffness::Of(*this->Options), rest, boundary);
}

std::unique_ptr<morph::Morpher> vtkFEMWarpMorph::CreateMorpher()
{
  auto morpher = std::make_unique<morph::FemWarp>();
  morpher->setStiffness(*this->Taken);
  morpher->setTolerance(this->Options->Tolerance);
  return morpher;
}
