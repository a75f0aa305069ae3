// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/Certificate.h"

#include "Geometry/ExactPredicates.h"
#include "Mesh/CellShape.h"
#include "Mesh/Polyhedra.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Mesh/StandingCells.h"
#include "Quality/CellMap.h"
#include "Quality/PolyhedronQuality.h"
#include "Support/ReproducibleSum.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace morph
{
namespace
{
using Vector = Eigen::Vector3d;
using Part = BernsteinHalving::Part;

constexpr int MostHalvings = 36, MostHalvingsNextToZero = 9;
constexpr int MostParts = 2048;
constexpr int PointsAlong = 8; ///< where to look for an inverted point: multiples of 1/8

/// Returns a power of two that brings the extent of the nodes along an axis close to 2^299, and no
/// coordinate above 2^340.
double scaleOf(const Vector* nodes, int count, int axis)
{
  double low = nodes[0][axis], high = low;
  for (int i = 1; i < count; ++i)
  {
    low = std::min(low, nodes[i][axis]);
    high = std::max(high, nodes[i][axis]);
  }
  const double largest = std::max(std::abs(low), std::abs(high));
  if (largest == 0)
  {
    return 1;
  }
  const double extent = high - low;
  int power = std::min(340 - std::ilogb(largest), 1023); // the largest power that is a double
  if (extent > 0)
  {
    power = std::min(299 - std::ilogb(extent), power);
  }
  return std::ldexp(1., power);
}

/// A cell with each coordinate scaled on its own: the determinant keeps its sign, and a flat cell's
/// rounding errors become small compared with it.
struct Cell
{
  const CellMap& map;
  const Vector* nodes;
  Vector x[CellMap::MostNodes];
  Vector scale; ///< x = scale nodes
  CellMap::Derivatives derivatives;
  bool isFinite;

  Cell(const CellMap& of, const Vector* from)
    : map(of)
    , nodes(from)
  {
    const int count = of.numberOfNodes();
    this->isFinite =
      std::all_of(nodes, nodes + count, [](const Vector& v) { return v.allFinite(); });
    if (this->isFinite)
    {
      for (int j = 0; j < 3; ++j)
      {
        this->scale[j] = scaleOf(nodes, count, j);
      }
      std::transform(nodes, nodes + count, this->x,
        [this](const Vector& v) -> Vector { return v.cwiseProduct(this->scale); });
      this->derivatives = of.derivatives(this->x);
    }
  }
};

/// Finds the middle of an edge with coinciding ends. The derivative along the edge, of degree two,
/// is exactly 0 there.
bool hasCollapsedEdge(const CellShape& shape, const Cell& cell, double (&middle)[3])
{
  for (int f = 0; f < shape.numberOfFaces; ++f)
  {
    const FaceShape& face = shape.faces[f];
    for (int k = 0; k < face.size; ++k)
    {
      const int a = face.corner[k], b = face.corner[(k + 1) % face.size];
      if (cell.x[a] == cell.x[b])
      {
        for (int j = 0; j < 3; ++j)
        {
          middle[j] = (cell.map.node(a)[j] + cell.map.node(b)[j]) / 2;
        }
        return true;
      }
    }
  }
  return false;
}

/// Looks for an inverted point of a cell that the Bernstein form leaves undecided. The rounding
/// error at one point is that of its own derivatives, which can be far smaller than the bound for
/// the whole cell.
bool findInvertedPoint(const CellShape& shape, const Cell& cell, double (&at)[3])
{
  const CellMap::Magnitudes magnitudes = cell.map.magnitudes(cell.x);
  for (int i = 0; i < cell.map.numberOfNodes(); ++i)
  {
    std::copy(cell.map.node(i), cell.map.node(i) + 3, at);
    if (cell.map.isNegative(cell.derivatives, magnitudes, at))
    {
      return true;
    }
  }
  const bool isTriangle = shape.shape == Shape::Tet || shape.shape == Shape::Wedge;
  for (int i = 0; i <= PointsAlong; ++i)
  {
    for (int j = 0; j <= PointsAlong - (isTriangle ? i : 0); ++j)
    {
      const int most = PointsAlong - (shape.shape == Shape::Tet ? i + j : 0);
      for (int k = 0; k <= most; ++k)
      {
        at[0] = i / double(PointsAlong);
        at[1] = j / double(PointsAlong);
        at[2] = k / double(PointsAlong);
        if (cell.map.isNegative(cell.derivatives, magnitudes, at))
        {
          return true;
        }
      }
    }
  }
  return false;
}

/// Whether all coefficients are certainly positive. Sets those of `whole` and their error.
bool isPositive(const Cell& cell, Part& whole, double& error)
{
  error = cell.map.determinant(cell.derivatives, MostHalvings, whole.c);
  return cell.map.halving().minimum(whole) > error;
}

JacobianProof proveByHalving(const CellShape& shape, const Cell& cell)
{
  JacobianProof proof;
  const BernsteinHalving& halving = cell.map.halving();
  Part whole = halving.whole();
  double error;
  if (isPositive(cell, whole, error))
  {
    proof.certificate = Certificate::Certified;
    return proof;
  }
  if (hasCollapsedEdge(shape, cell, proof.at))
  {
    proof.certificate = Certificate::Inverted;
    return proof;
  }
  bool isOpen = false;
  int examined = 0;
  std::vector<Part> stack(1, whole);
  stack.reserve(MostHalvings + 2);
  while (!stack.empty())
  {
    Part& part = stack.back();
    ++examined;
    double at[3];
    const double corner = halving.minimumCorner(part, at);
    if (corner < -error)
    {
      proof.certificate = Certificate::Inverted;
      std::copy(at, at + 3, proof.at);
      return proof;
    }
    if (halving.minimum(part) > error)
    {
      stack.pop_back();
      continue;
    }
    // A part with a corner next to zero cannot be certified, but may contain an inverted point.
    const bool isNextToZero = corner <= error;
    isOpen = isOpen || isNextToZero;
    if (part.halvings >= (isNextToZero ? MostHalvingsNextToZero : MostHalvings))
    {
      isOpen = true;
      stack.pop_back();
      continue;
    }
    if (examined + static_cast<int>(stack.size()) >= MostParts)
    {
      return proof;
    }
    Part high;
    halving.halve(part, part, high);
    // Continues with the more doubtful half, which finds an inverted cell sooner.
    if (halving.minimum(part) < halving.minimum(high))
    {
      std::swap(part, high);
    }
    stack.push_back(high);
  }
  proof.certificate = isOpen ? Certificate::Undecided : Certificate::Certified;
  return proof;
}

JacobianProof prove(const CellShape& shape, const Cell& cell)
{
  JacobianProof proof = proveByHalving(shape, cell);
  if (proof.certificate == Certificate::Undecided && findInvertedPoint(shape, cell, proof.at))
  {
    proof.certificate = Certificate::Inverted;
  }
  return proof;
}

double normalization(Shape shape)
{
  return shape == Shape::Hex ? 1 : shape == Shape::Wedge ? 2 / std::sqrt(3.) : std::sqrt(2.);
}

double normalizedDeterminant(const Cell& cell, const double (&at)[3])
{
  // Gives the coordinates their ratios back.
  const double common = exactScale(cell.nodes, cell.map.numberOfNodes());
  const Vector unscale = (common / cell.scale.array()).matrix();
  Eigen::Matrix3d jacobian = unscale.asDiagonal() * cell.map.jacobian(cell.derivatives, at);
  for (int j = 0; j < 3; ++j)
  {
    const double length = jacobian.col(j).norm();
    jacobian.col(j) /= length > 0 ? length : 1;
  }
  return jacobian.determinant();
}

double minimumAtNodes(const Cell& cell)
{
  double minimum = 1;
  for (int i = 0; i < cell.map.numberOfNodes(); ++i)
  {
    minimum = std::min(minimum, normalizedDeterminant(cell, cell.map.node(i)));
  }
  return minimum;
}
}

JacobianProof proveJacobian(std::uint8_t type, const Vector* x)
{
  const Cell cell(*CellMap::find(type), x);
  return cell.isFinite ? prove(*cellShape(type), cell) : JacobianProof();
}

double quadraticScaledJacobian(std::uint8_t type, const Vector* x, double ofCorners)
{
  const Cell cell(*CellMap::find(type), x);
  if (!cell.isFinite)
  {
    return ofCorners;
  }
  const CellShape& shape = *cellShape(type);
  const JacobianProof proof = prove(shape, cell);
  if (proof.certificate == Certificate::Undecided ||
      (proof.certificate == Certificate::Certified && ofCorners > 0))
  {
    return ofCorners;
  }
  const double atNodes = normalization(shape.shape) * minimumAtNodes(cell);
  if (proof.certificate == Certificate::Certified)
  {
    return std::min(atNodes, 1.);
  }
  const double found = normalization(shape.shape) * normalizedDeterminant(cell, proof.at);
  return std::min({ 0., ofCorners, atNodes, found });
}

bool isStraightSided(std::uint8_t type, const Vector* x)
{
  const CellShape& shape = *cellShape(type);
  for (int i = shape.numberOfCorners; i < shape.numberOfNodes; ++i)
  {
    double N[8];
    shapeFunctions(shape.shape, shape.extraNodes[i - shape.numberOfCorners], N, nullptr);
    for (int j = 0; j < 3; ++j)
    {
      // The corners that contribute have equal shares: 1/2, 1/4 or 1/8.
      double sum = 0, share = 1;
      for (int a = 0; a < shape.numberOfCorners; ++a)
      {
        if (N[a] == 0)
        {
          continue;
        }
        share = N[a];
        const double before = sum, corner = x[a][j];
        sum += corner;
        // The mean is exact only where no sum was rounded.
        if (sum - before != corner || sum - corner != before)
        {
          return false;
        }
      }
      if (sum * share != x[i][j])
      {
        return false;
      }
    }
  }
  return true;
}

namespace
{
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

Certificate certifyShape(Shape shape, const Vector* x)
{
  const int corners = numberOfCorners(shape);
  if (corners == 0 || !std::all_of(x, x + corners, [](const Vector& v) { return v.allFinite(); }))
  {
    return Certificate::Undecided;
  }
  if (shape == Shape::Tet || shape == Shape::Pyramid)
  {
    return areCornersPositive(shape, x) ? Certificate::Certified : Certificate::Inverted;
  }
  // The determinants at the corners are among the coefficients: where all of these are positive,
  // no exact sign is needed.
  const std::uint8_t type = shape == Shape::Hex ? Hexahedron : Wedge;
  const Cell cell(*CellMap::find(type), x);
  Part whole;
  double error;
  return isPositive(cell, whole, error)  ? Certificate::Certified
         : !areCornersPositive(shape, x) ? Certificate::Inverted
                                         : prove(*cellShape(type), cell).certificate;
}

/// `x`: all nodes of a quadratic cell, the corners of another cell.
Certificate certifyNodes(std::uint8_t type, const CellShape& shape, const Vector* x)
{
  return isQuadraticVolume(shape) && !isStraightSided(type, x) ? proveJacobian(type, x).certificate
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

std::vector<Index> unmappedCells(const Mesh& mesh)
{
  std::vector<Index> cells;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const CellShape* shape = volumeShape(mesh, c);
    if (shape && (!shape->isMapped || (hasFaces(mesh, c) && !isPolyhedron(mesh, c))))
    {
      cells.push_back(c);
    }
  }
  return cells;
}

CertificateReport certify(const Mesh& mesh, const ConstPoints& points,
  const std::vector<std::int8_t>& orientation, const std::vector<std::uint8_t>& skip,
  Monitor& monitor)
{
  if (mesh.layer.nodes > 0)
  {
    const Mesh cells = standing(mesh, points);
    return certify(cells, cells.points, orientation, skip, monitor);
  }
  monitor.check();
  const Index cells = mesh.numberOfCells();
  CertificateReport report;
  report.cells.assign(cells, Certificate::Undecided);
  const auto examine = [&](Index c) -> Counts
  {
    const CellShape* shape = cellShape(mesh, c);
    if ((shape && shape->dimension < 3) || (!skip.empty() && skip[c]))
    {
      return {};
    }
    if (shape && isPolyhedron(mesh, c))
    {
      thread_local PolyhedronPlaces measure; // for its memory
      report.cells[c] = measure.certify(mesh, c, points, orientation.empty() ? 1 : orientation[c]);
    }
    else if (shape && shape->isMapped && !hasFaces(mesh, c))
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
