// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/ShellLayer.h"

#include "Mesh/CellShape.h"
#include "Mesh/ShellWindings.h"
#include "Mesh/StandingCells.h"
#include "Mesh/Topology.h"
#include "Support/Error.h"
#include "Support/Lists.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

namespace morph
{
namespace
{
constexpr double Flatness = 1e-6;  // of the mesh's size: what single precision leaves
constexpr double Thin = 0.1;       // of a curved layer, so that its back does not fold in a bend
constexpr double Cancelled = 1e-6; // of the areas around a node, their sum
constexpr int Rings = 3;           // of cells, whose normals tell which way a node's is
constexpr double Alike = 0.5;      // cosine of normals that agree

/// The corners of a prism's front, and the nodes on its edges if it is quadratic.
std::vector<Index> frontNodes(const Mesh& layer, Index cell)
{
  std::vector<Index> nodes = frontOf(layer, cell);
  const Index half = static_cast<Index>(nodes.size());
  const Index* middles = layer.cell(cell) + 2 * half; // behind the corners of the prism
  nodes.insert(nodes.end(), middles, middles + (layer.cellSize(cell) > 2 * half ? half : 0));
  return nodes;
}

/// The smallest and the largest of the heights that `add` gives, of all processes.
class Heights
{
public:
  void add(double height)
  {
    this->most_[0] = std::max(this->most_[0], -height);
    this->most_[1] = std::max(this->most_[1], height);
  }
  double range(const Communicator& processes) const
  {
    std::array<double, 2> most = this->most_;
    processes.maximum(most.data(), 2);
    return most[0] + most[1];
  }

private:
  std::array<double, 2> most_ = { -std::numeric_limits<double>::infinity(),
    -std::numeric_limits<double>::infinity() };
};

/// Joins the boxes of all processes.
Eigen::AlignedBox3d joined(const Eigen::AlignedBox3d& box, const Communicator& processes)
{
  std::array<double, 6> most;
  for (int j = 0; j < 3; ++j)
  {
    most[j] = -box.min()[j];
    most[j + 3] = box.max()[j];
  }
  processes.maximum(most.data(), 6);
  return { Eigen::Vector3d(-most[0], -most[1], -most[2]),
    Eigen::Vector3d(most[3], most[4], most[5]) };
}

/// The largest of the areas of all processes.
Eigen::RowVector3d largestOf(const Eigen::RowVector3d& area, const Communicator& processes)
{
  const std::vector<double> all = processes.gather({ area[0], area[1], area[2] });
  Eigen::RowVector3d largest = Eigen::RowVector3d::Zero();
  for (std::size_t i = 0; i < all.size(); i += 3)
  {
    const Eigen::RowVector3d one(all[i], all[i + 1], all[i + 2]);
    largest = one.squaredNorm() > largest.squaredNorm() ? one : largest;
  }
  return largest;
}

/// The plane, if the prisms' fronts lie in one, and how thick the layer is to be. `points`: of the
/// front.
ShellLayer layerOf(const Mesh& mesh, const Points& points, const Communicator& processes)
{
  Eigen::RowVector3d largest = Eigen::RowVector3d::Zero(), sum = largest;
  double length = 0;
  Index edges = 0;
  std::vector<Eigen::RowVector3d> areas;
  Eigen::AlignedBox3d box;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const std::vector<Index> corners = frontOf(mesh, c);
    if (corners.empty() || processes.isCopy(c))
    {
      continue;
    }
    areas.push_back(areaOf(points, corners));
    if (areas.back().squaredNorm() > largest.squaredNorm())
    {
      largest = areas.back();
    }
    for (std::size_t k = 0; k < corners.size(); ++k)
    {
      const Index next = corners[(k + 1) % corners.size()];
      length += (points.row(next) - points.row(corners[k])).stableNorm();
      ++edges;
      box.extend(points.row(corners[k]).transpose());
    }
  }
  largest = largestOf(largest, processes);
  box = joined(box, processes);
  // Of cells that are wound either way, most of the area decides.
  double counterclockwise = 0;
  for (const Eigen::RowVector3d& area : areas)
  {
    const double side = area.dot(largest) < 0 ? -1 : 1;
    sum += side * area;
    counterclockwise += side * area.stableNorm();
  }
  processes.sum(sum.data(), 3);
  counterclockwise = processes.sum(counterclockwise);
  length = processes.sum(length);
  edges = processes.sum(edges);
  ShellLayer plane;
  plane.nodes = points.rows();
  plane.thickness = edges > 0 ? length / static_cast<double>(edges) : 0;
  if (!(sum.stableNorm() > 0))
  {
    throw Error("The input's cells are triangles and quadrilaterals without area, so there is no "
                "surface to morph.");
  }
  plane.normal = sum.stableNormalized() * (counterclockwise < 0 ? -1 : 1);
  const Eigen::RowVector3d from = box.center().transpose();
  Heights heights;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    for (const Index node : frontNodes(mesh, c))
    {
      heights.add((points.row(node) - from).dot(plane.normal));
    }
  }
  if (heights.range(processes) > 2 * Flatness * box.diagonal().stableNorm())
  {
    plane.normal.setZero(); // as ShellLayer has it
    plane.thickness *= Thin;
  }
  return plane;
}

/// The nodes of the front of a layer, with the cells around them on all processes.
class Front
{
public:
  Front(const Mesh& layer, const Communicator& processes)
    : layer_(layer)
    , processes_(processes)
    , rows_(processes.rows(consecutive(layer.layer.nodes)))
  {
  }

  /// Adds, at each node, what its cells have: `of(cell, its nodes)`, a row.
  template <typename Of>
  Points sums(const Of& of) const
  {
    Points sums = Points::Zero(this->layer_.layer.nodes, 3);
    for (Index c = 0; c < this->layer_.numberOfCells(); ++c)
    {
      const std::vector<Index> nodes = frontNodes(this->layer_, c);
      const bool counts = !nodes.empty() && !this->processes_.isCopy(c);
      const Eigen::RowVector3d value =
        counts ? Eigen::RowVector3d(of(c, nodes)) : Eigen::RowVector3d(0, 0, 0);
      for (const Index node : nodes)
      {
        sums.row(node) += value;
      }
    }
    this->rows_->add(sums);
    return sums;
  }

  /// The sum of the areas around each node, which inside the surface does not depend on the node's
  /// own place.
  Points areas(const Points& points) const
  {
    return this->sums([&](Index c, const std::vector<Index>&) -> Eigen::RowVector3d
      { return areaOf(points, frontOf(this->layer_, c)); });
  }

  /// The mean over the neighborhood of each node, cell by cell.
  Points widened(Points areas) const
  {
    for (int ring = 0; ring < Rings; ++ring)
    {
      areas = this->sums([&](Index, const std::vector<Index>& nodes) -> Eigen::RowVector3d
        { return areas(nodes, allColumns).colwise().mean(); });
    }
    return areas;
  }

private:
  const Mesh& layer_;
  const Communicator& processes_;
  std::unique_ptr<CopiedRows> rows_;
};

/// The unit normals at each node: of the areas around it, or zero where they have none.
Points normalized(Points areas)
{
  for (Index node = 0; node < areas.rows(); ++node)
  {
    const double length = areas.row(node).stableNorm();
    areas.row(node) /= length > 0 ? length : 1;
  }
  return areas;
}

/// Winds a prism the other way round.
void turnOver(Mesh& layer, Index cell)
{
  const auto half = static_cast<Index>(frontOf(layer, cell).size());
  const auto first = layer.connectivity.begin() + layer.offsets[cell];
  // Corners of front and back, and of a quadratic prism the nodes between them, front and back,
  // and between front and back.
  for (Index group = 0; (group + 1) * half <= layer.cellSize(cell); ++group)
  {
    const bool areCorners = group < 2 || group == 4;
    std::reverse(first + group * half + (areCorners ? 1 : 0), first + (group + 1) * half);
  }
}

/// Puts the nodes between front and back, which quadratic prisms have, in the middle.
void placeBetween(const Mesh& rest, Points& moved)
{
  const Index count = rest.layer.nodes;
  for (Index c = 0; c < rest.numberOfCells() && rest.numberOfNodes() > 2 * count; ++c)
  {
    // The last nodes of a quadratic prism are between its corners of front and back.
    const std::vector<Index> corners = frontOf(rest, c);
    const Index* end = rest.cell(c) + rest.cellSize(c);
    for (std::size_t k = 0;
         rest.cellSize(c) > 2 * static_cast<Index>(corners.size()) && k < corners.size(); ++k)
    {
      const Index front = corners[corners.size() - 1 - k];
      moved.row(*(end - 1 - k)) = (moved.row(front) + moved.row(front + count)) / 2;
    }
  }
}

/// Appends the cells of a layer to a mesh.
class Layer
{
public:
  explicit Layer(const Mesh& plane, const Communicator& processes, Mesh& mesh)
    : plane_(plane)
    , processes_(processes)
    , mesh_(mesh)
    , count_(plane.numberOfNodes())
    , middle_(plane.numberOfNodes(), -1)
    , next_(2 * plane.numberOfNodes())
  {
  }

  /// The nodes whose edge from front to back has a node in its middle, in the order of those.
  const std::vector<Index>& middles() const { return this->middles_; }

  void add(Index cell)
  {
    const Index* nodes = this->plane_.cell(cell);
    const std::uint8_t type = this->plane_.types[cell];
    switch (type)
    {
      case Triangle:
        return this->prism(Wedge, { nodes, nodes + 3 }, {});
      case Quad:
        return this->prismOf({ nodes, nodes + 4 });
      case Pixel:
        return this->prismOf({ nodes[0], nodes[1], nodes[3], nodes[2] });
      case QuadraticTriangle:
        return this->prism(QuadraticWedge, { nodes, nodes + 3 }, { nodes + 3, nodes + 6 });
      case QuadraticQuad:
        return this->prism(QuadraticHexahedron, { nodes, nodes + 4 }, { nodes + 4, nodes + 8 });
      case Line:
        return this->mesh_.add(
          Quad, { nodes[0], nodes[1], nodes[1] + this->count_, nodes[0] + this->count_ });
      case QuadraticEdge:
        return this->mesh_.add(QuadraticQuad,
          { nodes[0], nodes[1], nodes[1] + this->count_, nodes[0] + this->count_, nodes[2],
            this->middleOf(nodes[1]), nodes[2] + this->count_, this->middleOf(nodes[0]) });
      case Polygon:
        if (this->plane_.cellSize(cell) == 3 || this->plane_.cellSize(cell) == 4)
        {
          return this->prismOf({ nodes, nodes + this->plane_.cellSize(cell) });
        }
        break;
      default:
        break;
    }
    const CellShape& shape = *cellShape(type);
    if (shape.dimension == 2)
    {
      throw Error("The mesh of faces has a " + std::string(shape.name) + ", cell " +
                  std::to_string(this->idOf(cell)) +
                  ". Triangles and quadrilaterals, linear or with nodes in the middle of their "
                  "edges, are morphed. Divide the others.");
    }
    this->mesh_.add(type, nodes, nodes + this->plane_.cellSize(cell));
  }

private:
  const Mesh& plane_;
  const Communicator& processes_;
  Mesh& mesh_;
  Index count_;
  std::vector<Index> middle_, middles_;
  Index next_;

  Index idOf(Index cell) const { return this->processes_.idsOfCells({ cell }).front(); }

  Index middleOf(Index node)
  {
    if (this->middle_[node] < 0)
    {
      this->middle_[node] = this->next_++;
      this->middles_.push_back(node);
    }
    return this->middle_[node];
  }

  /// Of a quadrilateral, which names a corner twice if it is used as a triangle.
  void prismOf(std::vector<Index> corners)
  {
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    if (corners.size() > 3 && corners.front() == corners.back())
    {
      corners.pop_back();
    }
    if (corners.size() < 3)
    {
      throw Error("The mesh of faces has a cell with fewer than three different corners: cell " +
                  std::to_string(this->idOf(this->mesh_.numberOfCells())) + ". Remove it.");
    }
    this->prism(corners.size() == 3 ? Wedge : Hexahedron, corners, {});
  }

  void prism(
    std::uint8_t type, const std::vector<Index>& corners, const std::vector<Index>& middles)
  {
    std::vector<Index> nodes;
    for (const std::vector<Index>* ids : { &corners, &middles })
    {
      nodes.insert(nodes.end(), ids->begin(), ids->end());
      std::transform(ids->begin(), ids->end(), std::back_inserter(nodes),
        [this](Index node) { return node + this->count_; });
    }
    if (!middles.empty())
    {
      std::transform(corners.begin(), corners.end(), std::back_inserter(nodes),
        [this](Index node) { return this->middleOf(node); });
    }
    this->mesh_.add(type, nodes.begin(), nodes.end());
  }
};
}

Mesh thicken(const Mesh& shell, const Communicator& processes)
{
  Mesh mesh;
  Layer layer(shell, processes, mesh);
  processes.together(
    [&]
    {
      validate(shell); // as cells are read by their types
      for (Index c = 0; c < shell.numberOfCells(); ++c)
      {
        layer.add(c);
      }
    });
  mesh.layer = layerOf(mesh, shell.points, processes);
  const Index count = shell.numberOfNodes(), middles = static_cast<Index>(layer.middles().size());
  const std::vector<std::int8_t> windings = windingsOf(mesh, shell.points, processes);
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (windings[c] < 0)
    {
      turnOver(mesh, c);
    }
  }
  Points across = mesh.layer.normal.replicate(count, 1);
  if (mesh.layer.isCurved())
  {
    const Front front(mesh, processes);
    const Points sizes = front.sums([&](Index c, const std::vector<Index>&)
      { return Eigen::RowVector3d(areaOf(shell.points, frontOf(mesh, c)).stableNorm(), 0, 0); });
    across = front.areas(shell.points);
    std::vector<Index> cancelled;
    for (Index node = 0; node < count; ++node)
    {
      if (sizes(node, 0) > 0 && !(across.row(node).stableNorm() > Cancelled * sizes(node, 0)))
      {
        cancelled.push_back(node);
      }
    }
    processes.together(
      [&]
      {
        if (!cancelled.empty())
        {
          throw Error("The shell turns back on itself, so that it has no normal at node ids " +
                      listIds(processes.idsOf(cancelled)) +
                      ". Separate its sheets there, or widen the fold.");
        }
      });
    across = normalized(std::move(across));
  }
  across *= mesh.layer.thickness;
  mesh.points.resize(2 * count + middles, 3);
  mesh.points.topRows(count) = shell.points;
  mesh.points.middleRows(count, count) = shell.points + across;
  mesh.points.bottomRows(middles) = (shell.points + across / 2)(layer.middles(), allColumns);
  return mesh;
}

bool leavesPlane(const Mesh& rest, const ConstPoints& points, const Communicator& processes)
{
  const ShellLayer& layer = rest.layer;
  if (layer.nodes == 0 || layer.isCurved())
  {
    return false;
  }
  Eigen::AlignedBox3d box;
  Heights heights;
  for (Index node = 0; node < layer.nodes; ++node)
  {
    if (points.row(node).allFinite()) // else it is of no cell
    {
      heights.add((points.row(node) - rest.points.row(node)).dot(layer.normal));
      box.extend(points.row(node).transpose());
    }
  }
  return heights.range(processes) > 2 * Flatness * joined(box, processes).diagonal().stableNorm();
}

void requireRegion(const Mesh& mesh)
{
  if (mesh.layer.isCurved())
  {
    throw Error("The simplex methods tessellate the region between the prescribed nodes, and a "
                "curved shell encloses none. Use FEMWARP, LBWARP, weighted residual or radial "
                "basis.");
  }
}

Mesh bent(Mesh mesh, const Communicator& processes)
{
  mesh.layer.normal.setZero();
  Points points = mesh.points;
  placeImages(mesh, points, processes);
  mesh.points.swap(points);
  return mesh;
}

BoundaryFaces frontFaces(const Mesh& mesh)
{
  std::vector<std::pair<Index, int>> places;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const CellShape& shape = *cellShape(mesh.types[c]);
    const auto isFront = [&](int side)
    {
      const FaceShape& face = shape.faces[side];
      return std::all_of(face.corner, face.corner + face.size,
        [&](int node) { return mesh.cell(c)[node] < mesh.layer.nodes; });
    };
    for (int side = 0; side < shape.numberOfFaces; ++side)
    {
      if (isFront(side))
      {
        places.emplace_back(c, side);
      }
    }
  }
  return facesAt(mesh, places);
}

void placeImages(const Mesh& rest, Points& moved, const Communicator& processes)
{
  const Index count = rest.layer.nodes;
  if (!rest.layer.isCurved())
  {
    return;
  }
  const Front front(rest, processes);
  // Where cells around a node are folded over, their sum is no normal, and the wider neighborhood
  // tells it. At a sharp bend of the undeformed shell the two differ without a fold.
  const auto bothAt = [&](const Points& points)
  {
    Points areas = front.areas(points);
    Points wide = normalized(front.widened(areas));
    return std::make_pair(normalized(std::move(areas)), std::move(wide));
  };
  const auto atRest = bothAt(rest.points);
  auto [normals, wide] = bothAt(moved);
  for (Index node = 0; node < count; ++node)
  {
    const bool isFolded = normals.row(node).dot(wide.row(node)) < Alike &&
                          atRest.first.row(node).dot(atRest.second.row(node)) >= Alike;
    if (isFolded)
    {
      normals.row(node) = wide.row(node);
    }
  }
  moved.middleRows(count, count) = moved.topRows(count) + rest.layer.thickness * normals;
  placeBetween(rest, moved);
}

Points layerBehind(const Mesh& rest, const ConstPoints& front)
{
  const Index count = rest.layer.nodes;
  Points points = rest.points;
  points.topRows(count) = front;
  points.middleRows(count, count) =
    front.rowwise() + Eigen::RowVector3d(rest.layer.thickness * rest.layer.normal);
  placeBetween(rest, points);
  if (leavesPlane(rest, points))
  {
    placeImages(bent(rest), points);
  }
  placeImages(rest, points);
  return points;
}

std::vector<std::pair<Index, Index>> imagesAmong(
  const ShellLayer& layer, const std::vector<Index>& ids)
{
  std::vector<std::pair<Index, Index>> images;
  auto back = std::lower_bound(ids.begin(), ids.end(), layer.nodes);
  for (auto front = ids.begin(); front != ids.end() && *front < layer.nodes; ++front)
  {
    back = std::lower_bound(back, ids.end(), *front + layer.nodes);
    if (back != ids.end() && *back == *front + layer.nodes)
    {
      images.emplace_back(front - ids.begin(), back - ids.begin());
    }
  }
  return images;
}

std::vector<std::pair<Index, Index>> curvedImages(
  const ShellLayer& layer, const std::vector<Index>& ids)
{
  return layer.isCurved() ? imagesAmong(layer, ids) : std::vector<std::pair<Index, Index>>();
}

void markImages(const ShellLayer& layer, std::vector<std::uint8_t>& marks)
{
  std::copy_n(marks.begin(), layer.nodes, marks.begin() + layer.nodes);
}

void keepInPlane(
  const Mesh& rest, const std::vector<Index>& ids, Points& moved, const Communicator& processes)
{
  if (rest.layer.isCurved())
  {
    return placeImages(rest, moved, processes);
  }
  for (const auto& [k, l] : imagesAmong(rest.layer, ids))
  {
    auto front = moved.row(ids[k]), back = moved.row(ids[l]);
    const auto from = rest.points.row(ids[k]);
    const Eigen::RowVector3d across = rest.points.row(ids[l]) - from;
    const Eigen::RowVector3d apart = back - front - across;
    front += apart / 2;
    front -= (front - from).dot(rest.layer.normal) * rest.layer.normal;
    back = front + across;
  }
}
}
