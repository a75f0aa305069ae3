// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/ShapeWindings.h"

#include "Mesh/CellShape.h"
#include "Mesh/Polyhedra.h"
#include "Mesh/SimplicialDecomposition.h"
#include "Support/Parallel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace morph
{
namespace
{
std::size_t slot(const ConnectedComponents& bodies, Index cell, Shape shape)
{
  return static_cast<std::size_t>(bodies.ofCell[cell]) * ShapeVolumes::Shapes +
         static_cast<std::size_t>(shape);
}
}

const int ShapeVolumes::Shapes = static_cast<int>(Shape::Polyhedron) + 1;

ShapeVolumes shapeVolumes(const Mesh& mesh, const ConnectedComponents& bodies, Monitor& monitor,
  const Communicator& processes)
{
  std::vector<double> volume(mesh.numberOfCells(), 0.);
  parallel(mesh.numberOfCells(), monitor,
    [&](Index c)
    {
      if (isPolyhedron(mesh, c))
      {
        volume[c] = polyhedronVolume(mesh, c, mesh.points);
      }
      else if (const CellShape* shape = volumeShape(mesh, c))
      {
        double corners[8][3];
        copyCorners(mesh, c, *shape, mesh.points, corners[0]);
        volume[c] = signedVolume(shape->shape, corners);
      }
    });
  ShapeVolumes sums;
  sums.volume.assign(bodies.count * ShapeVolumes::Shapes, 0);
  sums.cells.assign(sums.volume.size(), 0);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (const CellShape* shape = processes.isCopy(c) ? nullptr : volumeShape(mesh, c))
    {
      const std::size_t at = slot(bodies, c, shape->shape);
      sums.volume[at] += volume[c];
      ++sums.cells[at];
    }
  }
  processes.sum(sums.volume.data(), static_cast<int>(sums.volume.size()));
  processes.sum(sums.cells.data(), static_cast<int>(sums.cells.size()));
  return sums;
}

std::vector<std::int8_t> cellSigns(
  const Mesh& mesh, const ConnectedComponents& bodies, const ShapeVolumes& volumes)
{
  std::vector<std::int8_t> result(mesh.numberOfCells(), 1);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (const CellShape* shape = volumeShape(mesh, c))
    {
      const std::size_t at = slot(bodies, c, shape->shape);
      if (volumes.volume[at] < 0 && (volumes.cells[at] > 1 || shape->shape == Shape::Wedge))
      {
        result[c] = -1;
      }
    }
  }
  return result;
}

namespace
{
constexpr double Doubt = 0.5; // of the sum of absolute volumes
constexpr int Shapes = static_cast<int>(Shape::Polyhedron) + 1;

/// The cells of one shape in one body.
struct Group
{
  double volume = 0, absolute = 0, cells = 0;
  /// faces with another shape that wind alike, less those that do not, each counted for both cells
  std::array<double, Shapes> votes{};
  int relative = 0; ///< to the body's first group; 0: not known
};

/// A face, and the direction in which its cell's node list runs around it.
struct Winding
{
  std::array<Index, 4> nodes; ///< ascending, the first -1 in a triangle
  Index group;
  bool isForward;
  int weight; ///< 0 of a copy, which another process has

  bool operator<(const Winding& other) const { return this->nodes < other.nodes; }
};

/// Whether the shape has faces in a table, and corners whose tetrahedra make its volume.
bool isMeasured(const CellShape& shape)
{
  return numberOfCorners(shape.shape) > 0;
}

Winding windingOf(
  const Mesh& mesh, Index cell, const CellShape& shape, int f, Index group, int weight)
{
  const FaceShape& face = shape.faces[f];
  const auto node = [&](int k)
  { return mesh.cell(cell)[shape.cornerNode[face.corner[(k + face.size) % face.size]]]; };
  Winding result{ { -1, -1, -1, -1 }, group, false, weight };
  int lowest = 0;
  for (int k = 0; k < face.size; ++k)
  {
    result.nodes[k] = node(k);
    lowest = node(k) < node(lowest) ? k : lowest;
  }
  result.isForward = node(lowest + 1) < node(lowest - 1);
  std::sort(result.nodes.begin(), result.nodes.end());
  return result;
}

class Alignment
{
public:
  Alignment(const Mesh& mesh, const ConnectedComponents& bodies, const Communicator& processes)
    : mesh_(mesh)
    , bodies_(bodies)
    , processes_(processes)
    , groups_(bodies.count * Shapes)
  {
  }

  /// Returns whether some body has several shapes.
  bool count()
  {
    this->forCells(
      [&](Index c, const CellShape& shape) { this->group(c, shape).cells += this->weight(c); });
    this->sum([](Group& group) { return &group.cells; }, 1);
    bool found = false;
    for (Index body = 0; body < this->bodies_.count; ++body)
    {
      const auto first = this->groups_.begin() + body * Shapes;
      found = found || std::count_if(first, first + Shapes,
                         [](const Group& group) { return group.cells > 1; }) > 1;
    }
    return found;
  }

  /// Returns whether a body is in doubt.
  bool measure()
  {
    this->forCells(
      [&](Index c, const CellShape& shape)
      {
        double corners[8][3];
        copyCorners(this->mesh_, c, shape, this->mesh_.points, corners[0]);
        const double volume = signedVolume(shape.shape, corners);
        Group& group = this->group(c, shape);
        group.volume += this->weight(c) * volume;
        group.absolute += this->weight(c) * std::abs(volume);
      });
    this->sum([](Group& group) { return &group.volume; }, 1);
    this->sum([](Group& group) { return &group.absolute; }, 1);
    this->isInDoubt_.assign(this->bodies_.count, 0);
    for (std::size_t g = 0; g < this->groups_.size(); ++g)
    {
      const Group& group = this->groups_[g];
      if (group.cells > 1 && std::abs(group.volume) < Doubt * group.absolute)
      {
        this->isInDoubt_[g / Shapes] = 1;
      }
    }
    return std::count(this->isInDoubt_.begin(), this->isInDoubt_.end(), 1) > 0;
  }

  void compareFaces()
  {
    std::vector<Winding> faces;
    this->forCells(
      [&](Index c, const CellShape& shape)
      {
        if (this->isInDoubt_[this->bodies_.ofCell[c]])
        {
          for (int f = 0; f < shape.numberOfFaces; ++f)
          {
            faces.push_back(
              windingOf(this->mesh_, c, shape, f, this->number(c, shape), this->weight(c)));
          }
        }
      });
    std::sort(faces.begin(), faces.end());
    for (std::size_t i = 0; i + 1 < faces.size(); ++i)
    {
      const Winding &a = faces[i], &b = faces[i + 1];
      if (a.nodes == b.nodes && a.group != b.group)
      {
        const double vote = (a.isForward != b.isForward ? 1 : -1) * (a.weight + b.weight);
        this->groups_[a.group].votes[b.group % Shapes] += vote;
        this->groups_[b.group].votes[a.group % Shapes] += vote;
      }
    }
    this->sum([](Group& group) { return group.votes.data(); }, Shapes);
  }

  void align(std::vector<std::int8_t>& signs)
  {
    std::vector<int> sign(this->groups_.size(), 0);
    for (Index body = 0; body < this->bodies_.count; ++body)
    {
      for (int first = 0; this->isInDoubt_[body] && first < Shapes; ++first)
      {
        this->alignFrom(body, first, sign);
      }
    }
    this->forCells(
      [&](Index c, const CellShape& shape)
      {
        const int own = sign[this->number(c, shape)];
        signs[c] = static_cast<std::int8_t>(own == 0 ? signs[c] : own);
      });
  }

private:
  template <typename Body>
  void forCells(const Body& body) const
  {
    for (Index c = 0; c < this->mesh_.numberOfCells(); ++c)
    {
      // Scaled Jacobian meets types that the core does not know.
      const CellShape* shape = cellShape(this->mesh_, c);
      if (shape && isMeasured(*shape))
      {
        body(c, *shape);
      }
    }
  }

  int weight(Index cell) const { return this->processes_.isCopy(cell) ? 0 : 1; }

  /// Sums `count` numbers of each group over the processes.
  template <typename NumbersOf>
  void sum(const NumbersOf& numbersOf, int count)
  {
    std::vector<double> all;
    for (Group& group : this->groups_)
    {
      const double* numbers = numbersOf(group);
      all.insert(all.end(), numbers, numbers + count);
    }
    this->processes_.sum(all.data(), static_cast<int>(all.size()));
    const double* next = all.data();
    for (Group& group : this->groups_)
    {
      std::copy_n(next, count, numbersOf(group));
      next += count;
    }
  }

  Index number(Index cell, const CellShape& shape) const
  {
    return this->bodies_.ofCell[cell] * Shapes + static_cast<Index>(shape.shape);
  }
  Group& group(Index cell, const CellShape& shape)
  {
    return this->groups_[this->number(cell, shape)];
  }

  /// Sets the sign of the shapes that shared faces connect with the shape `first`.
  void alignFrom(Index body, int first, std::vector<int>& sign)
  {
    Group* groups = this->groups_.data() + body * Shapes;
    if (groups[first].cells < 2 || groups[first].relative != 0)
    {
      return;
    }
    groups[first].relative = 1;
    std::vector<int> connected{ first };
    double volume = 0;
    for (std::size_t i = 0; i < connected.size(); ++i)
    {
      const Group& from = groups[connected[i]];
      volume += from.relative * from.volume;
      for (int next = 0; next < Shapes; ++next)
      {
        Group& to = groups[next];
        if (from.votes[next] != 0 && to.cells > 1 && to.relative == 0)
        {
          to.relative = from.votes[next] > 0 ? from.relative : -from.relative;
          connected.push_back(next);
        }
      }
    }
    for (const int shape : connected)
    {
      sign[body * Shapes + shape] = volume < 0 ? -groups[shape].relative : groups[shape].relative;
    }
  }

  const Mesh& mesh_;
  const ConnectedComponents& bodies_;
  const Communicator& processes_;
  std::vector<Group> groups_;   ///< #bodies x Shapes
  std::vector<char> isInDoubt_; ///< #bodies
};
}

void alignShapeSigns(const Mesh& mesh, const ConnectedComponents& bodies,
  std::vector<std::int8_t>& signs, const Communicator& processes)
{
  Alignment alignment(mesh, bodies, processes);
  if (alignment.count() && alignment.measure())
  {
    alignment.compareFaces();
    alignment.align(signs);
  }
}
}
