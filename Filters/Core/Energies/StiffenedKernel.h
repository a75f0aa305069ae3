// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Energies/BatchHessian.h"
#include "Energies/StiffenedDistortion.h"

#include <algorithm>
#include <array>
#include <limits>

namespace morph
{
/// The formulas of StiffenedDistortion: the samples of a batch of cells, the barrier of their
/// distortions, and its derivatives by cosines. One source includes this, as all is inlined.
namespace stiffened
{
using namespace foldover;

constexpr double Infinity = std::numeric_limits<double>::infinity();
/// Gauss-Newton leaves out how cosines bend. A step that turns edges far is not to be trusted, so
/// the matrix has this times the square of each edge's change over its length.
constexpr double Proximity = 30;

/// A tetrahedron's corners in positive order; the decomposition has only one of them.
constexpr WeightedTet TetCorners[4] = { { { 0, 1, 2, 3 }, 1 }, { { 1, 2, 0, 3 }, 1 },
  { { 2, 0, 1, 3 }, 1 }, { { 3, 0, 2, 1 }, 1 } };

/// The corners of the tetrahedra at a pyramid's base corners, of which its scaled Jacobian is the
/// minimum.
constexpr int MostCorners = 16;
constexpr std::array<WeightedTet, MostCorners> pyramidCorners()
{
  constexpr int Bases[4][4] = { { 0, 1, 3, 4 }, { 1, 2, 0, 4 }, { 2, 3, 1, 4 }, { 3, 0, 2, 4 } };
  std::array<WeightedTet, MostCorners> result{};
  for (int k = 0; k < MostCorners; ++k)
  {
    for (int i = 0; i < 4; ++i)
    {
      result[k].corner[i] = Bases[k / 4][TetCorners[k % 4].corner[i]];
    }
  }
  return result;
}
constexpr std::array<WeightedTet, MostCorners> PyramidCorners = pyramidCorners();

inline SimplicialDecomposition cornersOf(Shape shape)
{
  switch (shape)
  {
    case Shape::Tet:
      return { 4, TetCorners };
    case Shape::Pyramid:
      return { MostCorners, PyramidCorners.data() };
    default:
      return { cornerTetrahedra(shape), simplicialDecomposition(shape).tets };
  }
}

inline int numberOfSamples(Shape shape)
{
  return shape == Shape::Hex ? cornersOf(shape).count + 1 : cornersOf(shape).count;
}

/// Returns u^2, which makes f 1 in the ideal cell.
inline double idealSquare(Shape shape)
{
  return shape == Shape::Pyramid ? 0.25
         : shape == Shape::Tet   ? 0.5
         : shape == Shape::Wedge ? 0.75
                                 : 1;
}

/// The mean edges of a hexahedron are these times its corners, over 4.
constexpr double CenterSigns[8][3] = { { -1, -1, -1 }, { 1, -1, -1 }, { 1, 1, -1 }, { -1, 1, -1 },
  { -1, -1, 1 }, { 1, -1, 1 }, { 1, 1, 1 }, { -1, 1, 1 } };

/// h and its derivatives by f.
struct Barrier
{
  SimdDouble4 h, first, second;

  MORPH_SIMD_INLINE Barrier(const SimdDouble4& f, double t)
  {
    const SimdDouble4 one = SimdDouble4{} + 1., y = t * f, rest = 1. - y;
    const auto isInside = rest > 0.;
    const SimdDouble4 r = 1. / select(isInside, rest, one), square = r * r;
    this->h = select(isInside, f * (1. - 0.5 * y) * square, one * Infinity);
    this->first = square * r;
    this->second = (3 * t) * (square * square);
  }
};

/// Computes f of samples with these bounds: 0 where they are left out, and infinite where a cell of
/// determinant `det` is inverted. `byD`: 1 / D.
MORPH_SIMD_INLINE void distortion(const StiffenedDistortion::Bounds& bounds, double ideal,
  double floor, const SimdDouble4& det, const SimdDouble4& byD, SimdDouble4& f)
{
  const SimdDouble4 signedBound = widened(bounds.bound), zero = {};
  const SimdDouble4 bound = select(signedBound < 0., -signedBound, signedBound);
  const SimdDouble4 part = select(bound < floor, bound / (zero + floor), zero + 1.);
  const SimdDouble4 ofValid =
    select(signedBound * det > 0., ideal * part * part * byD, zero + Infinity);
  f = select(bound == 0., zero, ofValid);
}

/// One corner of each cell of a batch, or the centers.
struct Sample
{
  SimdMatrix e, n; ///< edges, and the normals of pairs of them: the determinant's gradient
  SimdDouble4 q[3], bySquare[3], byDeterminant; ///< squares of lengths; reciprocals
  SimdDouble4 f;

  /// `corner`: null for the centers.
  MORPH_SIMD_INLINE Sample(const SimdVector (&x)[8], const int* corner,
    const StiffenedDistortion::Bounds& bounds, double ideal, double floor)
  {
    if (corner)
    {
      edgesOf(x, corner, this->e);
    }
    else
    {
      this->e = {};
      for (int a = 0; a < 8; ++a)
      {
        for (int k = 0; k < 3; ++k)
        {
          for (int i = 0; i < 3; ++i)
          {
            this->e[k][i] += 0.25 * CenterSigns[a][k] * x[a][i];
          }
        }
      }
    }
    for (int k = 0; k < 3; ++k)
    {
      dot(this->e[k], this->e[k], this->q[k]);
    }
    cofactor(this->e, this->n);
    SimdDouble4 det;
    dot(this->e[0], this->n[0], det);
    const SimdDouble4 product = this->q[0] * this->q[1] * this->q[2], both = det * product;
    const SimdDouble4 inverse = 1. / select(both == 0., both + 1., both), byProduct = inverse * det;
    this->byDeterminant = inverse * product;
    for (int k = 0; k < 3; ++k)
    {
      this->bySquare[k] = byProduct * this->q[(k + 1) % 3] * this->q[(k + 2) % 3];
    }
    distortion(
      bounds, ideal, floor, det, product * this->byDeterminant * this->byDeterminant, this->f);
  }
};

/// (c / l)^8 and (l / C)^8 of the edges of a corner, times their weight.
struct EdgeTerms
{
  SimdDouble4 ofLeast[3], ofMost[3];

  MORPH_SIMD_INLINE EdgeTerms(const Sample& sample, const StiffenedDistortion::Limits& limits)
  {
    for (int k = 0; k < 3; ++k)
    {
      SimdDouble4 least = widened(limits.least[k]) * sample.bySquare[k];
      SimdDouble4 most = widened(limits.byMost[k]) * sample.q[k];
      least *= least;
      most *= most;
      this->ofLeast[k] = 2. * least * least;
      this->ofMost[k] = 2. * most * most;
    }
  }
};

/// The distortions of tetrahedra, whose corners share a determinant.
struct TetSample
{
  static constexpr int Edges[6][2] = { { 0, 1 }, { 0, 2 }, { 0, 3 }, { 1, 2 }, { 1, 3 }, { 2, 3 } };
  static constexpr int EdgesOfCorner[4][3] = { { 0, 1, 2 }, { 0, 3, 4 }, { 1, 3, 5 }, { 2, 4, 5 } };

  SimdVector e[6];
  SimdMatrix n; ///< normals of pairs of the first corner's edges
  SimdDouble4 q[6], byDeterminant, f[4];

  MORPH_SIMD_INLINE TetSample(
    const SimdVector (&x)[8], const StiffenedDistortion::Bounds* bounds, double floor)
  {
    for (int k = 0; k < 6; ++k)
    {
      for (int i = 0; i < 3; ++i)
      {
        this->e[k][i] = x[Edges[k][1]][i] - x[Edges[k][0]][i];
      }
      dot(this->e[k], this->e[k], this->q[k]);
    }
    cross(this->e[1], this->e[2], this->n[0]);
    cross(this->e[2], this->e[0], this->n[1]);
    cross(this->e[0], this->e[1], this->n[2]);
    SimdDouble4 det;
    dot(this->e[0], this->n[0], det);
    this->byDeterminant = 1. / select(det == 0., det + 1., det);
    const SimdDouble4 square = this->byDeterminant * this->byDeterminant;
    for (int a = 0; a < 4; ++a)
    {
      const int* edge = EdgesOfCorner[a];
      distortion(bounds[a], idealSquare(Shape::Tet), floor, det,
        this->q[edge[0]] * this->q[edge[1]] * this->q[edge[2]] * square, this->f[a]);
    }
  }
};

MORPH_SIMD_INLINE void enlarge(SimdDouble4& largest, const SimdDouble4& f)
{
  largest = select(f > largest, f, largest);
}

/// The second derivatives of a sample's h by its cosines: M, and the rows of dc/dx by edges. The
/// cosines' own denominators are in M, so that there are no square roots. g[k][a] is that of the
/// cosine of the two edges other than k, by the edge a.
struct CosineModel
{
  SimdDouble4 M[3][3];
  SimdVector g[3][3];

  MORPH_SIMD_INLINE CosineModel(const Sample& s, double t)
  {
    const Barrier barrier(s.f, t);
    const SimdDouble4 byD = s.q[0] * s.q[1] * s.q[2] * s.byDeterminant * s.byDeterminant; // 1 / D
    const SimdDouble4 slope = -s.f * byD, first = barrier.first * slope;
    const SimdDouble4 second = barrier.second * slope * slope - 2. * first * byD;
    SimdDouble4 p[3], a[3];
    for (int k = 0; k < 3; ++k)
    {
      dot(s.e[(k + 1) % 3], s.e[(k + 2) % 3], p[k]);
    }
    const SimdDouble4 byAll = s.bySquare[0] * s.bySquare[1] * s.bySquare[2];
    for (int k = 0; k < 3; ++k)
    {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      const SimdDouble4 byBoth = s.bySquare[i] * s.bySquare[j];
      a[k] = 2. * (p[i] * p[j] * s.bySquare[k] - p[k]) * byBoth;
      this->M[k][k] = second * a[k] * a[k] - 2. * first * byBoth;
      const SimdDouble4 onI = p[k] * s.bySquare[i], onJ = p[k] * s.bySquare[j];
      for (int d = 0; d < 3; ++d)
      {
        this->g[k][i][d] = s.e[j][d] - onI * s.e[i][d];
        this->g[k][j][d] = s.e[i][d] - onJ * s.e[j][d];
      }
    }
    for (int k = 0; k < 3; ++k)
    {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      this->M[i][j] = this->M[j][i] = second * a[i] * a[j] + 2. * first * p[k] * byAll;
    }
  }

  /// The Gauss-Newton blocks of edges a <= b.
  MORPH_SIMD_INLINE void blocks(SimdMatrix (&block)[3][3]) const
  {
    for (int a = 0; a < 3; ++a)
    {
      for (int b = a; b < 3; ++b)
      {
        block[a][b] = {};
        for (int m = 1; m < 3; ++m)
        {
          const int k = (a + m) % 3, l = (b + 1) % 3, o = (b + 2) % 3;
          for (int j = 0; j < 3; ++j)
          {
            const SimdDouble4 turned =
              this->M[k][l] * this->g[l][b][j] + this->M[k][o] * this->g[o][b][j];
            for (int i = 0; i < 3; ++i)
            {
              block[a][b][j][i] += this->g[k][a][i] * turned;
            }
          }
        }
      }
    }
  }
};

/// Adds the blocks of the mean edges to the pairs of a hexahedron's corners.
MORPH_SIMD_INLINE void addByCenter(const SimdMatrix (&block)[3][3], SimdMatrix* sum)
{
  for (int a = 0; a < 8; ++a)
  {
    SimdMatrix byEdge[3] = {};
    for (int k = 0; k < 3; ++k)
    {
      for (int l = 0; l < 3; ++l)
      {
        const SimdDouble4 sign = SimdDouble4{} + CenterSigns[a][k] / 16;
        addBlock(block[std::min(k, l)][std::max(k, l)], k > l, sign, byEdge[l]);
      }
    }
    for (int b = a; b < 8; ++b)
    {
      for (int l = 0; l < 3; ++l)
      {
        addBlock(byEdge[l], false, SimdDouble4{} + CenterSigns[b][l], sum[blockOf(a, b, 8)]);
      }
    }
  }
}

/// Adds the forces on edges from a tetrahedron's first corner.
MORPH_SIMD_INLINE void addForces(const SimdMatrix& force, const int* corner, SimdVector (&to)[8])
{
  for (int k = 0; k < 3; ++k)
  {
    for (int i = 0; i < 3; ++i)
    {
      to[corner[k + 1]][i] += force[k][i];
      to[corner[0]][i] -= force[k][i];
    }
  }
}
}
}
