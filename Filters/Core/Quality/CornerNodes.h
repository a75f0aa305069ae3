// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace morph
{
/// The places in a cell where its Jacobian determinant is measured: a corner and its three
/// neighbors along edges, in the order that makes the determinant of a valid cell positive.
inline constexpr int TetCornerNodes[1][4] = { { 0, 1, 2, 3 } };
inline constexpr int HexCornerNodes[8][4] = { { 0, 1, 3, 4 }, { 1, 2, 0, 5 }, { 2, 3, 1, 6 },
  { 3, 0, 2, 7 }, { 4, 7, 5, 0 }, { 5, 4, 6, 1 }, { 6, 5, 7, 2 }, { 7, 6, 4, 3 } };
inline constexpr int WedgeCornerNodes[6][4] = { { 0, 1, 2, 3 }, { 1, 2, 0, 4 }, { 2, 0, 1, 5 },
  { 3, 5, 4, 0 }, { 4, 3, 5, 1 }, { 5, 4, 3, 2 } };
/// At the base alone.
inline constexpr int PyramidCornerNodes[4][4] = { { 0, 1, 3, 4 }, { 1, 2, 0, 4 }, { 2, 3, 1, 4 },
  { 3, 0, 2, 4 } };
}
