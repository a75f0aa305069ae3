// SPDX-License-Identifier: BSD-3-Clause
#include "vtkRadialBasisMorph.h"

#include "LinearMethods/RadialBasis.h"
#include "Private/Options.h"

#include <vtkObjectFactory.h>

#include <algorithm>

vtkStandardNewMacro(vtkRadialBasisMorph);

vtkRadialBasisMorph::vtkRadialBasisMorph()
  : Options(std::make_unique<morph::RadialBasisMorphOptions>())
{
}

vtkRadialBasisMorph::~vtkRadialBasisMorph() = default;

std::unique_ptr<morph::Morpher> vtkRadialBasisMorph::CreateMorpher()
{
  using Kind = morph::RadialKernel::Kind;
  auto morpher = std::make_unique<morph::RadialBasis>();
  morpher->setKernel(this->Options->Kernel == KERNEL_THIN_PLATE    ? Kind::ThinPlate
                     : this->Options->Kernel == KERNEL_WENDLAND_C2 ? Kind::WendlandC2
                                                                   : Kind::Triharmonic);
  morpher->setSupportRadius(this->Options->SupportRadius);
  morpher->setNumberOfCenters(
    this->Options->NumberOfCenters > 0
      ? std::max<morph::Index>(this->Options->NumberOfCenters, morph::RadialBasis::FewestCenters)
      : 0);
  return morpher;
}
