// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/ShellLayer.h"

#include "Mesh/CellShape.h"
#include "Mesh/FacesOfCells.h"
#include "Mesh/StandingCells.h"
#include "Support/Error.h"
#include "Support/UnionFind.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <tuple>

namespace morph
{
namespace
{
constexpr double Flatness = 1e-6;  // of the mesh's size: what single precision leaves
constexpr double Thin = 0.1;       // of a curved layer, so that its back does not fold in a bend
constexpr double Cancelled = 1e-6; // of the areas around a node, their sum
constexpr int Rings = 3;           // of cells, whose normals tell which way a node's is
constexpr double Alike = 0.5;      // cosine of normals that agree

Eigen::RowVector3d areaOf(const Points& points, const std::vector<Index>& corners)
{
  const auto at = [&](std::size_t k) -> Eigen::RowVector3d
  { return points.row(corners[k]) - points.row(corners[0]); };
  return corners.size() == 3 ? at(1).cross(at(2)) / 2
                             : (at(2)).cross(at(3) - at(1)) / 2; // of the diagonals
}

/// The corners of a prism's front, and the nodes on its edges if it is quadratic.
std::vector<Index> frontNodes(const Mesh& layer, Index cell)
{
  std::vector<Index> nodes = frontOf(layer, cell);
  const Index half = static_cast<Index>(nodes.size());
  const Index* middles = layer.cell(cell) + 2 * half; // behind the corners of the prism
  nodes.insert(nodes.end(), middles, middles + (layer.cellSize(cell) > 2 * half ? half : 0));
  return nodes;
}

/// The plane, if the prisms' fronts lie in one, and how thick the layer is to be. `points`: of the
/// front.
ShellLayer layerOf(const Mesh& mesh, const Points& points)
{
  Eigen::RowVector3d largest = Eigen::RowVector3d::Zero(), sum = largest;
  double length = 0;
  Index edges = 0;
  std::vector<Eigen::RowVector3d> areas;
  Eigen::AlignedBox3d box;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const std::vector<Index> corners = frontOf(mesh, c);
    if (corners.empty())
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
  // Of cells that are wound either way, most of the area decides.
  double counterclockwise = 0;
  for (const Eigen::RowVector3d& area : areas)
  {
    const double side = area.dot(largest) < 0 ? -1 : 1;
    sum += side * area;
    counterclockwise += side * area.stableNorm();
  }
  ShellLayer plane;
  plane.nodes = points.rows();
  plane.thickness = edges > 0 ? length / static_cast<double>(edges) : 0;
  if (!(sum.stableNorm() > 0))
  {
    throw Error("The input's cells are triangles and quadrilaterals without area, so there is no "
                "surface to morph.");
  }
  plane.normal = sum.stableNormalized() * (counterclockwise < 0 ? -1 : 1);
  const double size = box.diagonal().stableNorm();
  std::vector<Index> off;
  const Eigen::RowVector3d from = box.center().transpose();
  double least = 0, most = 0;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    for (const Index node : frontNodes(mesh, c))
    {
      const double height = (points.row(node) - from).dot(plane.normal);
      least = std::min(least, height);
      most = std::max(most, height);
    }
  }
  if (most - least > 2 * Flatness * size)
  {
    plane.normal.setZero(); // as ShellLayer has it
    plane.thickness *= Thin;
  }
  return plane;
}

/// A side of a cell, and whether it runs from the lower to the higher id.
struct Side
{
  Index low, high, cell;
  bool isUp;
};

/// Of each cell: others, and 1 if they are wound alike, else -1.
using Windings = std::vector<std::vector<std::pair<Index, std::int8_t>>>;

void relate(const Side& a, const Side& b, bool areFolded, Windings& windings)
{
  const std::int8_t same = (a.isUp == b.isUp) == areFolded ? 1 : -1;
  windings[a.cell].emplace_back(b.cell, same);
  windings[b.cell].emplace_back(a.cell, same);
}

/// Relates the sheets that meet at an edge, each to the one that goes on from it most smoothly.
/// Those at less than 60 degrees are folded onto each other.
void relateSheets(
  const Mesh& shell, const Points& points, const std::vector<Side>& sheets, Windings& windings)
{
  const auto low = points.row(sheets[0].low), high = points.row(sheets[0].high);
  const Eigen::RowVector3d along = (high - low).stableNormalized();
  std::vector<Eigen::RowVector3d> inward;
  for (const Side& side : sheets)
  {
    const Eigen::RowVector3d d =
      points(frontOf(shell, side.cell), allColumns).colwise().mean() - low;
    inward.push_back(Eigen::RowVector3d(d - d.dot(along) * along).stableNormalized());
  }
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs; // by the cosine but for rounding
  for (std::size_t k = 0; k < sheets.size(); ++k)
  {
    for (std::size_t i = 0; i < k; ++i)
    {
      pairs.emplace_back(std::round(1e6 * inward[i].dot(inward[k])), i, k);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  UnionFind<std::size_t> known(sheets.size());
  for (const auto& [cosine, i, k] : pairs)
  {
    if (known.root(i) != known.root(k))
    {
      known.join(i, k);
      relate(sheets[i], sheets[k], cosine > 0.5e6, windings);
    }
  }
}

/// Whether each front is wound as its neighbors, across edges of two fronts, are on the whole: 1 or
/// -1. Sheets that meet at edges of more fronts are related by one of these. Most of the area of
/// what hangs together is wound right, in a plane about its normal. `points`: of the front.
std::vector<std::int8_t> windingsOf(const Mesh& shell, const Points& points)
{
  std::vector<Side> sides;
  for (Index c = 0; c < shell.numberOfCells(); ++c)
  {
    const std::vector<Index> corners = frontOf(shell, c);
    for (std::size_t k = 0; k < corners.size(); ++k)
    {
      const auto [low, high] = std::minmax(corners[k], corners[(k + 1) % corners.size()]);
      sides.push_back({ low, high, c, corners[k] == low });
    }
  }
  std::sort(sides.begin(), sides.end(),
    [](const Side& a, const Side& b)
    { return std::tie(a.low, a.high, a.cell) < std::tie(b.low, b.high, b.cell); });
  Windings neighbors(shell.numberOfCells()), across(shell.numberOfCells());
  for (auto first = sides.begin(), last = first; first != sides.end(); first = last)
  {
    last = std::find_if(first, sides.end(),
      [&](const Side& side) { return side.low != first->low || side.high != first->high; });
    if (last - first == 2 && first->cell != first[1].cell)
    {
      relate(first[0], first[1], false, neighbors);
    }
    else if (last - first > 2 && shell.layer.isCurved())
    {
      relateSheets(shell, points, { first, last }, across);
    }
  }
  std::vector<std::int8_t> windings(shell.numberOfCells(), 0);
  std::vector<Index> part;
  const auto take = [&](Index cell, std::int8_t winding)
  {
    windings[cell] = winding;
    part.push_back(cell);
  };
  for (Index seed = 0; seed < shell.numberOfCells(); ++seed)
  {
    if (windings[seed] != 0)
    {
      continue;
    }
    part.clear();
    take(seed, 1);
    double area = 0;
    for (std::size_t i = 0, sheet = 0; i < part.size(); ++i)
    {
      const Index c = part[i];
      const std::vector<Index> corners = frontOf(shell, c);
      if (!corners.empty())
      {
        const Eigen::RowVector3d own = areaOf(points, corners);
        area +=
          windings[c] * (shell.layer.isCurved() ? own.stableNorm() : own.dot(shell.layer.normal));
      }
      for (const auto& [other, same] : neighbors[c])
      {
        const auto asked = static_cast<std::int8_t>(same * windings[c]);
        if (windings[other] == -asked && shell.layer.isCurved())
        {
          throw Error("The shell has one side alone, as a Möbius strip: no winding of its cells "
                      "agrees with all neighbors, at cell ids " +
                      listIds({ std::min(c, other), std::max(c, other) }) +
                      ". Cut it along edges there, by nodes of their own on each side.");
        }
        if (windings[other] == 0)
        {
          take(other, asked);
        }
      }
      while (i + 1 == part.size() && sheet < part.size()) // its sheets are known: to the next one
      {
        const Index from = part[sheet];
        const auto next = std::find_if(across[from].begin(), across[from].end(),
          [&](const auto& other) { return windings[other.first] == 0; });
        next == across[from].end()
          ? void(++sheet)
          : take(next->first, static_cast<std::int8_t>(next->second * windings[from]));
      }
    }
    for (const Index c : part)
    {
      windings[c] = static_cast<std::int8_t>(area < 0 ? -windings[c] : windings[c]);
    }
  }
  return windings;
}

/// Adds, at each node of the front, what its cells have: `of(cell, its nodes)`, a row.
template <typename Of>
Points sumsAround(const Mesh& layer, const Of& of)
{
  Points sums = Points::Zero(layer.layer.nodes, 3);
  for (Index c = 0; c < layer.numberOfCells(); ++c)
  {
    const std::vector<Index> nodes = frontNodes(layer, c);
    const Eigen::RowVector3d value =
      nodes.empty() ? Eigen::RowVector3d(0, 0, 0) : Eigen::RowVector3d(of(c, nodes));
    for (const Index node : nodes)
    {
      sums.row(node) += value;
    }
  }
  return sums;
}

/// The sum of the areas around each node of the front, which inside the surface does not depend on
/// the node's own place.
Points areasAround(const Mesh& layer, const Points& points)
{
  return sumsAround(layer,
    [&](Index c, const std::vector<Index>&) -> Eigen::RowVector3d
    { return areaOf(points, frontOf(layer, c)); });
}

/// The mean over the neighborhood of each node, cell by cell.
Points widened(const Mesh& layer, Points areas)
{
  for (int ring = 0; ring < Rings; ++ring)
  {
    areas = sumsAround(layer,
      [&](Index, const std::vector<Index>& nodes) -> Eigen::RowVector3d
      { return areas(nodes, allColumns).colwise().mean(); });
  }
  return areas;
}

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
                  std::to_string(cell) +
                  ". Triangles and quadrilaterals, linear or with nodes in the middle of their "
                  "edges, are morphed. Divide the others.");
    }
    this->mesh_.add(type, nodes, nodes + this->plane_.cellSize(cell));
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
                  std::to_string(this->mesh_.numberOfCells()) + ". Remove it.");
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

Mesh thicken(const Mesh& shell)
{
  validate(shell); // as cells are read by their types
  Mesh mesh;
  Layer layer(shell, mesh);
  for (Index c = 0; c < shell.numberOfCells(); ++c)
  {
    layer.add(c);
  }
  mesh.layer = layerOf(mesh, shell.points);
  const Index count = shell.numberOfNodes(), middles = static_cast<Index>(layer.middles().size());
  const std::vector<std::int8_t> windings = windingsOf(mesh, shell.points);
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
    const Points sizes = sumsAround(mesh, [&](Index c, const std::vector<Index>&)
      { return Eigen::RowVector3d(areaOf(shell.points, frontOf(mesh, c)).stableNorm(), 0, 0); });
    across = areasAround(mesh, shell.points);
    std::vector<Index> cancelled;
    for (Index node = 0; node < count; ++node)
    {
      if (sizes(node, 0) > 0 && !(across.row(node).stableNorm() > Cancelled * sizes(node, 0)))
      {
        cancelled.push_back(node);
      }
    }
    if (!cancelled.empty())
    {
      throw Error("The shell turns back on itself, so that it has no normal at node ids " +
                  listIds(cancelled) + ". Separate its sheets there, or widen the fold.");
    }
    across = normalized(std::move(across));
  }
  across *= mesh.layer.thickness;
  mesh.points.resize(2 * count + middles, 3);
  mesh.points.topRows(count) = shell.points;
  mesh.points.middleRows(count, count) = shell.points + across;
  mesh.points.bottomRows(middles) = (shell.points + across / 2)(layer.middles(), allColumns);
  return mesh;
}

bool leavesPlane(const Mesh& rest, const ConstPoints& points)
{
  const ShellLayer& layer = rest.layer;
  if (layer.nodes == 0 || layer.isCurved())
  {
    return false;
  }
  Eigen::AlignedBox3d box;
  double least = std::numeric_limits<double>::infinity(), most = -least; // of heights
  for (Index node = 0; node < layer.nodes; ++node)
  {
    if (points.row(node).allFinite()) // else it is of no cell
    {
      const double height = (points.row(node) - rest.points.row(node)).dot(layer.normal);
      least = std::min(least, height);
      most = std::max(most, height);
      box.extend(points.row(node).transpose());
    }
  }
  return most - least > 2 * Flatness * box.diagonal().stableNorm();
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

Mesh bent(Mesh mesh)
{
  mesh.layer.normal.setZero();
  Points points = mesh.points;
  placeImages(mesh, points);
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

void placeImages(const Mesh& rest, Points& moved)
{
  const Index count = rest.layer.nodes;
  if (!rest.layer.isCurved())
  {
    return;
  }
  // Where cells around a node are folded over, their sum is no normal, and the wider neighborhood
  // tells it. At a sharp bend of the undeformed shell the two differ without a fold.
  const auto bothAt = [&](const Points& points)
  {
    Points areas = areasAround(rest, points);
    Points wide = normalized(widened(rest, areas));
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

void keepInPlane(const Mesh& rest, const std::vector<Index>& ids, Points& moved)
{
  if (rest.layer.isCurved())
  {
    return placeImages(rest, moved);
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
