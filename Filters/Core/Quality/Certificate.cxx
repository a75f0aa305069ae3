// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/Certificate.h"

#include "Geometry/OrientationPredicate.h"
#include "Mesh/CellShape.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Quality/BernsteinDomain.h"
#include "Quality/BernsteinHex.h"
#include "Quality/PolyhedronQuality.h"
#include "Quality/QuadraticJacobian.h"
#include "Support/ReproducibleSum.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace morph
{
namespace
{
using Vector = Eigen::Vector3d;

bool areCornersPositive(Shape shape, const Vector* x)
{
  const WeightedTet* tets = simplicialDecomposition(shape).tets;
  return std::all_of(tets, tets + cornerTetrahedra(shape),
    [x](const WeightedTet& tet)
    {
      const int* c = tet.corner;
      return orientationSign(x[c[0]], x[c[1]], x[c[2]], x[c[3]]) > 0;
    });
}

/// Certifies b0 (1 - t)^2 + 2 b1 t (1 - t) + b2 t^2 on [0, 1]; coefficients have errors up to
/// `error`.
Certificate certifyQuadratic(double b0, double b1, double b2, double error)
{
  constexpr double Rounding = 4 * std::numeric_limits<double>::epsilon();
  // Lower coefficients give a lower polynomial, higher ones a higher polynomial.
  const double l0 = b0 - error, l1 = b1 - error, l2 = b2 - error;
  if (l0 > 0 && l2 > 0 && l1 > -(1 - Rounding) * std::sqrt(l0) * std::sqrt(l2))
  {
    return Certificate::Certified;
  }
  const double h0 = b0 + error, h1 = b1 + error, h2 = b2 + error;
  const bool isNegative = h0 < 0 || h2 < 0 || h1 < -(1 + Rounding) * std::sqrt(h0) * std::sqrt(h2);
  return isNegative ? Certificate::Inverted : Certificate::Undecided;
}

Certificate certifyWedge(const Vector* x)
{
  const Vector r[2] = { x[1] - x[0], x[4] - x[3] }, s[2] = { x[2] - x[0], x[5] - x[3] };
  const Vector areas[3] = { r[0].cross(s[0]), (r[0].cross(s[1]) + r[1].cross(s[0])) / 2,
    r[1].cross(s[1]) };
  const auto longest = [](const Vector& a, const Vector& b)
  { return std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff()); };
  Certificate result = Certificate::Certified;
  for (int edge = 0; edge < 3; ++edge)
  {
    const Vector t = x[edge + 3] - x[edge];
    const double error = coefficientError(longest(r[0], r[1]), longest(s[0], s[1]), longest(t, t));
    const Certificate found =
      certifyQuadratic(areas[0].dot(t), areas[1].dot(t), areas[2].dot(t), error);
    result = std::min(result, found);
  }
  return result;
}

Certificate certifyShape(Shape shape, Vector* x)
{
  const int corners = numberOfCorners(shape);
  if (corners == 0 || !std::all_of(x, x + corners, [](const Vector& v) { return v.allFinite(); }))
  {
    return Certificate::Undecided;
  }
  if (!areCornersPositive(shape, x))
  {
    return Certificate::Inverted;
  }
  const double scale = exactScale(x, corners);
  std::for_each(x, x + corners, [scale](Vector& v) { v *= scale; });
  return shape == Shape::Hex     ? certifyTrilinear(x)
         : shape == Shape::Wedge ? certifyWedge(x)
                                 : Certificate::Certified;
}

/// `x`: all nodes of a quadratic cell, the corners of another cell.
Certificate certifyNodes(std::uint8_t type, const CellShape& shape, Vector* x)
{
  return isQuadraticVolume(shape) && !isStraightSided(type, x) ? proveQuadratic(type, x).certificate
                                                               : certifyShape(shape.shape, x);
}

struct Counts
{
  Index certified = 0, inverted = 0, undecided = 0;

  Counts& operator+=(const Counts& other)
  {
    this->certified += other.certified;
    this->inverted += other.inverted;
    this->undecided += other.undecided;
    return *this;
  }
};
}

Certificate certifyCell(std::uint8_t type, const double (*nodes)[3])
{
  const CellShape* shape = cellShape(type);
  if (!shape || numberOfCorners(shape->shape) == 0)
  {
    return Certificate::Undecided;
  }
  Vector x[MostNodesOfVolume];
  for (int k = 0; k < shape->numberOfNodes; ++k)
  {
    x[k] = Vector(nodes[k][0], nodes[k][1], nodes[k][2]);
  }
  return certifyNodes(type, *shape, x);
}

CertificateReport certify(const Mesh& mesh, const ConstPoints& points,
  const std::vector<std::int8_t>& orientation, const std::vector<std::uint8_t>& skip,
  Monitor& monitor)
{
  monitor.check();
  const Index cells = mesh.numberOfCells();
  CertificateReport report;
  report.cells.assign(cells, Certificate::Undecided);
  const auto examine = [&](Index c) -> Counts
  {
    const CellShape* shape = cellShape(mesh.types[c]);
    if ((shape && shape->dimension < 3) || (!skip.empty() && skip[c]))
    {
      return {};
    }
    if (shape && shape->shape == Shape::Polyhedron)
    {
      thread_local PolyhedronMeasure measure; // for its memory
      report.cells[c] = measure.certify(mesh, c, points, orientation.empty() ? 1 : orientation[c]);
    }
    else if (shape)
    {
      Vector x[MostNodesOfVolume];
      for (int k = 0; k < shape->numberOfNodes; ++k)
      {
        const int place = k < shape->numberOfCorners ? shape->cornerNode[k] : k;
        x[k] = points.row(mesh.cell(c)[place]).transpose();
        // Examines a cell in mirrored order as its mirror image.
        x[k].z() *= orientation.empty() ? 1 : orientation[c];
      }
      report.cells[c] = certifyNodes(mesh.types[c], *shape, x);
    }
    const Certificate found = report.cells[c];
    return { found == Certificate::Certified, found == Certificate::Inverted,
      found == Certificate::Undecided };
  };
  const Counts counts = reproducibleSum(cells, monitor, Counts(), examine);
  monitor.check();
  report.certified = counts.certified;
  report.inverted = counts.inverted;
  report.undecided = counts.undecided;
  return report;
}
}
