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
  using Method = morph::InversionFree;
  constexpr int steps[] = { Method::QuickSteps, Method::DefaultSteps, Method::ThoroughSteps };
  auto morpher = std::make_unique<Method>();
  morpher->setSteps(steps[this->Options->Effort]);
  return morpher;
}
