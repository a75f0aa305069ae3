// SPDX-License-Identifier: BSD-3-Clause
#include "vtkInversionFreeMorph.h"

#include "Untangling/InversionFree.h"

#include <vtkObjectFactory.h>

vtkStandardNewMacro(vtkInversionFreeMorph);

vtkInversionFreeMorph::vtkInversionFreeMorph()
{
  this->Validity = VALIDITY_SUB_STEP;
  this->Certify = true;
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
  static_cast<morph::InversionFree&>(morpher).setSteps(steps[this->Effort]);
}

void vtkInversionFreeMorph::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Effort: " << this->Effort << "\n";
}
