// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods.h"

#include "LinearMethods/FemWarp.h"
#include "LinearMethods/LogBarrierWarp.h"
#include "LinearMethods/RadialBasis.h"
#include "LinearMethods/SimplexLinear.h"
#include "LinearMethods/SimplexNaturalNeighbor.h"
#include "LinearMethods/WeightedResidual.h"

#include <ostream>

namespace meshes
{
using namespace morph;

const std::vector<LinearMethod>& linearMethods()
{
  static const std::vector<LinearMethod> methods = {
    { "FemWarp",
      []
      {
        auto method = std::make_unique<FemWarp>();
        method->setTolerance(1e-13);
        return method;
      } },
    { "LogBarrierWarp",
      []
      {
        auto method = std::make_unique<LogBarrierWarp>();
        method->setTolerance(1e-13);
        return method;
      } },
    { "RadialBasis", [] { return std::make_unique<RadialBasis>(); } },
    { "RadialBasisCompact",
      []
      {
        auto method = std::make_unique<RadialBasis>();
        method->setKernel(RadialKernel::Kind::WendlandC2);
        return method;
      } },
    { "RadialBasisFewCentres",
      []
      {
        auto method = std::make_unique<RadialBasis>();
        method->setNumberOfCentres(20);
        return method;
      } },
    { "RadialBasisThinPlate",
      []
      {
        auto method = std::make_unique<RadialBasis>();
        method->setKernel(RadialKernel::Kind::ThinPlate);
        return method;
      } },
    { "SimplexLaplace",
      []
      {
        auto method = std::make_unique<SimplexNaturalNeighbor>();
        method->setCoordinates(SimplexNaturalNeighbor::Coordinates::Laplace);
        return method;
      } },
    { "SimplexLinear", [] { return std::make_unique<SimplexLinear>(); } },
    { "SimplexSibson", [] { return std::make_unique<SimplexNaturalNeighbor>(); } },
    { "WeightedResidual", [] { return std::make_unique<WeightedResidual>(); } },
    { "WeightedResidualAdaptive",
      []
      {
        auto method = std::make_unique<WeightedResidual>();
        method->setNumberOfNeighbors(20);
        method->setAdaptiveNeighbors(true);
        return method;
      } },
  };
  return methods;
}

std::ostream& operator<<(std::ostream& stream, const LinearMethod& method)
{
  return stream << method.name;
}
}
