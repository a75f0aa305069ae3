// SPDX-License-Identifier: BSD-3-Clause
#include "vtkInversionFreeMorph.h"

#include "Private/Options.h"
#include "Untangling/InversionFree.h"

#include <vtkObjectFactory.h>

vtkStandardNewMacro(vtkInversionFreeMorph);

vtkInversionFreeMorph::vtkInversionFreeMorph()
  : Options(std::make_unique<morph::InversionFreeMorphOptions>())
{
  this->SetValidity(morph::InversionFreeMorphDefaults::Validity);
  this->SetCertify(morph::InversionFreeMorphDefaults::Certify);
}

vtkInversionFreeMorph::~vtkInversionFreeMorph() = default;

std::unique_ptr<morph::Morpher> vtkInversionFreeMorph::CreateMorpher()
{
  return std::make_unique<morph::InversionFree>();
}

void vtkInversionFreeMorph::SetEvaluateOptions(morph::Morpher& morpher)
{
  using Steps = morph::RaisingSteps;
  constexpr int steps[] = { Steps::Quick, Steps::Default, Steps::Thorough };
  static_cast<morph::InversionFree&>(morpher).setSteps(steps[this->Options->Effort]);
}

void vtkInversionFreeMorph::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  this->PrintOptions(os, indent);
}
