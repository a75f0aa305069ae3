// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/Criteria.h"

#include "Mesh/CellShape.h"
#include "Mesh/FaceTable.h"
#include "Mesh/Polyhedra.h"
#include "Quality/MeasuredPlaces.h"
#include "Support/Parallel.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace morph
{
namespace
{
using Vector = Eigen::Vector3d;
constexpr double NaN = std::numeric_limits<double>::quiet_NaN();
constexpr double Infinity = std::numeric_limits<double>::infinity();

/// A face of a cell, seen from outside.
struct Face
{
  std::vector<Vector> x;
  Vector center, area;
  Index neighbor = -1; ///< the cell behind it; -1: none
  bool isWall = true;  ///< its corners are nodes of the walls

  const Vector& at(std::size_t k) const { return this->x[k % this->x.size()]; }
};

/// The unit vector; zero for none.
Vector direction(const Vector& v)
{
  const double length = v.stableNorm();
  return length > 0 ? Vector(v / length) : Vector(0, 0, 0);
}

/// In degrees.
double angle(const Vector& a, const Vector& b)
{
  return std::acos(std::clamp(direction(a).dot(direction(b)), -1., 1.)) * 180 / EIGEN_PI;
}

/// As OpenFOAM has them (primitiveMeshFaceCentresAndAreas.C).
void setCenterAndArea(Face& face)
{
  const double count = static_cast<double>(face.x.size());
  const Vector mean = std::accumulate(face.x.begin(), face.x.end(), Vector(0, 0, 0)) / count;
  Vector weighted = Vector::Zero();
  double areas = 0;
  face.area.setZero();
  for (std::size_t k = 0; k < face.x.size(); ++k)
  {
    const Vector area = (face.at(k + 1) - face.x[k]).cross(mean - face.x[k]) / 2;
    face.area += area;
    areas += area.norm();
    weighted += area.norm() * (face.x[k] + face.at(k + 1) + mean) / 3;
  }
  face.center = areas > 0 && face.x.size() > 3 ? Vector(weighted / areas) : mean;
}
}

/// The faces and centers of cells.
class CellGeometry
{
public:
  /// `isWall`: #nodes, or empty for all; `hasNeighbors`: whether faces know the cells behind them.
  CellGeometry(const Mesh& mesh, const ConstPoints& points,
    const std::vector<std::int8_t>& orientation, const std::vector<std::uint8_t>& isWall,
    bool hasNeighbors, Monitor& monitor)
    : mesh_(mesh)
    , points_(points)
    , orientation_(orientation)
    , isWall_(isWall)
  {
    if (!hasNeighbors)
    {
      return;
    }
    const FaceTable table = faceTable(mesh, monitor);
    this->start_ = table.start;
    this->neighbor_.assign(table.first.size(), -1);
    std::vector<Index> other(table.first.size(), -1); // the cell that has an equal face
    for (Index c = 0; c < mesh.numberOfCells(); ++c)
    {
      for (Index f = table.start[c]; f < table.start[c + 1]; ++f)
      {
        const Index first = table.first[f];
        if (first != f)
        {
          this->neighbor_[f] = other[first];
          this->neighbor_[first] = c;
        }
        other[f] = c;
      }
    }
    this->centers_.resize(mesh.numberOfCells());
    parallel(mesh.numberOfCells(), 256, monitor,
      [&](Index c)
      {
        if (this->shape(c) && this->shape(c)->dimension == 3)
        {
          this->centers_[c] = centerOf(this->faces(c));
        }
      });
  }

  const CellShape* shape(Index cell) const { return cellShape(this->mesh_, cell); }
  /// Whether corners of the cell are at one place by their numbers: it is no hexahedron.
  bool isCollapsed(Index cell) const
  {
    return hasFaces(this->mesh_, cell) && !isPolyhedron(this->mesh_, cell);
  }
  const Vector& center(Index cell) const { return this->centers_[cell]; }
  double sign(Index cell) const
  {
    return this->orientation_.empty() ? 1 : this->orientation_[cell];
  }
  std::vector<Vector> corners(Index cell) const { return this->at(this->cornerNodes(cell)); }

  std::vector<Face> faces(Index cell) const
  {
    const CellShape& shape = *this->shape(cell);
    std::vector<Face> result;
    const auto add = [&](const std::vector<Index>& nodes, Index side)
    {
      Face face{ this->at(nodes), {}, {} };
      face.isWall = this->isWall_.empty() || std::all_of(nodes.begin(), nodes.end(),
                                               [this](Index node) { return this->isWall_[node]; });
      if (shape.dimension == 3 && !this->neighbor_.empty())
      {
        face.neighbor = this->neighbor_[this->start_[cell] + side];
      }
      setCenterAndArea(face);
      face.area *= this->sign(cell);
      result.push_back(std::move(face));
    };
    if (hasFaces(this->mesh_, cell))
    {
      Index side = 0;
      forEachSide(this->mesh_, cell,
        [&](const Index* begin, Index size)
        {
          std::vector<Index> nodes; // a collapsed cell repeats some
          std::copy_if(begin, begin + size, std::back_inserter(nodes),
            [&](Index n) { return std::find(nodes.begin(), nodes.end(), n) == nodes.end(); });
          if (nodes.size() > 2)
          {
            add(nodes, side);
          }
          ++side;
        });
      return result;
    }
    const std::vector<Index> corner = this->cornerNodes(cell);
    if (shape.dimension == 2)
    {
      add(corner, 0);
    }
    for (int f = 0; f < shape.numberOfFaces; ++f)
    {
      const FaceShape& face = shape.faces[f];
      std::vector<Index> nodes;
      std::transform(face.corner, face.corner + face.size, std::back_inserter(nodes),
        [&corner](int k) { return corner[k]; });
      add(nodes, f);
    }
    return result;
  }

private:
  std::vector<Index> cornerNodes(Index cell) const
  {
    const CellShape& shape = *this->shape(cell);
    std::vector<Index> nodes;
    for (Index k = 0; k < cornerCount(this->mesh_, cell, shape); ++k)
    {
      nodes.push_back(
        this->mesh_.cell(cell)[shape.shape == Shape::Polyhedron ? k : shape.cornerNode[k]]);
    }
    return nodes;
  }

  std::vector<Vector> at(const std::vector<Index>& nodes) const
  {
    std::vector<Vector> x;
    std::transform(nodes.begin(), nodes.end(), std::back_inserter(x),
      [this](Index node) -> Vector { return this->points_.row(node).transpose(); });
    return x;
  }

  /// As OpenFOAM has it (primitiveMeshCellCentresAndVols.C).
  static Vector centerOf(const std::vector<Face>& faces)
  {
    Vector mean = Vector::Zero(), weighted = Vector::Zero();
    for (const Face& face : faces)
    {
      mean += face.center / static_cast<double>(faces.size());
    }
    double volumes = 0;
    for (const Face& face : faces)
    {
      const double volume = face.area.dot(face.center - mean);
      volumes += volume;
      weighted += volume * (.75 * face.center + .25 * mean);
    }
    return std::abs(volumes) > 0 ? Vector(weighted / volumes) : mean;
  }

  const Mesh& mesh_;
  const ConstPoints& points_;
  const std::vector<std::int8_t>& orientation_;
  const std::vector<std::uint8_t>& isWall_;
  std::vector<Index> start_, neighbor_; ///< as of FaceTable
  std::vector<Vector> centers_;
};

namespace
{
/// The largest of act(face), or NaN.
template <typename Act>
double most(const CellGeometry& geometry, Index cell, const Act& act)
{
  double result = NaN;
  for (const Face& face : geometry.faces(cell))
  {
    result = std::fmax(result, act(face));
  }
  return result;
}

double aspectRatio(const CellGeometry& geometry, Index cell)
{
  double longest = 0, shortest = Infinity;
  for (const Face& face : geometry.faces(cell))
  {
    for (std::size_t k = 0; k < face.x.size(); ++k)
    {
      const double length = (face.at(k + 1) - face.x[k]).stableNorm();
      longest = std::max(longest, length);
      shortest = std::min(shortest, length);
    }
  }
  return longest / shortest;
}

double skewness(const CellGeometry& geometry, Index cell)
{
  return most(geometry, cell,
    [](const Face& face)
    {
      const auto count = face.x.size();
      const double ideal = 180. * static_cast<double>(count - 2) / static_cast<double>(count);
      double result = 0;
      for (std::size_t k = 0; k < count; ++k)
      {
        const double found =
          angle(face.at(k + 1) - face.x[k], face.at(k + count - 1) - face.x[k]) - ideal;
        result = std::max({ result, found / (180 - ideal), -found / ideal });
      }
      return result;
    });
}

double warpage(const CellGeometry& geometry, Index cell)
{
  return most(geometry, cell,
    [](const Face& face)
    {
      const std::size_t count = face.x.size();
      std::vector<Vector> normal;
      for (std::size_t k = 0; k < count; ++k)
      {
        const Vector before = face.x[k] - face.at(k + count - 1);
        normal.push_back(direction(before.cross(face.at(k + 1) - face.x[k])));
      }
      double least = 1;
      for (std::size_t k = 0; k < count; ++k)
      {
        for (std::size_t j = k + 2; j < std::min(count, k + count - 1); ++j)
        {
          least = std::min(least, normal[k].dot(normal[j]));
        }
      }
      return 1 - least * least * least;
    });
}

double jacobianRatio(const CellGeometry& geometry, Index cell)
{
  if (geometry.isCollapsed(cell))
  {
    return NaN; // as of a polyhedron
  }
  const std::vector<Vector> x = geometry.corners(cell);
  const CellShape& shape = *geometry.shape(cell);
  double least = Infinity, largest = -Infinity;
  std::size_t place = 0;
  forEachMeasuredPlace(shape.shape, x.data(),
    [&](const Vector& a, const Vector& b, const Vector& c)
    {
      if (place++ < x.size()) // not a hexahedron's center
      {
        const double determinant = geometry.sign(cell) * a.dot(b.cross(c));
        least = std::min(least, determinant);
        largest = std::max(largest, determinant);
      }
    });
  return place > 0 ? least / std::max(largest, 0.) : NaN;
}

double nonOrthogonality(const CellGeometry& geometry, Index cell)
{
  return most(geometry, cell,
    [&](const Face& face)
    {
      return face.neighbor < 0
               ? 0
               : angle(face.area, geometry.center(face.neighbor) - geometry.center(cell));
    });
}

double faceSkewness(const CellGeometry& geometry, Index cell)
{
  return most(geometry, cell,
    [&](const Face& face)
    {
      const bool isInner = face.neighbor >= 0;
      const Vector toFace = face.center - geometry.center(cell), normal = direction(face.area);
      const Vector line = isInner ? Vector(geometry.center(face.neighbor) - geometry.center(cell))
                                  : Vector(normal * normal.dot(toFace));
      const Vector off = toFace - face.area.dot(toFace) / face.area.dot(line) * line;
      double extent = (isInner ? .2 : .4) * line.norm();
      for (const Vector& x : face.x)
      {
        extent = std::max(extent, std::abs(direction(off).dot(x - face.center)));
      }
      return off.norm() / extent;
    });
}

double facePyramid(const CellGeometry& geometry, Index cell)
{
  return -most(geometry, cell,
    [&](const Face& face) { return face.area.dot(geometry.center(cell) - face.center) / 3; });
}

double firstHeight(const CellGeometry& geometry, Index cell)
{
  const std::vector<Vector> x = geometry.corners(cell);
  return -most(geometry, cell,
    [&](const Face& face)
    {
      double sum = 0, others = 0;
      for (const Vector& corner : x)
      {
        if (std::find(face.x.begin(), face.x.end(), corner) == face.x.end())
        {
          sum += direction(face.area).dot(corner - face.center);
          ++others;
        }
      }
      return face.neighbor < 0 && face.isWall ? sum / others : NaN;
    });
}
}

const std::vector<Criterion>& criteria()
{
  static const std::vector<Criterion> all = {
    { "AspectRatio", 100, true, aspectRatio },
    { "Skewness", .95, true, skewness },
    { "Warpage", .7, true, warpage },
    { "JacobianRatio", .03, false, jacobianRatio },
    { "Taper", .5, true, nullptr },
    { "NonOrthogonality", 70, true, nonOrthogonality },
    { "FaceSkewness", 4, true, faceSkewness },
    { "FacePyramid", 0, false, facePyramid },
    { "FirstHeight", 0, false, firstHeight },
  };
  return all;
}

std::vector<double> measureCriterion(const Criterion& criterion, const Mesh& mesh,
  const ConstPoints& points, const std::vector<std::int8_t>& orientation,
  const std::vector<std::uint8_t>& skip, const std::vector<std::uint8_t>& isWall, Monitor& monitor)
{
  constexpr Index Batch = 16384, Grain = 256;
  std::vector<double> values(mesh.numberOfCells(), NaN);
  if (!criterion.measure)
  {
    return values;
  }
  const bool ofVolumes = criterion.measure == nonOrthogonality ||
                         criterion.measure == faceSkewness || criterion.measure == facePyramid ||
                         criterion.measure == firstHeight;
  const CellGeometry geometry(mesh, points, orientation, isWall, ofVolumes, monitor);
  parallelBatches(monitor, mesh.numberOfCells(), Batch, Grain,
    [&](Index first, Index last)
    {
      for (Index c = first; c < last; ++c)
      {
        const CellShape* shape = geometry.shape(c);
        if (shape && shape->shape != Shape::Other && shape->dimension >= (ofVolumes ? 3 : 2) &&
            (skip.empty() || !skip[c]))
        {
          values[c] = criterion.measure(geometry, c);
        }
      }
    });
  return values;
}
}
