// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/Faces.h"

namespace morph::filters
{
namespace
{
/// The mid-side or face node that lies midway between exactly these corners, or -1.
int nodeBetween(const morph::CellShape& shape, unsigned corners)
{
  for (int k = shape.numberOfCorners; k < shape.numberOfNodes; ++k)
  {
    double N[8];
    morph::shapeFunctions(shape.shape, shape.extraNodes[k - shape.numberOfCorners], N, nullptr);
    unsigned sharing = 0;
    for (int a = 0; a < shape.numberOfCorners; ++a)
    {
      sharing |= N[a] != 0 ? 1u << a : 0u;
    }
    if (sharing == corners)
    {
      return k;
    }
  }
  return -1;
}
}

namespace Faces
{
std::vector<Polygon> Pieces(const morph::CellShape& shape, int face)
{
  const morph::FaceShape& f = shape.faces[face];
  const int n = f.size;
  Polygon corners(n), middles(n);
  unsigned all = 0;
  for (int k = 0; k < n; ++k)
  {
    corners[k] = shape.cornerNode[f.corner[k]];
    middles[k] = nodeBetween(shape, 1u << f.corner[k] | 1u << f.corner[(k + 1) % n]);
    all |= 1u << f.corner[k];
  }
  const int center = n == 4 ? nodeBetween(shape, all) : -1;

  if (n == 4 && middles[0] < 0 && middles[1] >= 0)
  {
    return { { corners[0], corners[1], middles[1], middles[3] },
      { middles[3], middles[1], corners[2], corners[3] } };
  }
  if (n == 4 && middles[0] >= 0 && middles[1] < 0)
  {
    return { { corners[0], middles[0], middles[2], corners[3] },
      { middles[0], corners[1], corners[2], middles[2] } };
  }
  if (middles[0] < 0)
  {
    return { corners };
  }
  std::vector<Polygon> pieces;
  for (int k = 0; k < n; ++k)
  {
    pieces.push_back({ corners[k], middles[k] });
    if (center >= 0)
    {
      pieces.back().push_back(center);
    }
    pieces.back().push_back(middles[(k + n - 1) % n]);
  }
  if (center < 0)
  {
    pieces.push_back(middles);
  }
  return pieces;
}
}
}
