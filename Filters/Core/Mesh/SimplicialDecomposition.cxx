// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/SimplicialDecomposition.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace morph
{
namespace
{
constexpr WeightedTet TetTets[] = { { { 0, 1, 2, 3 }, 1. } };
// One tetrahedron at each corner, and the two inner ones of the splits into five.
constexpr WeightedTet HexTets[] = { { { 0, 1, 3, 4 }, .5 }, { { 1, 2, 0, 5 }, .5 },
  { { 2, 3, 1, 6 }, .5 }, { { 3, 0, 2, 7 }, .5 }, { { 4, 7, 5, 0 }, .5 }, { { 5, 4, 6, 1 }, .5 },
  { { 6, 5, 7, 2 }, .5 }, { { 7, 6, 4, 3 }, .5 }, { { 0, 2, 7, 5 }, .5 }, { { 1, 3, 4, 6 }, .5 } };
constexpr double Third = 1. / 3., Sixth = 1. / 6.;
constexpr WeightedTet WedgeTets[] = { { { 0, 1, 2, 3 }, Third }, { { 1, 2, 0, 4 }, Third },
  { { 2, 0, 1, 5 }, Third }, { { 3, 5, 4, 0 }, Third }, { { 4, 3, 5, 1 }, Third },
  { { 5, 4, 3, 2 }, Third }, { { 0, 1, 5, 4 }, Sixth }, { { 1, 2, 3, 5 }, Sixth },
  { { 2, 0, 4, 3 }, Sixth }, { { 0, 2, 5, 4 }, Sixth }, { { 2, 1, 4, 3 }, Sixth },
  { { 1, 0, 3, 5 }, Sixth } };
constexpr WeightedTet PyramidTets[] = { { { 0, 1, 3, 4 }, .5 }, { { 1, 2, 0, 4 }, .5 },
  { { 2, 3, 1, 4 }, .5 }, { { 3, 0, 2, 4 }, .5 } };
}

SimplicialDecomposition simplicialDecomposition(Shape shape)
{
  switch (shape)
  {
    case Shape::Tet:
      return { 1, TetTets };
    case Shape::Hex:
      return { 10, HexTets };
    case Shape::Wedge:
      return { 12, WedgeTets };
    case Shape::Pyramid:
      return { 4, PyramidTets };
    default:
      return { 0, nullptr };
  }
}

int numberOfCorners(Shape shape)
{
  switch (shape)
  {
    case Shape::Tet:
      return 4;
    case Shape::Hex:
      return 8;
    case Shape::Wedge:
      return 6;
    case Shape::Pyramid:
      return 5;
    default:
      return 0;
  }
}

int cornerTetrahedra(Shape shape)
{
  switch (shape)
  {
    case Shape::Tet:
      return 1;
    case Shape::Pyramid:
      return 4;
    default:
      return numberOfCorners(shape);
  }
}

double signedVolume(Shape shape, const double (*corners)[3])
{
  using Vector = Eigen::Map<const Eigen::Vector3d>;
  const SimplicialDecomposition split = simplicialDecomposition(shape);
  double sum = 0;
  for (int t = 0; t < split.count; ++t)
  {
    const int* c = split.tets[t].corner;
    const Vector origin(corners[c[0]]);
    const Eigen::Vector3d a = Vector(corners[c[1]]) - origin, b = Vector(corners[c[2]]) - origin,
                          d = Vector(corners[c[3]]) - origin;
    sum += split.tets[t].weight * a.dot(b.cross(d)) / 6;
  }
  return sum;
}
}
