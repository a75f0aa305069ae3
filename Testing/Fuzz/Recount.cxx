// SPDX-License-Identifier: BSD-3-Clause
#include "Recount.h"

#include "Choices.h"
#include "Mesh/CellShape.h"
#include "Mesh/Polyhedra.h"

#include <vtkCell3D.h>
#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkNonLinearCell.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace fuzz
{
namespace
{
using morph::Index;
using morph::Mesh;
using morph::Points;
using Vector = Eigen::Vector3d;

constexpr double Rounding = 1e-9;
/// Corners so near, of the largest coordinate, are in one place: rounding gives their direction.
constexpr double OnePlace = 1e-12;

/// The corner, then its three neighbors, right-handed in a valid cell.
using Corners = std::vector<std::array<int, 4>>;

const Corners& cornersOf(morph::Shape shape)
{
  static const Corners none;
  static const Corners tet = { { 0, 1, 2, 3 } };
  static const Corners hex = { { 0, 1, 3, 4 }, { 1, 2, 0, 5 }, { 2, 3, 1, 6 }, { 3, 0, 2, 7 },
    { 4, 7, 5, 0 }, { 5, 4, 6, 1 }, { 6, 5, 7, 2 }, { 7, 6, 4, 3 } };
  static const Corners wedge = { { 0, 1, 2, 3 }, { 1, 2, 0, 4 }, { 2, 0, 1, 5 }, { 3, 5, 4, 0 },
    { 4, 3, 5, 1 }, { 5, 4, 3, 2 } };
  static const Corners pyramid = { { 0, 1, 3, 4 }, { 1, 2, 0, 4 }, { 2, 3, 1, 4 }, { 3, 0, 2, 4 } };
  switch (shape)
  {
    case morph::Shape::Tet:
      return tet;
    case morph::Shape::Hex:
      return hex;
    case morph::Shape::Wedge:
      return wedge;
    case morph::Shape::Pyramid:
      return pyramid;
    default:
      return none;
  }
}

/// Of an edge in units of the largest coordinate.
Vector direction(const Vector& edge)
{
  const double length = edge.stableNorm();
  return length > OnePlace ? Vector(edge / length) : Vector(Vector::Zero());
}

struct Determinants
{
  double least = std::numeric_limits<double>::infinity(); ///< of edges of length 1
  double most = -std::numeric_limits<double>::infinity();
  bool isCollapsed = false; ///< two corners are in one place
};

bool isVolume(const Mesh& mesh, Index c)
{
  const morph::CellShape* shape = morph::cellShape(mesh.types[c]);
  return shape && shape->dimension == 3;
}

/// `unit`: what lengths are divided by.
Determinants determinants(const Mesh& mesh, const Points& points, Index c, double unit)
{
  const morph::CellShape& shape = *morph::cellShape(mesh.types[c]);
  const auto corner = [&](int k) -> Vector
  { return points.row(mesh.cell(c)[shape.cornerNode[k]]).transpose(); };
  Determinants result;
  const auto take = [&result](const Vector& a, const Vector& b, const Vector& d)
  {
    const double value = direction(a).dot(direction(b).cross(direction(d)));
    result.least = std::min(result.least, value);
    result.most = std::max(result.most, value);
  };
  for (const auto& at : cornersOf(shape.shape))
  {
    const Vector x = corner(at[0]);
    const Vector a = (corner(at[1]) - x) / unit, b = (corner(at[2]) - x) / unit,
                 d = (corner(at[3]) - x) / unit;
    take(a, b, d);
  }
  for (int k = 1; k < shape.numberOfCorners; ++k)
  {
    for (int other = 0; other < k; ++other)
    {
      result.isCollapsed =
        result.isCollapsed || (corner(k) - corner(other)).stableNorm() <= OnePlace * unit;
    }
  }
  if (shape.shape == morph::Shape::Hex)
  {
    const auto mean = [&](std::array<int, 4> to, std::array<int, 4> from)
    {
      Vector sum = Vector::Zero();
      for (int k = 0; k < 4; ++k)
      {
        sum += (corner(to[k]) - corner(from[k])) / unit;
      }
      return sum;
    };
    take(mean({ 1, 2, 5, 6 }, { 0, 3, 4, 7 }), mean({ 2, 3, 6, 7 }, { 0, 1, 4, 5 }),
      mean({ 4, 5, 6, 7 }, { 0, 1, 2, 3 }));
  }
  return result;
}

double extent(const Points& points)
{
  const double most = points.size() > 0 ? points.cwiseAbs().maxCoeff() : 0;
  return most > 0 && std::isfinite(most) ? most : 1;
}

/// VTK's quadratic pyramid has derivatives of other functions than its own. Central differences of
/// these are exact, as they are of degree two in each coordinate.
void pyramidSlopes(vtkGenericCell* cell, const double (&at)[3], std::vector<double>& slopes)
{
  constexpr int Nodes = 13;
  for (int j = 0; j < 3; ++j)
  {
    double low[3] = { at[0], at[1], at[2] }, high[3] = { at[0], at[1], at[2] };
    low[j] -= 0.5;
    high[j] += 0.5;
    double below[Nodes], above[Nodes];
    cell->InterpolateFunctions(low, below);
    cell->InterpolateFunctions(high, above);
    for (int a = 0; a < Nodes; ++a)
    {
      slopes[j * Nodes + a] = above[a] - below[a];
    }
  }
}

std::uint8_t linearType(morph::Shape shape)
{
  return shape == morph::Shape::Tet     ? morph::Tetra
         : shape == morph::Shape::Hex   ? morph::Hexahedron
         : shape == morph::Shape::Wedge ? morph::Wedge
                                        : morph::Pyramid;
}

/// The volume of the corner cell, and the cube of its longest edge or diagonal. The determinants at
/// the corners do not tell it: in twisted cells their sum may have the other sign.
std::pair<double, double> volume(
  vtkGenericCell* cell, const Mesh& mesh, const Points& points, Index c, double unit)
{
  const morph::CellShape& shape = *morph::cellShape(mesh.types[c]);
  const bool isTriangular = shape.shape == morph::Shape::Tet || shape.shape == morph::Shape::Wedge;
  const int corners = shape.numberOfCorners;
  cell->SetCellType(linearType(shape.shape));
  Eigen::Matrix3Xd x(3, corners);
  double longest = 0;
  for (int a = 0; a < corners; ++a)
  {
    const auto first = points.row(mesh.cell(c)[shape.cornerNode[0]]);
    x.col(a) = (points.row(mesh.cell(c)[shape.cornerNode[a]]) - first).transpose() / unit;
    longest = std::max(longest, x.col(a).norm());
  }
  // The determinant is at most quadratic in each coordinate: two Gauss points each are exact.
  const double gauss[2] = { 0.5 - std::sqrt(1. / 12), 0.5 + std::sqrt(1. / 12) };
  double sum = 0;
  for (int sample = 0; sample < 8; ++sample)
  {
    double at[3] = { gauss[sample & 1], gauss[sample >> 1 & 1], gauss[sample >> 2] };
    if (isTriangular)
    {
      at[0] = at[1] = 1. / 3; // linear over the triangle
    }
    double slopes[24];
    cell->InterpolateDerivs(at, slopes);
    const Eigen::Map<const Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>> derivatives(
      slopes, 3, corners);
    const Eigen::Matrix3d jacobian = x * derivatives.transpose();
    sum += jacobian.determinant() / 8;
  }
  const double part = shape.shape == morph::Shape::Tet ? 6 : isTriangular ? 2 : 1;
  return { sum / part, longest * longest * longest };
}

/// For each cell +1, -1, or 0 where nobody can tell: one for the cells of one shape in one body.
/// In a tangled body of several shapes the volumes alone do not tell; the library compares faces.
std::vector<int> senses(const Mesh& mesh, const Points& reference)
{
  std::vector<Index> parent(mesh.numberOfNodes());
  std::iota(parent.begin(), parent.end(), Index{ 0 });
  const auto root = [&parent](Index n)
  {
    while (parent[n] != n)
    {
      n = parent[n] = parent[parent[n]];
    }
    return n;
  };
  struct Group
  {
    double sum = 0, absolute = 0;
    double size = 0; ///< what rounding is measured by
    int cells = 0;
  };
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const int corners = isVolume(mesh, c) ? morph::cellShape(mesh.types[c])->numberOfCorners : 0;
    for (int k = 1; k < corners; ++k)
    {
      parent[root(mesh.cell(c)[k])] = root(mesh.cell(c)[0]);
    }
  }
  std::map<std::pair<Index, morph::Shape>, Group> groups;
  const auto groupOf = [&](Index c) -> Group& {
    return groups[{ root(mesh.cell(c)[0]), morph::cellShape(mesh.types[c])->shape }];
  };
  const double unit = extent(reference);
  vtkNew<vtkGenericCell> cell;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (isVolume(mesh, c))
    {
      const auto [signedVolume, size] = volume(cell, mesh, reference, c, unit);
      Group& group = groupOf(c);
      group.sum += signedVolume;
      group.absolute += std::abs(signedVolume);
      group.size += size;
      ++group.cells;
    }
  }
  struct Body
  {
    int shapes = 0;
    bool isTangled = false;
  };
  std::map<Index, Body> bodies;
  for (const auto& [key, group] : groups)
  {
    if (group.cells > 1)
    {
      Body& body = bodies[key.first];
      ++body.shapes;
      // The library's limit is a half, of volumes that are summed in another way.
      body.isTangled = body.isTangled || std::abs(group.sum) < 0.6 * group.absolute;
    }
  }
  std::vector<int> result(mesh.numberOfCells(), 0);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (isVolume(mesh, c))
    {
      const Group& group = groupOf(c);
      const Body& body = bodies[root(mesh.cell(c)[0])];
      const bool isClear = std::abs(group.sum) > 1e-12 * group.size && group.cells > 1 &&
                           !(body.isTangled && body.shapes > 1);
      result[c] = !isClear ? 0 : group.sum > 0 ? 1 : -1;
    }
  }
  return result;
}
}

Recount recount(const Mesh& mesh, const Points& reference, const Points& points,
  const std::vector<std::uint8_t>& skip)
{
  Recount result;
  result.bad.assign(mesh.numberOfCells(), 0);
  const std::vector<int> sense = senses(mesh, reference);
  const double unit = extent(points);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (!isVolume(mesh, c) || (!skip.empty() && skip[c]))
    {
      continue;
    }
    Determinants found = determinants(mesh, points, c, unit);
    if (sense[c] < 0)
    {
      std::swap(found.least, found.most);
      found.least *= -1;
      found.most *= -1;
    }
    const morph::CellShape& shape = *morph::cellShape(mesh.types[c]);
    const bool isMore =
      shape.numberOfNodes > shape.numberOfCorners || morph::hasFaces(mesh, c); // than its corners
    if (isMore)
    {
      // Between its corners it is another cell: valid where they are not, and the other way round.
      result.bad[c] = -1;
    }
    else if (sense[c] == 0)
    {
      // Inverted whatever the sense is: both signs occur.
      result.bad[c] = found.least < -Rounding && found.most > Rounding ? 1 : -1;
    }
    else
    {
      const bool isUnclear = found.least <= Rounding || found.isCollapsed;
      result.bad[c] = found.least < -Rounding ? 1 : isUnclear ? -1 : 0;
    }
    result.lowest += result.bad[c] == 1;
    result.highest += result.bad[c] != 0;
  }
  return result;
}

int isMirrored(const Mesh& mesh)
{
  const std::vector<int> sense = senses(mesh, mesh.points);
  const double unit = extent(mesh.points);
  int mirrored = 0, cells = 0;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (isVolume(mesh, c))
    {
      // Cells whose corners differ have a volume whose sign corners alone do not tell.
      const Determinants found = determinants(mesh, mesh.points, c, unit);
      const bool isClear = found.least > 0.01 || found.most < -0.01;
      if (sense[c] == 0 || !isClear || (sense[c] > 0) != (found.least > 0))
      {
        return -1;
      }
      mirrored += sense[c] < 0;
      ++cells;
    }
  }
  return cells == 0 ? -1 : mirrored > 0 ? 1 : 0;
}

bool isInvertedByMirror(const Mesh& mesh)
{
  Points mirrored = mesh.points;
  mirrored.col(0) *= -1;
  const std::vector<int> sense = senses(mesh, mirrored);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (isVolume(mesh, c) && sense[c] >= 0)
    {
      return true;
    }
  }
  return false;
}

namespace
{
/// The least part of a face's normal, 1 or less, that one has at a corner: negative in a folded
/// face. 1 for cells of other dimensions.
double leastOfFace(const Mesh& mesh, const Points& points, Index c, double unit)
{
  const morph::CellShape* shape = morph::cellShape(mesh.types[c]);
  if (!shape || shape->dimension != 2 || shape->numberOfCorners < 3)
  {
    return 1;
  }
  std::vector<Vector> normals;
  Vector sum = Vector::Zero();
  const int corners = shape->numberOfCorners;
  for (int k = 0; k < corners; ++k)
  {
    const auto at = [&](int corner) -> Vector
    { return points.row(mesh.cell(c)[shape->cornerNode[corner % corners]]).transpose() / unit; };
    const Vector x = at(k);
    normals.push_back(direction(at(k + 1) - x).cross(direction(at(k + corners - 1) - x)));
    sum += normals.back();
  }
  double least = 1;
  for (const Vector& normal : normals)
  {
    least = std::min(least, normal.dot(sum.normalized()));
  }
  return least;
}

/// The minimum determinant, of edges of length 1, of the tetrahedra between the middle of a
/// polyhedron, the middle of a face and an edge of this.
double leastOfPolyhedron(const Mesh& mesh, const Points& points, Index c)
{
  const auto middleOf = [&](const Index* nodes, Index size) -> Vector
  {
    return points(std::vector<Index>(nodes, nodes + size), morph::allColumns)
      .colwise()
      .mean()
      .transpose();
  };
  const Vector middle = middleOf(mesh.cell(c), mesh.cellSize(c));
  double least = 1;
  morph::forEachFace(mesh, c,
    [&](const Index* nodes, Index size)
    {
      const Vector up = (middleOf(nodes, size) - middle).stableNormalized();
      for (Index k = 0; k < size; ++k)
      {
        const Vector a = points.row(nodes[k]).transpose() - middle;
        const Vector b = points.row(nodes[(k + 1) % size]).transpose() - middle;
        least = std::min(least, a.stableNormalized().cross(b.stableNormalized()).dot(up));
      }
    });
  return least;
}
}

bool isValid(const Mesh& mesh, const Points& points, double least)
{
  const double unit = extent(points);
  bool hasVolume = false;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    hasVolume = hasVolume || isVolume(mesh, c);
    if (isVolume(mesh, c) &&
        !((morph::hasFaces(mesh, c) ? leastOfPolyhedron(mesh, points, c)
                                    : determinants(mesh, points, c, unit).least) > least))
    {
      return false;
    }
  }
  for (Index c = 0; c < mesh.numberOfCells() && !hasVolume; ++c)
  {
    if (!(leastOfFace(mesh, points, c, unit) > least))
    {
      return false;
    }
  }
  return true;
}

Index falselyCertified(const Mesh& mesh, const Points& reference, const Points& points,
  const std::vector<signed char>& claim, double rounding, std::uint64_t seed)
{
  const std::vector<int> sense = senses(mesh, reference);
  const double unit = extent(points);
  Random random(seed);
  vtkNew<vtkGenericCell> cell;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (!isVolume(mesh, c) || claim[c] != 1 || sense[c] == 0)
    {
      continue;
    }
    const morph::CellShape& shape = *morph::cellShape(mesh.types[c]);
    const bool isVoxel = mesh.types[c] == morph::Voxel; // taken as a hexahedron in VTK's order
    cell->SetCellType(isVoxel ? std::uint8_t{ morph::Hexahedron } : mesh.types[c]);
    const auto nodes = static_cast<int>(mesh.cellSize(c));
    std::vector<double> slopes(3 * nodes);
    for (int sample = 0; sample < 12; ++sample)
    {
      double at[3] = { random.unit(), random.unit(), random.unit() };
      // Corners and edges are where cells invert first.
      for (double& x : at)
      {
        x = random.happens(0.3) ? std::round(x) : x;
      }
      const bool isTriangular =
        shape.shape == morph::Shape::Tet || shape.shape == morph::Shape::Wedge;
      if (isTriangular && at[0] + at[1] > 1)
      {
        at[0] = 1 - at[0];
        at[1] = 1 - at[1];
      }
      if (shape.shape == morph::Shape::Tet)
      {
        at[2] *= 1 - at[0] - at[1];
      }
      if (shape.shape == morph::Shape::Pyramid)
      {
        at[2] *= 0.9; // no determinant at the apex
      }
      if (mesh.types[c] == morph::QuadraticPyramid)
      {
        pyramidSlopes(cell, at, slopes);
      }
      else
      {
        cell->InterpolateDerivs(at, slopes.data());
      }
      Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
      Vector sizes = Vector::Zero(); // of the sums that give the columns
      for (int a = 0; a < nodes; ++a)
      {
        const int node = isVoxel ? shape.cornerNode[a] : a;
        const Vector x =
          (points.row(mesh.cell(c)[node]) - points.row(mesh.cell(c)[0])).transpose() / unit;
        for (int j = 0; j < 3; ++j)
        {
          jacobian.col(j) += x * slopes[j * nodes + a];
          sizes[j] += x.norm() * std::abs(slopes[j * nodes + a]);
        }
      }
      const Vector columns = jacobian.colwise().norm().transpose();
      if ((columns.array() < 1e-6 * sizes.array()).any())
      {
        continue; // rounding gives the direction of a derivative that vanishes
      }
      const double lengths = columns.prod();
      if (sense[c] * jacobian.determinant() < -rounding * lengths)
      {
        return c;
      }
    }
  }
  return -1;
}
}
