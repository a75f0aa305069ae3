// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/Faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

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

/// The small triangles or quadrilaterals between the nodes of a face of order three or more, which
/// form a lattice; none of another face.
std::vector<Faces::Polygon> latticePieces(const morph::CellShape& shape, int face)
{
  const morph::FaceShape& f = shape.faces[face];
  std::vector<std::array<double, 3>> places; // along two edges of the face, and the node
  int inside = 0;                            // of the first edge
  for (int k = 0; k < shape.numberOfNodes; ++k)
  {
    double N[8] = {};
    const int corner = static_cast<int>(
      std::find(shape.cornerNode, shape.cornerNode + shape.numberOfCorners, k) - shape.cornerNode);
    if (k < shape.numberOfCorners)
    {
      N[corner] = 1;
    }
    else
    {
      morph::shapeFunctions(shape.shape, shape.extraNodes[k - shape.numberOfCorners], N, nullptr);
    }
    double on[4] = {}, sum = 0;
    for (int i = 0; i < f.size; ++i)
    {
      on[i] = N[f.corner[i]];
      sum += on[i];
    }
    if (sum > 1 - 1e-9)
    {
      const bool isQuad = f.size == 4;
      places.push_back({ on[1] + (isQuad ? on[2] : 0), on[2] + (isQuad ? on[3] : 0), double(k) });
      inside += on[0] > 0 && on[1] > 0 && on[0] + on[1] > 1 - 1e-9 ? 1 : 0;
    }
  }
  const int order = inside + 1;
  if (order < 3)
  {
    return {};
  }
  std::map<std::pair<int, int>, int> at;
  for (const auto& [u, v, node] : places)
  {
    at[{ std::lround(u * order), std::lround(v * order) }] = static_cast<int>(node);
  }
  std::vector<Faces::Polygon> pieces;
  for (const auto& [place, node] : at)
  {
    const auto [i, j] = place;
    const auto right = at.find({ i + 1, j }), up = at.find({ i, j + 1 }),
               far = at.find({ i + 1, j + 1 });
    if (right == at.end() || up == at.end())
    {
      continue;
    }
    pieces.push_back(f.size == 4 ? Faces::Polygon{ node, right->second, far->second, up->second }
                                 : Faces::Polygon{ node, right->second, up->second });
    if (f.size == 3 && far != at.end())
    {
      pieces.push_back({ right->second, far->second, up->second });
    }
  }
  return pieces;
}
}

namespace Faces
{
std::vector<Polygon> Pieces(const morph::CellShape& shape, int face)
{
  if (std::vector<Polygon> pieces = latticePieces(shape, face); !pieces.empty())
  {
    return pieces;
  }
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
  const int center = nodeBetween(shape, all);

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
