// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/PlaneLayer.h"

#include "Mesh/CellShape.h"
#include "Mesh/Extent.h"
#include "Support/Error.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

namespace morph
{
namespace
{
constexpr double Flatness = 1e-6; // of the mesh's size: what single precision leaves

bool isFace(const Mesh& mesh, Index cell)
{
  const CellShape* shape = cellShape(mesh.types[cell]);
  return shape && (shape->shape == Shape::Tri || shape->shape == Shape::Quadrilateral);
}

/// The corners of a triangle or quadrilateral around it.
std::vector<Index> cornersOf(const Mesh& mesh, Index cell)
{
  const CellShape& shape = *cellShape(mesh.types[cell]);
  std::vector<Index> corners;
  for (int k = 0; k < shape.numberOfCorners; ++k)
  {
    corners.push_back(mesh.cell(cell)[shape.cornerNode[k]]);
  }
  return corners;
}

Eigen::RowVector3d areaOf(const Points& points, const std::vector<Index>& corners)
{
  const auto at = [&](std::size_t k) -> Eigen::RowVector3d
  { return points.row(corners[k]) - points.row(corners[0]); };
  return corners.size() == 3 ? at(1).cross(at(2)) / 2
                             : (at(2)).cross(at(3) - at(1)) / 2; // of the diagonals
}

/// The plane, and how thick the layer is to be.
struct Plane
{
  Eigen::RowVector3d normal = Eigen::RowVector3d::Zero();
  double thickness = 0;
};

Plane planeOf(const Mesh& mesh)
{
  Eigen::RowVector3d largest = Eigen::RowVector3d::Zero(), sum = largest;
  double length = 0;
  Index edges = 0;
  std::vector<Eigen::RowVector3d> areas;
  Eigen::AlignedBox3d box;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (!isFace(mesh, c))
    {
      continue;
    }
    const std::vector<Index> corners = cornersOf(mesh, c);
    areas.push_back(areaOf(mesh.points, corners));
    if (areas.back().squaredNorm() > largest.squaredNorm())
    {
      largest = areas.back();
    }
    for (std::size_t k = 0; k < corners.size(); ++k)
    {
      const Index next = corners[(k + 1) % corners.size()];
      length += (mesh.points.row(next) - mesh.points.row(corners[k])).stableNorm();
      ++edges;
      box.extend(mesh.points.row(corners[k]).transpose());
    }
  }
  // Of cells that are wound either way, most of the area decides.
  double counterclockwise = 0;
  for (const Eigen::RowVector3d& area : areas)
  {
    const double side = area.dot(largest) < 0 ? -1 : 1;
    sum += side * area;
    counterclockwise += side * area.stableNorm();
  }
  Plane plane;
  plane.thickness = edges > 0 ? length / static_cast<double>(edges) : 0;
  if (!(sum.stableNorm() > 0))
  {
    throw Error("The input's cells are triangles and quadrilaterals without area, so there is no "
                "plane in which to morph them.");
  }
  plane.normal = sum.stableNormalized() * (counterclockwise < 0 ? -1 : 1);
  const double size = box.diagonal().stableNorm();
  std::vector<Index> off;
  const Eigen::RowVector3d from = box.center().transpose();
  double least = 0, most = 0;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    for (Index k = 0; isFace(mesh, c) && k < mesh.cellSize(c); ++k)
    {
      const double height = (mesh.points.row(mesh.cell(c)[k]) - from).dot(plane.normal);
      least = std::min(least, height);
      most = std::max(most, height);
    }
  }
  if (most - least > 2 * Flatness * size)
  {
    std::ostringstream text;
    text << "The input is a curved shell: it has triangles and quadrilaterals alone, and its nodes "
            "are up to "
         << most - least
         << " apart across its mean plane. Plane meshes and volume meshes are morphed. Give the "
            "volume mesh itself, or its boundary from Extract Morph Boundary or Classify Boundary.";
    throw Error(text.str());
  }
  return plane;
}

/// Appends the cells of a layer to a mesh.
class Layer
{
public:
  explicit Layer(const Mesh& plane, Mesh& mesh)
    : plane_(plane)
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
        return this->prism(Hexahedron, { nodes, nodes + 4 }, {});
      case Pixel:
        return this->prism(Hexahedron, { nodes[0], nodes[1], nodes[3], nodes[2] }, {});
      case QuadraticTriangle:
        return this->prism(QuadraticWedge, { nodes, nodes + 3 }, { nodes + 3, nodes + 6 });
      case QuadraticQuad:
        return this->prism(QuadraticHexahedron, { nodes, nodes + 4 }, { nodes + 4, nodes + 8 });
      case Line:
        return this->append(
          Quad, { nodes[0], nodes[1], nodes[1] + this->count_, nodes[0] + this->count_ });
      case QuadraticEdge:
        return this->append(QuadraticQuad,
          { nodes[0], nodes[1], nodes[1] + this->count_, nodes[0] + this->count_, nodes[2],
            this->middleOf(nodes[1]), nodes[2] + this->count_, this->middleOf(nodes[0]) });
      case Polygon:
        if (this->plane_.cellSize(cell) == 3 || this->plane_.cellSize(cell) == 4)
        {
          return this->prism(this->plane_.cellSize(cell) == 3 ? Wedge : Hexahedron,
            { nodes, nodes + this->plane_.cellSize(cell) }, {});
        }
        break;
      default:
        break;
    }
    const CellShape& shape = *cellShape(type);
    if (shape.dimension == 2)
    {
      throw Error("The plane mesh has a " + std::string(shape.name) + ", cell " +
                  std::to_string(cell) +
                  ". Triangles and quadrilaterals, linear or with nodes in the middle of their "
                  "edges, are morphed. Divide the others.");
    }
    this->append(type, { nodes, nodes + this->plane_.cellSize(cell) });
  }

private:
  const Mesh& plane_;
  Mesh& mesh_;
  Index count_;
  std::vector<Index> middle_, middles_;
  Index next_;

  Index middleOf(Index node)
  {
    if (this->middle_[node] < 0)
    {
      this->middle_[node] = this->next_++;
      this->middles_.push_back(node);
    }
    return this->middle_[node];
  }

  void append(std::uint8_t type, const std::vector<Index>& nodes)
  {
    this->mesh_.types.push_back(type);
    this->mesh_.connectivity.insert(this->mesh_.connectivity.end(), nodes.begin(), nodes.end());
    this->mesh_.offsets.push_back(static_cast<Index>(this->mesh_.connectivity.size()));
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
    this->append(type, nodes);
  }
};
}

Mesh thicken(const Mesh& plane)
{
  const Plane geometry = planeOf(plane);
  Mesh mesh;
  mesh.offsets = { 0 };
  Layer layer(plane, mesh);
  for (Index c = 0; c < plane.numberOfCells(); ++c)
  {
    layer.add(c);
  }
  const Index count = plane.numberOfNodes(), middles = static_cast<Index>(layer.middles().size());
  const Eigen::RowVector3d across = geometry.thickness * geometry.normal;
  mesh.points.resize(2 * count + middles, 3);
  mesh.points.topRows(count) = plane.points;
  mesh.points.middleRows(count, count) = plane.points.rowwise() + across;
  mesh.points.bottomRows(middles) =
    plane.points(layer.middles(), allColumns).rowwise() + across / 2;
  mesh.layer = { count, geometry.normal };
  return mesh;
}

double thickness(const Mesh& mesh)
{
  return mesh.layer.nodes == 0
           ? 1
           : (mesh.points.row(mesh.layer.nodes) - mesh.points.row(0)).dot(mesh.layer.normal);
}

std::vector<std::pair<Index, Index>> imagesAmong(
  const PlaneLayer& layer, const std::vector<Index>& ids)
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

void markImages(const PlaneLayer& layer, std::vector<std::uint8_t>& marks)
{
  std::copy_n(marks.begin(), layer.nodes, marks.begin() + layer.nodes);
}

void keepInPlane(const Mesh& rest, const std::vector<Index>& ids, Points& moved)
{
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
