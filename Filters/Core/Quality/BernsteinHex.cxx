// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/BernsteinHex.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace morph
{
namespace
{
using Vector = Eigen::Vector3d;

constexpr int Stride[3] = { 9, 3, 1 };
constexpr int MostHalvings = 36;
constexpr int MostBoxes = 2048;

/// A part of the cell with the determinant's coefficients, c(i, j, k) at 9 i + 3 j + k.
struct Box
{
  std::array<double, 27> c;
  int halvings = 0;

  double least() const { return *std::min_element(this->c.begin(), this->c.end()); }
  /// Returns the minimum determinant at the box's corners, which are coefficients.
  double minimumCorner() const
  {
    double least = this->c[0];
    for (int corner = 1; corner < 8; ++corner)
    {
      least = std::min(
        least, this->c[(corner & 1 ? 18 : 0) + (corner & 2 ? 6 : 0) + (corner & 4 ? 2 : 0)]);
    }
    return least;
  }
};

/// Returns the coordinate with the coefficients farthest from linear, where halving helps most.
int mostCurved(const Box& box)
{
  int best = 0;
  double most = -1;
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::ptrdiff_t step = Stride[axis], u = Stride[(axis + 1) % 3],
                         v = Stride[(axis + 2) % 3];
    double curvature = 0;
    for (int i = 0; i < 3; ++i)
    {
      for (int j = 0; j < 3; ++j)
      {
        const double* c = box.c.data() + i * u + j * v;
        curvature = std::max(curvature, std::abs(c[0] - 2 * c[step] + c[2 * step]));
      }
    }
    if (curvature > most)
    {
      most = curvature;
      best = axis;
    }
  }
  return best;
}

void halve(const Box& box, Box& low, Box& high)
{
  const int axis = mostCurved(box), step = Stride[axis];
  const int u = Stride[(axis + 1) % 3], v = Stride[(axis + 2) % 3];
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      const int at = i * u + j * v;
      const double c0 = box.c[at], c1 = box.c[at + step], c2 = box.c[at + 2 * step];
      const double left = (c0 + c1) / 2, right = (c1 + c2) / 2, middle = (left + right) / 2;
      low.c[at] = c0;
      low.c[at + step] = left;
      low.c[at + 2 * step] = high.c[at] = middle;
      high.c[at + step] = right;
      high.c[at + 2 * step] = c2;
    }
  }
  low.halvings = high.halvings = box.halvings + 1;
}

/// Computes the coefficients on the whole cell, and returns a bound of their error.
double determinant(const Vector* x, Box& box)
{
  constexpr int Corner[2][2][2] = { { { 0, 4 }, { 3, 7 } }, { { 1, 5 }, { 2, 6 } } };
  // The derivatives are bilinear: their coefficients are the edges along each coordinate.
  Vector alongR[2][2], alongS[2][2], alongT[2][2];
  double longest[3] = { 0, 0, 0 };
  for (int i = 0; i < 2; ++i)
  {
    for (int j = 0; j < 2; ++j)
    {
      alongR[i][j] = x[Corner[1][i][j]] - x[Corner[0][i][j]];
      alongS[i][j] = x[Corner[i][1][j]] - x[Corner[i][0][j]];
      alongT[i][j] = x[Corner[i][j][1]] - x[Corner[i][j][0]];
      longest[0] = std::max(longest[0], alongR[i][j].cwiseAbs().maxCoeff());
      longest[1] = std::max(longest[1], alongS[i][j].cwiseAbs().maxCoeff());
      longest[2] = std::max(longest[2], alongT[i][j].cwiseAbs().maxCoeff());
    }
  }
  box.c.fill(0);
  // A product of two linear factors has the mean of the two mixed products as middle coefficient.
  constexpr double Weight[3] = { 1, .5, 1 };
  for (int bits = 0; bits < 16; ++bits)
  {
    const int rj = bits & 1, rk = (bits >> 1) & 1, si = (bits >> 2) & 1, sk = (bits >> 3) & 1;
    const Vector area = alongR[rj][rk].cross(alongS[si][sk]);
    for (int ti = 0; ti < 2; ++ti)
    {
      for (int tj = 0; tj < 2; ++tj)
      {
        const int i = si + ti, j = rj + tj, k = rk + sk;
        box.c[9 * i + 3 * j + k] += Weight[i] * Weight[j] * Weight[k] * area.dot(alongT[ti][tj]);
      }
    }
  }
  return coefficientError(longest[0], longest[1], longest[2]);
}
}

double coefficientError(double longestR, double longestS, double longestT)
{
  // Let u = epsilon / 2, and P the product of the longest components. A determinant and all its six
  // products are at most 6 P. A determinant takes 8 roundings, the mean of eight 8 more: at most 16
  // u * 6 P = 96 u P, to first order. A halving takes two, each of at most u * 6 P, and averages
  // earlier errors. 36 * 12 + 96 = 528; the rest covers terms of higher order. The last term covers
  // coordinates that underflow in the scaling.
  return 300 * std::numeric_limits<double>::epsilon() * longestR * longestS * longestT +
         std::ldexp(1., -400);
}

Certificate certifyTrilinear(const Vector* x)
{
  Box whole;
  const double error = determinant(x, whole);
  bool isOpen = false;
  int examined = 0;
  std::vector<Box> stack(1, whole);
  stack.reserve(MostHalvings + 1);
  while (!stack.empty())
  {
    const Box box = stack.back();
    stack.pop_back();
    ++examined;
    const double corner = box.minimumCorner();
    if (corner < -error)
    {
      return Certificate::Inverted;
    }
    if (box.least() > error)
    {
      continue;
    }
    // Parts of a box with a corner next to zero cannot be certified either.
    if (corner <= error || box.halvings == MostHalvings)
    {
      isOpen = true;
      continue;
    }
    if (examined + static_cast<int>(stack.size()) >= MostBoxes)
    {
      return Certificate::Undecided;
    }
    Box low, high;
    halve(box, low, high);
    // Continues with the more doubtful half, which finds an inverted cell sooner.
    const bool lowIsWorse = low.least() < high.least();
    stack.push_back(lowIsWorse ? high : low);
    stack.push_back(lowIsWorse ? low : high);
  }
  return isOpen ? Certificate::Undecided : Certificate::Certified;
}
}
