// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Morpher/Morpher.h"

#include <functional>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

namespace meshes
{
/// A method whose properties TestLinearMorphers.cxx checks, in one setting of its options.
struct LinearMethod
{
  std::string name; ///< letters and digits
  std::function<std::unique_ptr<morph::LinearMorpher>()> make;
};

/// Every linear method.
const std::vector<LinearMethod>& linearMethods();

std::ostream& operator<<(std::ostream& stream, const LinearMethod& method);
}
