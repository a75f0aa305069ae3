// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"

#include <iosfwd>
#include <string>
#include <vector>

namespace meshes
{
/// A mesh with cells or nodes as those of engineers have them.
struct Kind
{
  std::string name;
  morph::Mesh mesh;
  morph::Index turned = 0; ///< nodes that turn about others, and do not move affinely; the last
};

std::ostream& operator<<(std::ostream& stream, const Kind& kind);

std::vector<Kind> kinds();
}
