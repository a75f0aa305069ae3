// SPDX-License-Identifier: BSD-3-Clause
#include "Energies/TargetMatrices.h"

#include "Mesh/SimplicialDecomposition.h"
#include "Quality/ScaledJacobian.h"
#include "Support/Parallel.h"
#include "Support/ReproducibleSum.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>

namespace morph
{
namespace
{
constexpr Index Grain = 1024;
constexpr double MostStretch = 20;
// minimum scaled Jacobian of an undeformed cell that is a target
constexpr double LeastQuality = 1e-3;
// minimum volume of a tetrahedron, relative to the mean in its cell
constexpr double LeastVolume = 1e-3; // of the mean

using Lengths = Eigen::Vector3d; // along the three axes of a cell

/// The edges of a shape along each axis, in the direction of the axis.
struct Axes
{
  int count[3];
  int edge[3][4][2];
};

const Axes* axesOf(Shape shape)
{
  static const Axes hex = { { 4, 4, 4 },
    { { { 0, 1 }, { 3, 2 }, { 4, 5 }, { 7, 6 } }, { { 0, 3 }, { 1, 2 }, { 4, 7 }, { 5, 6 } },
      { { 0, 4 }, { 1, 5 }, { 2, 6 }, { 3, 7 } } } };
  // The triangle has two equal axes; its third edge counts for both.
  static const Axes wedge = { { 3, 3, 3 },
    { { { 0, 1 }, { 3, 4 }, { 1, 2 }, { 0, 0 } }, { { 0, 2 }, { 3, 5 }, { 4, 5 }, { 0, 0 } },
      { { 0, 3 }, { 1, 4 }, { 2, 5 }, { 0, 0 } } } };
  static const Axes pyramid = { { 2, 2, 4 },
    { { { 0, 1 }, { 3, 2 }, { 0, 0 }, { 0, 0 } }, { { 0, 3 }, { 1, 2 }, { 0, 0 }, { 0, 0 } },
      { { 0, 4 }, { 1, 4 }, { 2, 4 }, { 3, 4 } } } };
  static const Axes tet = { { 2, 2, 2 },
    { { { 0, 1 }, { 2, 3 }, { 0, 0 }, { 0, 0 } }, { { 0, 2 }, { 1, 3 }, { 0, 0 }, { 0, 0 } },
      { { 0, 3 }, { 1, 2 }, { 0, 0 }, { 0, 0 } } } };
  switch (shape)
  {
    case Shape::Hex:
      return &hex;
    case Shape::Wedge:
      return &wedge;
    case Shape::Pyramid:
      return &pyramid;
    case Shape::Tet:
      return &tet;
    default:
      return nullptr;
  }
}

/// Returns mean edge lengths along the axes. A wedge's triangle axes are equal, and so are all of a
/// tetrahedron's.
Lengths lengths(Shape shape, const CellCorners& x)
{
  const Axes& axes = *axesOf(shape);
  Lengths result = Lengths::Zero();
  for (int d = 0; d < 3; ++d)
  {
    for (int e = 0; e < axes.count[d]; ++e)
    {
      result[d] += (x.col(axes.edge[d][e][1]) - x.col(axes.edge[d][e][0])).norm() / axes.count[d];
    }
  }
  if (shape == Shape::Wedge)
  {
    result[0] = result[1] = (result[0] + result[1]) / 2;
  }
  else if (shape == Shape::Tet)
  {
    result.setConstant(result.mean());
  }
  return result;
}

/// Returns mean edge vectors along the axes. A pyramid's third axis connects the middle of its base
/// to its apex.
Eigen::Matrix3d frame(Shape shape, const CellCorners& x)
{
  const Axes& axes = *axesOf(shape);
  Eigen::Matrix3d J = Eigen::Matrix3d::Zero();
  for (int d = 0; d < 3; ++d)
  {
    // A wedge's third triangle edges are not along either axis.
    const int n = shape == Shape::Wedge && d < 2 ? 2 : axes.count[d];
    for (int e = 0; e < n; ++e)
    {
      J.col(d) += (x.col(axes.edge[d][e][1]) - x.col(axes.edge[d][e][0])) / n;
    }
  }
  return J;
}

CellCorners cornersOf(const Mesh& mesh, Index cell, const Points& points)
{
  const CellShape& shape = *cellShape(mesh, cell);
  CellCorners x;
  copyCorners(mesh, cell, shape, points, x.data());
  return x;
}

Eigen::Matrix3d edges(const WeightedTet& tet, const CellCorners& x)
{
  Eigen::Matrix3d D;
  for (int k = 0; k < 3; ++k)
  {
    D.col(k) = x.col(tet.corner[k + 1]) - x.col(tet.corner[0]);
  }
  return D;
}

SimplicialDecomposition partsOf(const Mesh& mesh, Index cell)
{
  return simplicialDecomposition(cellShape(mesh, cell)->shape);
}

std::array<Index, 4> nodesOf(const Mesh& mesh, Index cell, int tetrahedron)
{
  const CellShape& shape = *cellShape(mesh, cell);
  return nodesAt(mesh, cell, shape, simplicialDecomposition(shape.shape).tets[tetrahedron].corner);
}

/// Returns which undeformed cells may serve as targets.
std::vector<char> validCells(
  const Mesh& rest, const std::vector<std::int8_t>& orientation, Monitor& monitor)
{
  const Quality quality = measureCorners(rest, rest.points, orientation, {}, monitor);
  std::vector<char> valid(rest.numberOfCells());
  for (Index c = 0; c < rest.numberOfCells(); ++c)
  {
    valid[c] = quality.scaledJacobian[c] > LeastQuality;
  }
  return valid;
}

double meanVolume(const SimplicialDecomposition& parts, const CellCorners& x)
{
  double sum = 0;
  for (int t = 0; t < parts.count; ++t)
  {
    sum += std::abs(edges(parts.tets[t], x).determinant()) / 6;
  }
  return sum / parts.count;
}

/// Returns the mean edge lengths of the valid cells around a cell that is not valid, or its own.
Lengths lengthsAround(
  const Mesh& rest, const Adjacency& around, const std::vector<char>& valid, Index cell)
{
  const CellShape& shape = *cellShape(rest, cell);
  double sum = 0;
  Index count = 0;
  for (int a = 0; a < shape.numberOfCorners; ++a)
  {
    const Index node = rest.cell(cell)[shape.cornerNode[a]];
    for (const Index* next = around.begin(node); next != around.end(node); ++next)
    {
      if (valid[*next])
      {
        sum +=
          lengths(cellShape(rest.types[*next])->shape, cornersOf(rest, *next, rest.points)).mean();
        ++count;
      }
    }
  }
  return count > 0 ? Lengths(Lengths::Constant(sum / static_cast<double>(count)))
                   : lengths(shape.shape, cornersOf(rest, cell, rest.points));
}

CellCorners targetOf(Shape shape, const CellCorners& rest, const CellCorners& guide, double sign,
  TargetConstruction target)
{
  if (target == TargetConstruction::IdealSkew)
  {
    CellCorners x = idealShape(shape, lengths(shape, guide));
    x.row(0) *= sign;
    return x;
  }
  if (target == TargetConstruction::Initial || shape == Shape::Tet)
  {
    return rest;
  }
  const Lengths ratio = lengths(shape, guide).cwiseQuotient(lengths(shape, rest));
  const Eigen::Matrix3d J = frame(shape, rest);
  return J * ratio.cwiseMax(1 / MostStretch).cwiseMin(MostStretch).asDiagonal() * J.inverse() *
         rest;
}
}

CellCorners idealShape(Shape shape, const Eigen::Vector3d& length)
{
  const double a = length[0], b = length[1], c = length[2];
  CellCorners x = CellCorners::Zero();
  switch (shape)
  {
    case Shape::Hex:
      x << 0, a, a, 0, 0, a, a, 0, //
        0, 0, b, b, 0, 0, b, b,    //
        0, 0, 0, 0, c, c, c, c;
      break;
    case Shape::Wedge:
      // Counter-clockwise from above: the triangle 0, 1, 2 is then the lower one of a positive
      // decomposition.
      x.leftCols<6>() << 0, a, a / 2, 0, a, a / 2,          //
        0, 0, a * std::sqrt(.75), 0, 0, a * std::sqrt(.75), //
        0, 0, 0, c, c, c;
      break;
    case Shape::Pyramid:
    {
      const double height2 = c * c - (a * a + b * b) / 4;
      x.leftCols<5>() << 0, a, a, 0, a / 2, //
        0, 0, b, b, b / 2,                  //
        0, 0, 0, 0, height2 > c * c / 16 ? std::sqrt(height2) : c / 4;
      break;
    }
    default:
      x.leftCols<4>() << 0, a, a / 2, a / 2,              //
        0, 0, a * std::sqrt(.75), a * std::sqrt(1. / 12), //
        0, 0, 0, a * std::sqrt(2. / 3);
  }
  return x;
}

Eigen::Matrix3d TargetMatrices::edges(Index cell, const WeightedTet& tetrahedron) const
{
  const Eigen::Map<const Eigen::Matrix3Xd> x(
    this->corners.data() + 3 * this->start[cell], 3, this->start[cell + 1] - this->start[cell]);
  Eigen::Matrix3d D;
  for (int k = 0; k < 3; ++k)
  {
    D.col(k) = x.col(tetrahedron.corner[k + 1]) - x.col(tetrahedron.corner[0]);
  }
  return D;
}

void TargetMatrices::open(const Mesh& mesh)
{
  this->start.assign(1, 0);
  this->start.reserve(mesh.numberOfCells() + 1);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    this->start.push_back(this->start.back() + numberOfCorners(cellShape(mesh, c)->shape));
  }
  this->corners.assign(3 * this->start.back(), 0);
  this->factor.assign(mesh.numberOfCells(), 0);
  this->included.assign(mesh.numberOfCells(), 0);
}

TargetMatrices targetMatrices(const Mesh& rest, const std::vector<std::int8_t>& orientation,
  const Points& guide, TargetConstruction target, CellWeights weights, Monitor& monitor,
  const Communicator& communicator)
{
  const Index cells = rest.numberOfCells();
  TargetMatrices result;
  result.open(rest);
  const bool tetrahedraAlone = communicator.all(std::all_of(rest.types.begin(), rest.types.end(),
    [](std::uint8_t type)
    {
      const Shape shape = cellShape(type)->shape;
      return shape == Shape::Tet || numberOfCorners(shape) == 0;
    }));
  result.theta = tetrahedraAlone ? 0.5 : 0.1;
  const std::vector<char> valid = validCells(rest, orientation, monitor);
  const bool allValid = [&]
  {
    for (Index c = 0; c < cells; ++c)
    {
      if (!valid[c] && hasCorners(rest, c))
      {
        return false;
      }
    }
    return true;
  }();
  const Adjacency around = allValid ? Adjacency() : nodeToCells(rest);

  parallel(cells, Grain, monitor,
    [&](Index c)
    {
      if (!hasCorners(rest, c))
      {
        return;
      }
      const Shape shape = cellShape(rest, c)->shape;
      const double sign = orientation[c];
      CellCorners x;
      const CellCorners at = cornersOf(rest, c, guide);
      // Ideal targets take nothing from the undeformed cell.
      if (valid[c] ||
          (target == TargetConstruction::IdealSkew && (lengths(shape, at).array() > 0).all()))
      {
        x = targetOf(shape, cornersOf(rest, c, rest.points), at, sign, target);
      }
      else
      {
        x = idealShape(shape, lengthsAround(rest, around, valid, c));
        x.row(0) *= sign;
      }
      const SimplicialDecomposition parts = simplicialDecomposition(shape);
      const double mean = meanVolume(parts, x), least = LeastVolume * mean;
      const double unit = weights == CellWeights::Volume ? 1 : mean;
      result.factor[c] = sign / (6 * unit);
      const Index corner = result.start[c];
      std::copy(x.data(), x.data() + 3 * (result.start[c + 1] - corner),
        result.corners.data() + 3 * corner);
      for (int t = 0; t < parts.count; ++t)
      {
        const double volume = sign * edges(parts.tets[t], x).determinant() / 6;
        if (volume > (t < cornerTetrahedra(shape) ? 0 : least))
        {
          result.included[c] |= 1u << t;
        }
      }
    });

  // The mean over all tetrahedra becomes 1.
  const double total = communicator.sum(reproducibleSum(cells, monitor, 0.,
    [&](Index c)
    {
      const SimplicialDecomposition parts = partsOf(rest, c);
      double sum = 0;
      for (int t = 0; t < parts.count; ++t)
      {
        if (result.includes(c, t))
        {
          sum += parts.tets[t].weight * result.edges(c, parts.tets[t]).determinant();
        }
      }
      return sum * result.factor[c];
    }));
  Index count = 0;
  for (Index c = 0; c < cells; ++c)
  {
    count += partsOf(rest, c).count;
  }
  const double scale = communicator.sum(static_cast<double>(count)) / total;
  for (double& factor : result.factor)
  {
    factor *= scale;
  }
  return result;
}

void excludeOnFoldedFaces(const Mesh& mesh, const BoundaryFaces& faces,
  const std::vector<Index>& folded, TargetMatrices& targets)
{
  for (Index f : folded)
  {
    const Index c = faces.cells[f];
    const Index* first = faces.connectivity.data() + faces.offsets[f];
    const Index* last = faces.connectivity.data() + faces.offsets[f + 1];
    for (int t = 0; t < partsOf(mesh, c).count; ++t)
    {
      const std::array<Index, 4> nodes = nodesOf(mesh, c, t);
      const auto onFace = std::count_if(nodes.begin(), nodes.end(),
        [&](Index node) { return std::find(first, last, node) != last; });
      if (onFace >= 3)
      {
        targets.exclude(c, t);
      }
    }
  }
}

namespace
{
bool isPositive(const std::array<Index, 4>& node, double sign, const Points& points)
{
  Eigen::Matrix3d D;
  for (int k = 0; k < 3; ++k)
  {
    D.col(k) = (points.row(node[k + 1]) - points.row(node[0])).transpose();
  }
  return sign * D.determinant() > 0;
}
}

std::vector<Index> tangledCells(
  const Mesh& mesh, const Points& points, const TargetMatrices& targets)
{
  std::vector<Index> result;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    bool tangled = false;
    for (int t = 0; t < partsOf(mesh, c).count && !tangled; ++t)
    {
      tangled =
        targets.includes(c, t) && !isPositive(nodesOf(mesh, c, t), targets.factor[c], points);
    }
    if (tangled)
    {
      result.push_back(c);
    }
  }
  return result;
}

Index excludeInvertedAtFixedNodes(
  const Mesh& mesh, const std::vector<char>& isFixed, const Points& points, TargetMatrices& targets)
{
  Index dropped = 0;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    for (int t = 0; t < partsOf(mesh, c).count; ++t)
    {
      const std::array<Index, 4> node = nodesOf(mesh, c, t);
      if (targets.includes(c, t) &&
          std::count_if(node.begin(), node.end(), [&](Index n) { return isFixed[n] != 0; }) >= 2 &&
          !isPositive(node, targets.factor[c], points))
      {
        targets.exclude(c, t);
        ++dropped;
      }
    }
  }
  return dropped;
}

namespace
{

/// Returns the volume of each volume cell, 0 for other cells. Nearly flat cells get the mean.
std::vector<double> volumes(const Mesh& rest, const Communicator& communicator)
{
  std::vector<double> result(rest.numberOfCells(), 0);
  double sum = 0;
  Index count = 0;
  for (Index c = 0; c < rest.numberOfCells(); ++c)
  {
    const CellShape& shape = *cellShape(rest, c);
    double x[8][3];
    copyCorners(rest, c, shape, rest.points, x[0]);
    if (numberOfCorners(shape.shape) > 0)
    {
      result[c] = std::abs(signedVolume(shape.shape, x));
      sum += result[c];
      ++count;
    }
  }
  sum = communicator.sum(sum);
  count = communicator.sum(count);
  const double mean = count > 0 ? sum / static_cast<double>(count) : 0;
  for (Index c = 0; c < rest.numberOfCells(); ++c)
  {
    if (hasCorners(rest, c) && !(result[c] > LeastVolume * mean))
    {
      result[c] = mean > 0 ? mean : 1;
    }
  }
  return result;
}

TargetMatrices idealTargets(
  const Mesh& rest, const std::vector<std::int8_t>& orientation, const Communicator& communicator)
{
  const std::vector<double> volume = volumes(rest, communicator);
  TargetMatrices result;
  result.open(rest);
  for (Index c = 0; c < rest.numberOfCells(); ++c)
  {
    const Shape shape = cellShape(rest, c)->shape;
    const int corners = cornerTetrahedra(shape);
    if (corners == 0)
    {
      continue;
    }
    CellCorners ideal = idealShape(shape, Eigen::Vector3d::Ones());
    double x[8][3];
    std::copy(ideal.data(), ideal.data() + ideal.size(), x[0]);
    ideal *= std::cbrt(volume[c] / std::abs(signedVolume(shape, x)));
    ideal.row(0) *= orientation[c];
    std::copy(ideal.data(), ideal.data() + 3 * numberOfCorners(shape),
      result.corners.data() + 3 * result.start[c]);
    // The corners' tetrahedra are alike, and each has the same share of a weight of 1.
    const WeightedTet& first = simplicialDecomposition(shape).tets[0];
    result.factor[c] = 1 / (corners * first.weight * result.edges(c, first).determinant());
    result.included[c] = (1u << corners) - 1;
  }
  return result;
}
}

TargetMatrices smoothingTargets(const Mesh& rest, const std::vector<std::int8_t>& orientation,
  SmoothingTarget target, Monitor& monitor, const Communicator& communicator)
{
  if (target == SmoothingTarget::Ideal)
  {
    return idealTargets(rest, orientation, communicator);
  }
  TargetMatrices result = targetMatrices(rest, orientation, rest.points,
    TargetConstruction::Initial, CellWeights::Volume, monitor, communicator);
  result.theta = 0;
  return result;
}
}
