// SPDX-License-Identifier: BSD-3-Clause
#include "vtkRadialBasisMorph.h"

#include "LinearMethods/RadialBasis.h"
#include "Private/Pipeline/Property.h"

#include <vtkObjectFactory.h>

#include <algorithm>
#include <sstream>

vtkStandardNewMacro(vtkRadialBasisMorph);

morphSetNumberMacro(vtkRadialBasisMorph, SupportRadius, 1e-3, 1e3)

  vtkRadialBasisMorph::vtkRadialBasisMorph() = default;
vtkRadialBasisMorph::~vtkRadialBasisMorph() = default;

std::unique_ptr<morph::Morpher> vtkRadialBasisMorph::CreateMorpher()
{
  using Kind = morph::RadialKernel::Kind;
  auto morpher = std::make_unique<morph::RadialBasis>();
  morpher->setKernel(this->Kernel == KERNEL_THIN_PLATE    ? Kind::ThinPlate
                     : this->Kernel == KERNEL_WENDLAND_C2 ? Kind::WendlandC2
                                                          : Kind::Triharmonic);
  morpher->setSupportRadius(this->SupportRadius);
  morpher->setNumberOfCentres(
    this->NumberOfCenters > 0
      ? std::max<morph::Index>(this->NumberOfCenters, morph::RadialBasis::FewestCentres)
      : 0);
  return morpher;
}

std::string vtkRadialBasisMorph::PrepareOptions()
{
  std::ostringstream text;
  text.precision(17);
  text << this->Kernel << " " << this->SupportRadius << " " << this->NumberOfCenters;
  return text.str();
}

void vtkRadialBasisMorph::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Kernel: " << this->Kernel << "\n";
  os << indent << "SupportRadius: " << this->SupportRadius << "\n";
  os << indent << "NumberOfCenters: " << this->NumberOfCenters << "\n";
}
