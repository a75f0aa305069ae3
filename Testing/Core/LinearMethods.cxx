// SPDX-License-Identifier: BSD-3-Clause
#include "LinearMethods.h"

#include "FemWarp.h"
#include "SimplexLinear.h"

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
    { "SimplexLinear", [] { return std::make_unique<SimplexLinear>(); } },
  };
  return methods;
}

std::ostream& operator<<(std::ostream& stream, const LinearMethod& method)
{
  return stream << method.name;
}
}
