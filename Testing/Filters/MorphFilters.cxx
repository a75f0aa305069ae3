// SPDX-License-Identifier: BSD-3-Clause
#include "MorphFilters.h"

#include "vtkFEMWarpMorph.h"
#include "vtkLBWarpMorph.h"
#include "vtkRadialBasisMorph.h"
#include "vtkSimplexLinearMorph.h"
#include "vtkSimplexNaturalNeighborMorph.h"
#include "vtkWeightedResidualMorph.h"

#include <ostream>

namespace grids
{
namespace
{
template <typename Filter>
vtkSmartPointer<vtkMorphAlgorithm> make()
{
  return vtkSmartPointer<Filter>::New();
}

/// Calls `call` with a filter that is known to be of its type.
template <typename Filter, typename Result>
std::function<Result(vtkMorphAlgorithm*)> on(Result (*call)(Filter*))
{
  return [call](vtkMorphAlgorithm* filter) { return call(Filter::SafeDownCast(filter)); };
}
}

const std::vector<MorphFilter>& morphFilters()
{
  using Fem = vtkFEMWarpMorph;
  using LogBarrier = vtkLBWarpMorph;
  using Linear = vtkSimplexLinearMorph;
  using Natural = vtkSimplexNaturalNeighborMorph;
  using Radial = vtkRadialBasisMorph;
  using Residual = vtkWeightedResidualMorph;
  static const std::vector<MorphFilter> filters = {
    { "FEMWarp",
      []
      {
        auto filter = vtkSmartPointer<Fem>::New();
        filter->SetTolerance(1e-12);
        return vtkSmartPointer<vtkMorphAlgorithm>(filter);
      },
      { { "Tolerance", on<Fem, void>([](Fem* f) { f->SetTolerance(1e-3); }), false } }, {} },
    { "LBWarp",
      []
      {
        auto filter = vtkSmartPointer<LogBarrier>::New();
        filter->SetTolerance(1e-12);
        return vtkSmartPointer<vtkMorphAlgorithm>(filter);
      },
      { { "Tolerance", on<LogBarrier, void>([](LogBarrier* f) { f->SetTolerance(1e-3); }), false },
        { "OutsideHull", on<LogBarrier, void>([](LogBarrier* f) { f->SetOutsideHullToRelax(); }),
          true } },
      { { "OutsideHullNodes",
          on<LogBarrier, vtkIdType>([](LogBarrier* f) { return f->GetOutsideHullNodes(); }) },
        { "TwoRingNodes",
          on<LogBarrier, vtkIdType>([](LogBarrier* f) { return f->GetTwoRingNodes(); }) },
        { "AffineNodes",
          on<LogBarrier, vtkIdType>([](LogBarrier* f) { return f->GetAffineNodes(); }) },
        { "StiffnessNodes",
          on<LogBarrier, vtkIdType>([](LogBarrier* f) { return f->GetStiffnessNodes(); }) } } },
    { "RadialBasis", make<Radial>,
      { { "Kernel", on<Radial, void>([](Radial* f) { f->SetKernelToWendlandC2(); }), true },
        { "SupportRadius", on<Radial, void>([](Radial* f) { f->SetSupportRadius(0.5); }), true },
        { "NumberOfCenters", on<Radial, void>([](Radial* f) { f->SetNumberOfCenters(9); }),
          true } },
      { { "Centers", on<Radial, vtkIdType>([](Radial* f) { return f->GetCenters(); }) },
        { "CorrectedSites",
          on<Radial, vtkIdType>([](Radial* f) { return f->GetCorrectedSites(); }) },
        { "LargestResidualPPM",
          on<Radial, vtkIdType>([](Radial* f) { return f->GetLargestResidualPPM(); }) } } },
    { "SimplexLinear", make<Linear>, {},
      { { "FoldedTetrahedra",
          on<Linear, vtkIdType>([](Linear* f) { return f->GetFoldedTetrahedra(); }) },
        { "ExtrapolatedNodes",
          on<Linear, vtkIdType>([](Linear* f) { return f->GetExtrapolatedNodes(); }) } } },
    { "SimplexNaturalNeighbor", make<Natural>,
      { { "MemoryLimit", on<Natural, void>([](Natural* f) { f->SetMemoryLimit(3000); }), true } },
      { { "BarycentricNodes",
          on<Natural, vtkIdType>([](Natural* f) { return f->GetBarycentricNodes(); }) },
        { "ExtrapolatedNodes",
          on<Natural, vtkIdType>([](Natural* f) { return f->GetExtrapolatedNodes(); }) },
        { "WeightsStored",
          on<Natural, vtkIdType>([](Natural* f) { return f->GetWeightsStored(); }) } } },
    { "WeightedResidual", make<Residual>,
      { { "NumberOfNeighbors", on<Residual, void>([](Residual* f) { f->SetNumberOfNeighbors(7); }),
        true } },
      {} },
  };
  return filters;
}

vtkSmartPointer<vtkMorphAlgorithm> MorphFilter::of(
  vtkDataObject* mesh, vtkDataObject* boundary) const
{
  auto filter = this->make();
  filter->SetInputDataObject(mesh);
  filter->SetBoundaryData(boundary);
  return filter;
}

vtkSmartPointer<vtkMorphAlgorithm> MorphFilter::of(vtkUnstructuredGrid* grid, const Map& map) const
{
  return this->of(grid, boundary(grid, map));
}

std::ostream& operator<<(std::ostream& stream, const MorphFilter& filter)
{
  return stream << filter.name;
}
}
