// SPDX-License-Identifier: BSD-3-Clause
#include "AllFilters.h"

#include "vtkBoundaryDisplacement.h"
#include "vtkClassifyBoundary.h"
#include "vtkCompareMorphMethods.h"
#include "vtkExtractMorphBoundary.h"
#include "vtkFEMWarpMorph.h"
#include "vtkInversionFreeMorph.h"
#include "vtkLBWarpMorph.h"
#include "vtkMorphAdjoint.h"
#include "vtkMorphBoundary.h"
#include "vtkMorphMesh.h"
#include "vtkMorphShapes.h"
#include "vtkRadialBasisMorph.h"
#include "vtkScaledJacobian.h"
#include "vtkSimplexLinearMorph.h"
#include "vtkSimplexNaturalNeighborMorph.h"
#include "vtkSmoothingMorph.h"
#include "vtkWeightedResidualMorph.h"

#include <vtkNew.h>

#include <ostream>

namespace grids
{
namespace
{
template <typename Filter>
vtkSmartPointer<vtkAlgorithm> make()
{
  return vtkSmartPointer<Filter>::New();
}

vtkSmartPointer<vtkAlgorithm> makeCompare()
{
  auto filter = vtkSmartPointer<vtkCompareMorphMethods>::New();
  filter->SetNumberOfSteps(1);
  filter->SmoothingOff();
  filter->InversionFreeOff();
  return filter;
}

vtkSmartPointer<vtkAlgorithm> makeMesh()
{
  auto filter = vtkSmartPointer<vtkMorphMesh>::New();
  filter->SetMovingToEverything();
  return filter;
}

vtkSmartPointer<vtkAlgorithm> makeShapes()
{
  auto filter = vtkSmartPointer<vtkMorphShapes>::New();
  filter->SetWeight(0, 1);
  return filter;
}

vtkSmartPointer<vtkAlgorithm> makeAdjoint()
{
  auto filter = vtkSmartPointer<vtkMorphAdjoint>::New();
  filter->SetMorph(vtkNew<vtkFEMWarpMorph>());
  filter->SetGradientArray("Gradient");
  return filter;
}
}

vtkSmartPointer<vtkAlgorithm> AnyFilter::connected(
  vtkDataObject* grid, vtkDataObject* boundary) const
{
  auto filter = this->make();
  filter->SetInputDataObject(0, grid);
  if (this->hasBoundary)
  {
    filter->SetInputDataObject(1, boundary);
  }
  return filter;
}

const std::vector<AnyFilter>& allFilters()
{
  static const std::vector<AnyFilter> filters = {
    { "BoundaryDisplacement", make<vtkBoundaryDisplacement>, false },
    { "ClassifyBoundary", make<vtkClassifyBoundary>, false },
    { "CompareMorphMethods", makeCompare, true },
    { "ExtractMorphBoundary", make<vtkExtractMorphBoundary>, false },
    { "FEMWarp", make<vtkFEMWarpMorph>, true },
    { "InversionFree", make<vtkInversionFreeMorph>, true },
    { "LBWarp", make<vtkLBWarpMorph>, true },
    { "MorphAdjoint", makeAdjoint, true },
    { "MorphBoundary", make<vtkMorphBoundary>, true },
    { "MorphMesh", makeMesh, false },
    { "MorphShapes", makeShapes, true },
    { "ScaledJacobian", make<vtkScaledJacobian>, false },
    { "SimplexLinear", make<vtkSimplexLinearMorph>, true },
    { "RadialBasis", make<vtkRadialBasisMorph>, true },
    { "SimplexNaturalNeighbor", make<vtkSimplexNaturalNeighborMorph>, true },
    { "Smoothing", make<vtkSmoothingMorph>, true },
    { "WeightedResidual", make<vtkWeightedResidualMorph>, true },
  };
  return filters;
}

std::ostream& operator<<(std::ostream& stream, const AnyFilter& filter)
{
  return stream << filter.name;
}
}
