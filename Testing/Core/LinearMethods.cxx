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

namespace
{
/// FEMWARP with cells that are not equally stiff.
std::function<std::unique_ptr<LinearMorpher>()> stiff(CellStiffness::Kind kind, double exponent)
{
  return [=]
  {
    auto method = std::make_unique<FemWarp>();
    method->setTolerance(1e-13);
    CellStiffness stiffness;
    stiffness.kind = kind;
    stiffness.exponent = exponent;
    method->setStiffness(stiffness);
    return method;
  };
}
}

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
    { "FemWarpInverseVolume", stiff(CellStiffness::Kind::InverseVolume, 1) },
    { "FemWarpWallDistance", stiff(CellStiffness::Kind::WallDistance, 2) },
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
    { "RadialBasisFewCenters",
      []
      {
        auto method = std::make_unique<RadialBasis>();
        method->setNumberOfCenters(20);
        return method;
      } },
    { "RadialBasisThinPlate",
      []
      {
        auto method = std::make_unique<RadialBasis>();
        method->setKernel(RadialKernel::Kind::ThinPlate);
        return method;
      } },
    { "SimplexLinear", [] { return std::make_unique<SimplexLinear>(); } },
    { "SimplexNaturalNeighbor", [] { return std::make_unique<SimplexNaturalNeighbor>(); } },
    { "WeightedResidual", [] { return std::make_unique<WeightedResidual>(); } },
  };
  return methods;
}

std::ostream& operator<<(std::ostream& stream, const LinearMethod& method)
{
  return stream << method.name;
}
}
