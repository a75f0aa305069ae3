// SPDX-License-Identifier: BSD-3-Clause
#include "vtkFEMWarpMorph.h"

#include "LinearMethods/FemWarp.h"
#include "Private/Pipeline/Property.h"

#include <vtkObjectFactory.h>

#include <sstream>

vtkStandardNewMacro(vtkFEMWarpMorph);

morphSetNumberMacro(vtkFEMWarpMorph, Tolerance, 1e-15, 0.999)

  vtkFEMWarpMorph::vtkFEMWarpMorph() = default;
vtkFEMWarpMorph::~vtkFEMWarpMorph() = default;

std::unique_ptr<morph::Morpher> vtkFEMWarpMorph::CreateMorpher()
{
  auto morpher = std::make_unique<morph::FemWarp>();
  this->GiveStiffness(*morpher);
  return morpher;
}

std::string vtkFEMWarpMorph::PrepareOptions()
{
  return this->StiffnessOptions();
}

void vtkFEMWarpMorph::SetEvaluateOptions(morph::Morpher& morpher)
{
  static_cast<morph::FemWarp&>(morpher).setTolerance(this->Tolerance);
}

std::string vtkFEMWarpMorph::EvaluateOptions()
{
  std::ostringstream text;
  text.precision(17);
  text << this->Tolerance;
  return text.str();
}

void vtkFEMWarpMorph::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Tolerance: " << this->Tolerance << "\n";
}
