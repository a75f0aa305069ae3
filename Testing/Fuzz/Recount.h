// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"

#include <cstdint>
#include <vector>

namespace fuzz
{
/// How many volume cells are inverted or degenerate, counted from determinants at corners (and the
/// center of hexahedra) without the library's own code. Rounding and cells whose sense nobody can
/// tell leave a range.
struct Recount
{
  morph::Index lowest = 0;
  /// counts all quadratic cells: they may be inverted between their corners
  morph::Index highest = 0;
  std::vector<std::int8_t> bad; ///< #cells: 1 surely, 0 surely not, -1 either
};

/// `reference`: the positions that give the sense of the cells of a body. `skip`: #cells or
/// empty.
Recount recount(const morph::Mesh& mesh, const morph::Points& reference,
  const morph::Points& points, const std::vector<std::uint8_t>& skip = {});

/// Whether a body's cells of one shape are all in the order mirrored to VTK's: 1 if some surely
/// are, 0 if surely none are, -1 if nobody can tell.
int isMirrored(const morph::Mesh& mesh);

/// Whether a mirror inverts cells of a valid mesh. The order of a body's only tetrahedron,
/// hexahedron or pyramid is VTK's, as nothing tells that it is mirrored.
bool isInvertedByMirror(const morph::Mesh& mesh);

/// Whether all volume cells are valid at their corners by more than rounding, in VTK's order. Of
/// a mesh of faces alone: whether none is folded at its corners.
bool isValid(const morph::Mesh& mesh, const morph::Points& points, double least);

/// A cell whose `claim` is 1, positive everywhere, and that is inverted at a random place by more
/// than `rounding`; -1 if there is none. Determinants are those of VTK's own shape functions.
morph::Index falselyCertified(const morph::Mesh& mesh, const morph::Points& reference,
  const morph::Points& points, const std::vector<signed char>& claim, double rounding,
  std::uint64_t seed);
}
