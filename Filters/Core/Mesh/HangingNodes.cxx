// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/HangingNodes.h"

#include "Mesh/CellShape.h"
#include "Mesh/FacesOfCells.h"
#include "Mesh/HigherOrderNodes.h"
#include "Mesh/Polyhedra.h"
#include "Support/Buckets.h"
#include "Support/Parallel.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>
#include <tuple>

namespace morph
{
namespace
{
constexpr Index FaceGrain = 256;
/// Of a face's size: how far a node may be off it, and a vector area off that of the small faces.
constexpr double OnFace = 1e-6;
constexpr int MostNodes = 9; // of a face

/// The shape functions of a face at a place, in the order of its nodes, and their derivatives.
struct FaceFunctions
{
  std::array<double, MostNodes> N = {};
  std::array<double, MostNodes> dU = {}, dV = {};
};

/// Of a triangle of 3 or 6 nodes at (u, v), where its corners are at (0, 0), (1, 0) and (0, 1).
FaceFunctions triangleFunctions(int nodes, double u, double v)
{
  FaceFunctions f;
  const double L[] = { 1 - u - v, u, v };
  constexpr double dU[] = { -1, 1, 0 }, dV[] = { -1, 0, 1 };
  for (int a = 0; a < 3; ++a)
  {
    const int b = (a + 1) % 3;
    const bool isLinear = nodes == 3;
    const double slope = isLinear ? 1 : 4 * L[a] - 1;
    f.N[a] = isLinear ? L[a] : L[a] * (2 * L[a] - 1);
    f.dU[a] = slope * dU[a];
    f.dV[a] = slope * dV[a];
    if (!isLinear)
    {
      f.N[3 + a] = 4 * L[a] * L[b];
      f.dU[3 + a] = 4 * (dU[a] * L[b] + L[a] * dU[b]);
      f.dV[3 + a] = 4 * (dV[a] * L[b] + L[a] * dV[b]);
    }
  }
  return f;
}

/// Of a quadrilateral of 4, 8 or 9 nodes at (u, v) in the unit square. Eight are those of nine
/// without the bubble: its share goes to corners, by -1/4, and to the middles of sides, by 1/2.
FaceFunctions quadrilateralFunctions(int nodes, double u, double v)
{
  const auto along = [nodes](double t, std::array<double, 3>& N, std::array<double, 3>& d)
  {
    N = nodes == 4
          ? std::array<double, 3>{ 1 - t, 0, t }
          : std::array<double, 3>{ (1 - t) * (1 - 2 * t), 4 * t * (1 - t), t * (2 * t - 1) };
    d = nodes == 4 ? std::array<double, 3>{ -1, 0, 1 }
                   : std::array<double, 3>{ 4 * t - 3, 4 - 8 * t, 4 * t - 1 };
  };
  constexpr int at[MostNodes][2] = { { 0, 0 }, { 2, 0 }, { 2, 2 }, { 0, 2 }, { 1, 0 }, { 2, 1 },
    { 1, 2 }, { 0, 1 }, { 1, 1 } };
  std::array<double, 3> U, V, dU, dV;
  along(u, U, dU);
  along(v, V, dV);
  FaceFunctions f;
  for (int a = 0; a < MostNodes; ++a)
  {
    const auto [i, j] = at[a];
    f.N[a] = U[i] * V[j];
    f.dU[a] = dU[i] * V[j];
    f.dV[a] = U[i] * dV[j];
  }
  for (int a = 0; nodes == 8 && a < 8; ++a)
  {
    const double share = a < 4 ? -0.25 : 0.5;
    f.N[a] += share * f.N[8];
    f.dU[a] += share * f.dU[8];
    f.dV[a] += share * f.dV[8];
  }
  return f;
}

/// A place on a face, and the weights of its nodes there.
struct PlaceOnFace
{
  double u, v;
  std::array<double, MostNodes> N;
};

/// The nodes of each face: its corners, then the middles of its sides, then its own middle. None of
/// a face whose shape functions are not known here.
Adjacency nodesOfFaces(const Mesh& mesh, const BoundaryFaces& faces)
{
  Adjacency result;
  result.offsets = { 0 };
  for (std::size_t f = 0; f < faces.cells.size(); ++f)
  {
    const Index cell = faces.cells[f];
    const CellShape& shape = *cellShape(mesh, cell);
    const Index* corners = faces.connectivity.data() + faces.offsets[f];
    const Index size = faces.offsets[f + 1] - faces.offsets[f];
    std::vector<Index> nodes(corners, corners + size), middles(size, -1), center;
    const Index last = shape.shape == Shape::Polyhedron ? 0 : shape.numberOfNodes;
    for (int k = shape.numberOfCorners; k < last; ++k)
    {
      double N[8];
      shapeFunctions(shape.shape, shape.extraNodes[k - shape.numberOfCorners], N, nullptr);
      std::vector<Index> between;
      bool isOn = true;
      for (int a = 0; a < shape.numberOfCorners; ++a)
      {
        const Index node = mesh.cell(cell)[shape.cornerNode[a]];
        const Index place = std::find(corners, corners + size, node) - corners;
        if (N[a] != 0)
        {
          isOn = isOn && place < size;
          between.push_back(place);
        }
      }
      if (isOn && between.size() == 2)
      {
        std::sort(between.begin(), between.end());
        const bool isLast = between[0] == 0 && between[1] == size - 1;
        middles[isLast ? size - 1 : between[0]] = mesh.cell(cell)[k];
      }
      else if (isOn)
      {
        center.push_back(mesh.cell(cell)[k]);
      }
    }
    const auto count =
      std::count_if(middles.begin(), middles.end(), [](Index node) { return node >= 0; });
    const bool isLinear = count == 0 && center.empty();
    const bool isQuadratic = count == size && (center.empty() || (size == 4 && center.size() == 1));
    const bool isKnown = shape.shape != Shape::Polyhedron && (size == 3 || size == 4) &&
                         mesh.types[cell] < LagrangeCurve && (isLinear || isQuadratic);
    if (isKnown)
    {
      result.values.insert(result.values.end(), nodes.begin(), nodes.end());
    }
    if (isKnown && isQuadratic)
    {
      result.values.insert(result.values.end(), middles.begin(), middles.end());
      result.values.insert(result.values.end(), center.begin(), center.end());
    }
    result.offsets.push_back(static_cast<Index>(result.values.size()));
  }
  return result;
}

/// Finds the small faces in a large one.
class DividedFaces
{
public:
  DividedFaces(const Mesh& mesh, const BoundaryFaces& faces, Monitor& monitor)
    : mesh_(mesh)
    , faces_(faces)
    , nodes_(nodesOfFaces(mesh, faces))
    , area_(static_cast<Index>(faces.cells.size()), 3)
  {
    this->isFolded_.resize(this->area_.rows());
    parallel(this->area_.rows(), monitor,
      [&](Index f)
      {
        this->area_.row(f) = this->areaOf(f);
        this->isFolded_[f] = this->isFolded(f);
      });
    this->ofNode_ = sortIntoBuckets(this->area_.rows(), mesh.numberOfNodes(), monitor,
      [&](Index first, Index last, const auto& add)
      {
        for (Index f = first; f < last; ++f)
        {
          std::for_each(this->begin(f), this->end(f), [&](Index node) { add(node, f); });
        }
      });
  }

  /// The nodes of a face, corners first.
  const Index* begin(Index f) const { return this->nodes_.begin(f); }
  const Index* end(Index f) const { return this->nodes_.end(f); }
  Index size(Index f) const { return this->end(f) - this->begin(f); }
  Index corners(Index f) const { return this->faces_.offsets[f + 1] - this->faces_.offsets[f]; }
  bool has(Index f, Index node) const
  {
    return std::find(this->begin(f), this->end(f), node) != this->end(f);
  }
  bool isCorner(Index f, Index node) const
  {
    const Index* last = this->begin(f) + std::min(this->corners(f), this->size(f));
    return std::find(this->begin(f), last, node) != last;
  }

  /// Whether other faces lie in `f` at each of its corners, as where it is divided.
  bool hasPartsAtCorners(Index f) const
  {
    return this->size(f) > 0 &&
           std::all_of(this->begin(f), this->begin(f) + this->corners(f),
             [&](Index corner)
             {
               return std::any_of(this->ofNode_.begin(corner), this->ofNode_.end(corner),
                 [&](Index g) { return this->isCorner(g, corner) && this->isPart(g, f); });
             });
  }

  /// Returns the faces that lie in `f` and fill it, ascending; none if there are no such.
  std::vector<Index> parts(Index f) const
  {
    std::vector<Index> found;
    if (!this->hasPartsAtCorners(f))
    {
      return found;
    }
    const auto addAround = [&](Index node)
    {
      std::for_each(this->ofNode_.begin(node), this->ofNode_.end(node),
        [&](Index g)
        {
          if (this->isPart(g, f) && std::find(found.begin(), found.end(), g) == found.end())
          {
            found.push_back(g);
          }
        });
    };
    std::for_each(this->begin(f), this->end(f), addAround);
    for (std::size_t i = 0; i < found.size(); ++i)
    {
      const Index part = found[i];
      std::for_each(this->begin(part), this->end(part), addAround);
    }
    // Surfaces with the same rim have the same vector area.
    Eigen::RowVector3d rest = this->area_.row(f);
    for (const Index part : found)
    {
      rest += this->area_.row(part);
    }
    if (rest.norm() > OnFace * this->magnitudeOf(f))
    {
      found.clear();
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  /// Returns where on `f` a place is, and the weights of its nodes there; nothing off it. Steps start
  /// at the nearest node. A face that is folded may pass a place twice: of what steps from each node
  /// lead to a corner comes first, then a side.
  std::optional<PlaceOnFace> placeOn(Index f, const Eigen::RowVector3d& x) const
  {
    std::optional<PlaceOnFace> found;
    const auto zeros = [](const PlaceOnFace& at)
    { return std::count(at.N.begin(), at.N.end(), 0); };
    const Index* nearest = std::min_element(this->begin(f), this->end(f),
      [&](Index a, Index b)
      {
        return (this->mesh_.points.row(a) - x).squaredNorm() <
               (this->mesh_.points.row(b) - x).squaredNorm();
      });
    const Index first = nearest - this->begin(f);
    for (Index i = 0; i < (this->isFolded_[f] ? this->size(f) : 1); ++i)
    {
      const auto at = this->placeFrom((first + i) % this->size(f), f, x);
      if (at && (!found || zeros(*at) > zeros(*found)))
      {
        found = at;
      }
    }
    return found;
  }

  /// The ends of the side of `f` that a place is on, by their numbers in it, and how far it is from
  /// the first; nothing inside the face and at its corners.
  std::optional<std::tuple<Index, Index, double>> sideOf(Index f, const PlaceOnFace& at) const
  {
    const double w = 1 - at.u - at.v;
    const bool isTriangle = this->corners(f) == 3;
    const auto inner = [](double t) { return t > 0 && t < 1; };
    using Side = std::tuple<Index, Index, double>;
    if (at.v == 0 && inner(at.u))
    {
      return Side{ 0, 1, at.u };
    }
    if (at.u == 0 && inner(at.v))
    {
      return Side{ 0, isTriangle ? 2 : 3, at.v };
    }
    if (isTriangle && w == 0 && inner(at.v))
    {
      return Side{ 1, 2, at.v };
    }
    if (!isTriangle && at.u == 1 && inner(at.v))
    {
      return Side{ 1, 2, at.v };
    }
    if (!isTriangle && at.v == 1 && inner(at.u))
    {
      return Side{ 3, 2, at.u };
    }
    return std::nullopt;
  }

private:
  FaceFunctions functions(Index f, double u, double v) const
  {
    const auto nodes = static_cast<int>(this->size(f));
    return this->corners(f) == 3 ? triangleFunctions(nodes, u, v)
                                 : quadrilateralFunctions(nodes, u, v);
  }
  /// The sum of the nodes' places, relative to the first, by weights.
  Eigen::Vector3d sum(Index f, const std::array<double, MostNodes>& weights) const
  {
    Eigen::Vector3d result = Eigen::Vector3d::Zero();
    for (Index a = 0; a < this->size(f); ++a)
    {
      result += weights[a] * (this->place(f, a) - this->place(f, 0)).transpose();
    }
    return result;
  }
  /// The parameters of a node of `f`.
  std::pair<double, double> placeOf(Index node, Index f) const
  {
    constexpr std::pair<double, double> OfTriangle[] = { { 0, 0 }, { 1, 0 }, { 0, 1 }, { 0.5, 0 },
      { 0.5, 0.5 }, { 0, 0.5 } };
    constexpr std::pair<double, double> OfQuadrilateral[] = { { 0, 0 }, { 1, 0 }, { 1, 1 },
      { 0, 1 }, { 0.5, 0 }, { 1, 0.5 }, { 0.5, 1 }, { 0, 0.5 }, { 0.5, 0.5 } };
    return this->corners(f) == 3 ? OfTriangle[node] : OfQuadrilateral[node];
  }
  /// Whether a part of `f` at one of its nodes faces another way than the whole.
  bool isFolded(Index f) const
  {
    for (Index node = 0; node < this->size(f); ++node)
    {
      const auto [u, v] = this->placeOf(node, f);
      const FaceFunctions at = this->functions(f, u, v);
      const Eigen::Vector3d normal = this->sum(f, at.dU).cross(this->sum(f, at.dV));
      if (this->area_.row(f).dot(normal) < 0)
      {
        return true;
      }
    }
    return false;
  }
  /// The place that steps from a node of `f` lead to.
  std::optional<PlaceOnFace> placeFrom(Index start, Index f, const Eigen::RowVector3d& x) const
  {
    const bool isTriangle = this->corners(f) == 3;
    constexpr int Steps = 20; // of Gauss and Newton; one for a flat parallelogram
    const Eigen::RowVector3d origin = this->place(f, 0);
    const Eigen::Vector3d wanted = (x - origin).transpose();
    auto [u, v] = this->placeOf(start, f);
    for (int step = 0; step < Steps; ++step)
    {
      const FaceFunctions at = this->functions(f, u, v);
      Eigen::Matrix<double, 3, 2> tangents;
      tangents << this->sum(f, at.dU), this->sum(f, at.dV);
      const Eigen::Vector2d change =
        tangents.colPivHouseholderQr().solve(wanted - this->sum(f, at.N));
      u += change[0];
      v += change[1];
      if (!(change.norm() > 1e-15))
      {
        break;
      }
    }
    const double off = (wanted - this->sum(f, this->functions(f, u, v).N)).norm();
    for (double* value : { &u, &v })
    {
      *value = std::abs(*value) < OnFace ? 0 : std::abs(*value - 1) < OnFace ? 1 : *value;
    }
    const bool isOnSlope = isTriangle && std::abs(1 - u - v) < OnFace;
    v = isOnSlope ? 1 - u : v;
    const bool isInside = u >= 0 && v >= 0 && u <= 1 && v <= 1 && (!isTriangle || 1 - u - v >= 0);
    if (!isInside || !(off <= OnFace * std::sqrt(this->magnitudeOf(f))))
    {
      return std::nullopt;
    }
    PlaceOnFace result = { u, v, this->functions(f, u, v).N };
    for (double& weight : result.N)
    {
      // Of nodes on other sides: zero but for rounding.
      weight = std::abs(weight) < 1e-15 ? 0 : weight;
    }
    return result;
  }
  Eigen::RowVector3d place(Index f, Index node) const
  {
    return this->mesh_.points.row(this->begin(f)[node]);
  }
  /// The vector area, outward: half the integral of x times dx along the rim. A side through its
  /// middle m is a parabola, for which that of a to b is (4 a x m + 4 m x b - a x b) / 6.
  Eigen::RowVector3d areaOf(Index f) const
  {
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    const Index corners = this->corners(f);
    for (Index k = 0; k<corners&& this->size(f)> 0; ++k)
    {
      const Eigen::RowVector3d a = this->place(f, k) - this->place(f, 0);
      const Eigen::RowVector3d b = this->place(f, (k + 1) % corners) - this->place(f, 0);
      if (this->size(f) == corners)
      {
        sum += a.cross(b) / 2;
        continue;
      }
      const Eigen::RowVector3d m = this->place(f, corners + k) - this->place(f, 0);
      sum += (4 * a.cross(m) + 4 * m.cross(b) - a.cross(b)) / 6;
    }
    return sum;
  }
  /// The area between the corners, also of a face that folds over.
  double magnitudeOf(Index f) const
  {
    double sum = 0;
    for (Index k = 2; k < this->corners(f); ++k)
    {
      const Eigen::RowVector3d a = this->place(f, k - 1) - this->place(f, 0);
      const Eigen::RowVector3d b = this->place(f, k) - this->place(f, 0);
      sum += a.cross(b).norm() / 2;
    }
    return sum;
  }
  /// Whether `g` lies in `f`, on its other side: it runs backward in the parameters of `f`.
  bool isPart(Index g, Index f) const
  {
    const bool isAgainst = this->isFolded_[f] || this->area_.row(g).dot(this->area_.row(f)) < 0;
    if (!isAgainst || this->faces_.cells[g] == this->faces_.cells[f] || !this->mayReach(f, g))
    {
      return false;
    }
    std::vector<PlaceOnFace> places;
    for (const Index* node = this->begin(g); node != this->end(g); ++node)
    {
      const auto at = this->placeOn(f, this->mesh_.points.row(*node));
      if (!at)
      {
        return false;
      }
      places.push_back(*at);
    }
    double area = 0; // in the parameters, twice
    const auto corners = static_cast<std::size_t>(this->corners(g));
    for (std::size_t k = 0; k < corners && !places.empty(); ++k)
    {
      const PlaceOnFace &one = places[k], &next = places[(k + 1) % corners];
      area += one.u * next.v - next.u * one.v;
    }
    const double all = this->corners(f) == 3 ? 1 : 2;
    return area < 0 && -area < (1 - OnFace) * all;
  }
  /// Whether all nodes of `g` are in the box of `f`, and so may lie on it. A side through its middle
  /// leaves the box of the three by less than a quarter of the box's size.
  bool mayReach(Index f, Index g) const
  {
    Eigen::AlignedBox3d box;
    for (Index a = 0; a < this->size(f); ++a)
    {
      box.extend(this->place(f, a).transpose());
    }
    const double margin = this->size(f) == this->corners(f) ? OnFace : 0.25;
    const Eigen::Vector3d more = Eigen::Vector3d::Constant(margin * box.sizes().maxCoeff());
    box = { box.min() - more, box.max() + more };
    return std::all_of(this->begin(g), this->end(g),
      [&](Index node) { return box.contains(this->mesh_.points.row(node).transpose()); });
  }

  const Mesh& mesh_;
  const BoundaryFaces& faces_;
  Adjacency nodes_;
  Points area_;
  std::vector<std::uint8_t> isFolded_;
  Adjacency ofNode_;
};

/// The nodes on edges, whose ends ascend, and how far they are from the first end, in its lengths.
using NodesOnEdges = std::map<std::pair<Index, Index>, std::map<Index, double>>;

/// Adds nodes on a part of an edge to the edge, and those of an edge to its parts: each may have
/// been found at another face.
void complete(NodesOnEdges& onEdge)
{
  for (bool isChanged = true; isChanged;)
  {
    isChanged = false;
    const NodesOnEdges before = onEdge;
    for (const auto& [edge, nodes] : before)
    {
      std::vector<std::pair<double, Index>> chain = { { 0, edge.first }, { 1, edge.second } };
      for (const auto& [node, at] : nodes)
      {
        chain.emplace_back(at, node);
      }
      std::sort(chain.begin(), chain.end());
      const std::size_t count = chain.size();
      for (std::size_t i = 0; i < count; ++i)
      {
        for (std::size_t j = i + 1; j < count && j - i + 1 < count; ++j)
        {
          const auto [from, first] = chain[i];
          const auto [to, last] = chain[j];
          const bool isReversed = first > last;
          const auto part = std::minmax(first, last);
          for (std::size_t k = i + 1; k < j; ++k)
          {
            const double at = (chain[k].first - from) / (to - from);
            isChanged |= onEdge[part].emplace(chain[k].second, isReversed ? 1 - at : at).second;
          }
          const auto found = before.find(part);
          if (found != before.end())
          {
            for (const auto& [node, at] : found->second)
            {
              const double along = from + (isReversed ? 1 - at : at) * (to - from);
              isChanged |= onEdge[edge].emplace(node, along).second;
            }
          }
        }
      }
    }
  }
}

/// What a node is tied to, and by what weights.
using Tie = std::map<Index, double>;

/// Replaces nodes in ties that are tied themselves.
void resolve(std::map<Index, Tie>& ties)
{
  constexpr int MostLevels = 64; // each at most half as large
  bool isResolved = false;
  for (int level = 0; level < MostLevels && !isResolved; ++level)
  {
    isResolved = true;
    for (auto& [node, tie] : ties)
    {
      Tie flat;
      for (const auto& [master, weight] : tie)
      {
        const auto other = ties.find(master);
        if (other == ties.end())
        {
          flat[master] += weight;
          continue;
        }
        isResolved = false;
        for (const auto& [above, share] : other->second)
        {
          flat[above] += weight * share;
        }
      }
      tie = std::move(flat);
    }
  }
}
}

void HangingNodes::find(const Mesh& mesh, const BoundaryFaces& faces, Monitor& monitor)
{
  *this = HangingNodes();
  const Index count = static_cast<Index>(faces.cells.size());
  if (hasPolyhedra(mesh))
  {
    return;
  }
  const DividedFaces divided(mesh, faces, monitor);
  std::vector<std::vector<Index>> parts(count);
  parallel(count, FaceGrain, monitor, [&](Index f) { parts[f] = divided.parts(f); });
  monitor.check();

  std::map<Index, Tie> ties;
  NodesOnEdges onEdge;
  for (Index f = 0; f < count; ++f)
  {
    if (parts[f].empty())
    {
      continue;
    }
    this->inside_.emplace(faces.cells[f], faces.sides[f]);
    std::vector<Polygon>& cover = this->covers_[{ faces.cells[f], faces.sides[f] }];
    for (const Index part : parts[f])
    {
      this->inside_.emplace(faces.cells[part], faces.sides[part]);
      const Index* corners = divided.begin(part);
      cover.emplace_back(corners, corners + divided.corners(part));
      std::reverse(cover.back().begin(), cover.back().end());
      for (const Index* node = corners; node != divided.end(part); ++node)
      {
        if (divided.isCorner(f, *node))
        {
          continue;
        }
        const auto at = divided.placeOn(f, mesh.points.row(*node));
        if (const auto side = at ? divided.sideOf(f, *at) : std::nullopt;
            side && divided.isCorner(part, *node))
        {
          const auto& [from, to, along] = *side;
          const Index first = divided.begin(f)[from], last = divided.begin(f)[to];
          onEdge[std::minmax(first, last)].emplace(*node, first < last ? along : 1 - along);
        }
        if (divided.has(f, *node))
        {
          continue;
        }
        Tie tie;
        for (Index k = 0; k < divided.size(f); ++k)
        {
          if (at->N[k] != 0)
          {
            tie[divided.begin(f)[k]] = at->N[k];
          }
        }
        // On an edge of one face and inside another, the edge is what all sides have.
        const auto [known, isNew] = ties.try_emplace(*node, tie);
        if (!isNew && tie.size() < known->second.size())
        {
          known->second = std::move(tie);
        }
      }
    }
  }
  complete(onEdge);
  for (const auto& [edge, nodes] : onEdge)
  {
    std::vector<std::pair<double, Index>> sorted;
    for (const auto& [node, at] : nodes)
    {
      sorted.emplace_back(at, node);
    }
    std::sort(sorted.begin(), sorted.end());
    for (const auto& [at, node] : sorted)
    {
      this->onEdge_[edge].push_back(node);
    }
  }
  resolve(ties);
  this->take(ties, mesh.numberOfNodes());
}

void HangingNodes::take(const std::map<Index, std::map<Index, double>>& ties, Index nodes)
{
  this->ids_.clear();
  std::vector<Eigen::Triplet<double, int>> entries;
  for (const auto& [node, tie] : ties)
  {
    for (const auto& [master, weight] : tie)
    {
      entries.emplace_back(static_cast<int>(this->ids_.size()), static_cast<int>(master), weight);
    }
    this->ids_.push_back(node);
  }
  this->weights_.resize(static_cast<Index>(this->ids_.size()), nodes);
  this->weights_.setFromTriplets(entries.begin(), entries.end());
}

std::map<Index, std::map<Index, double>> HangingNodes::ties() const
{
  std::map<Index, Tie> result;
  for (std::size_t i = 0; i < this->ids_.size(); ++i)
  {
    for (Weights::InnerIterator at(this->weights_, static_cast<Index>(i)); at; ++at)
    {
      result[this->ids_[i]][at.col()] = at.value();
    }
  }
  return result;
}

bool HangingNodes::mayBeAmong(const Mesh& mesh, const BoundaryFaces& faces,
  const std::vector<std::uint8_t>& isOf, Monitor& monitor)
{
  const DividedFaces divided(mesh, faces, monitor);
  std::vector<std::uint8_t> isDivided(faces.cells.size(), 0);
  parallel(static_cast<Index>(isDivided.size()), FaceGrain, monitor,
    [&](Index f) { isDivided[f] = isOf[faces.cells[f]] != 0 && divided.hasPartsAtCorners(f); });
  monitor.check();
  return std::find(isDivided.begin(), isDivided.end(), 1) != isDivided.end();
}

HangingNodes HangingNodes::following(const HigherOrderNodes& followers) const
{
  std::map<Index, Tie> ties = this->ties();
  std::vector<Index> open = this->ids_, added;
  while (!open.empty())
  {
    const Tie tie = ties.at(open.back());
    open.pop_back();
    for (const auto& [master, weight] : tie)
    {
      Tie own = followers.weightsOf(master);
      if (!own.empty() && ties.emplace(master, std::move(own)).second)
      {
        open.push_back(master);
        added.push_back(master);
      }
    }
  }
  resolve(ties);
  for (const Index follower : added)
  {
    ties.erase(follower);
  }
  HangingNodes result = *this;
  result.take(ties, this->weights_.cols());
  return result;
}

HangingNodes HangingNodes::renumbered(
  const std::vector<Index>& nodeOf, const std::vector<Index>& cellOf, Index nodes) const
{
  const auto areKnown = [&](const auto& ids)
  { return std::all_of(ids.begin(), ids.end(), [&](Index id) { return nodeOf[id] >= 0; }); };
  const auto rename = [&](std::vector<Index> ids)
  {
    std::transform(ids.begin(), ids.end(), ids.begin(), [&](Index id) { return nodeOf[id]; });
    return ids;
  };
  HangingNodes result;
  for (const auto& [cell, side] : this->inside_)
  {
    if (cellOf[cell] >= 0)
    {
      result.inside_.emplace(cellOf[cell], side);
    }
  }
  for (const auto& [place, cover] : this->covers_)
  {
    if (cellOf[place.first] >= 0 && std::all_of(cover.begin(), cover.end(), areKnown))
    {
      std::vector<Polygon>& own = result.covers_[{ cellOf[place.first], place.second }];
      std::transform(cover.begin(), cover.end(), std::back_inserter(own), rename);
    }
  }
  for (const auto& [edge, own] : this->onEdge_)
  {
    const Index first = nodeOf[edge.first], last = nodeOf[edge.second];
    if (first >= 0 && last >= 0 && areKnown(own))
    {
      std::vector<Index>& between = result.onEdge_[std::minmax(first, last)] = rename(own);
      if (first > last)
      {
        std::reverse(between.begin(), between.end());
      }
    }
  }
  std::map<Index, Tie> ties;
  for (const auto& [node, tie] : this->ties())
  {
    const auto isKnown = [&](const auto& master) { return nodeOf[master.first] >= 0; };
    if (nodeOf[node] >= 0 && std::all_of(tie.begin(), tie.end(), isKnown))
    {
      for (const auto& [master, weight] : tie)
      {
        ties[nodeOf[node]][nodeOf[master]] = weight;
      }
    }
  }
  result.take(ties, nodes);
  return result;
}

std::vector<Index> HangingNodes::reach(
  const std::vector<Index>& known, const std::vector<Index>& cells) const
{
  std::set<Index> nodes(known.begin(), known.end());
  for (const auto& [place, cover] : this->covers_)
  {
    if (std::binary_search(cells.begin(), cells.end(), place.first))
    {
      for (const Polygon& polygon : cover)
      {
        nodes.insert(polygon.begin(), polygon.end());
      }
    }
  }
  std::set<Index> more = nodes;
  for (const auto& [edge, own] : this->onEdge_)
  {
    if (nodes.count(edge.first) > 0 && nodes.count(edge.second) > 0)
    {
      more.insert(own.begin(), own.end());
    }
  }
  for (const auto& [node, tie] : this->ties())
  {
    if (more.count(node) > 0)
    {
      for (const auto& [master, weight] : tie)
      {
        nodes.insert(master);
      }
    }
  }
  nodes.insert(more.begin(), more.end());
  return { nodes.begin(), nodes.end() };
}

bool HangingNodes::hangs(Index node) const
{
  return std::binary_search(this->ids_.begin(), this->ids_.end(), node);
}

NodePartition HangingNodes::extend(NodePartition partition) const
{
  std::vector<Index> more;
  for (std::size_t i = 0; i < this->ids_.size(); ++i)
  {
    bool isGiven = true;
    for (Weights::InnerIterator master(this->weights_, static_cast<Index>(i)); master; ++master)
    {
      isGiven = isGiven && std::binary_search(partition.prescribed.begin(),
                             partition.prescribed.end(), static_cast<Index>(master.col()));
    }
    if (isGiven)
    {
      more.push_back(this->ids_[i]);
    }
  }
  std::vector<Index> prescribed, free;
  std::set_union(partition.prescribed.begin(), partition.prescribed.end(), more.begin(), more.end(),
    std::back_inserter(prescribed));
  std::set_difference(partition.free.begin(), partition.free.end(), more.begin(), more.end(),
    std::back_inserter(free));
  partition.prescribed = std::move(prescribed);
  partition.free = std::move(free);
  return partition;
}

std::vector<Index> HangingNodes::tiedTo(const std::vector<Index>& nodes) const
{
  std::set<Index> masters;
  for (const auto& [node, tie] : this->ties())
  {
    std::transform(tie.begin(), tie.end(), std::inserter(masters, masters.end()),
      [](const auto& master) { return master.first; });
  }
  std::vector<Index> result;
  std::set_intersection(
    masters.begin(), masters.end(), nodes.begin(), nodes.end(), std::back_inserter(result));
  return result;
}

std::vector<Index> HangingNodes::without(const std::vector<Index>& ids) const
{
  std::vector<Index> result;
  std::copy_if(
    ids.begin(), ids.end(), std::back_inserter(result), [&](Index id) { return !this->hangs(id); });
  return result;
}

void HangingNodes::apply(Points& displacement) const
{
  if (!this->ids_.empty())
  {
    const Points tied = this->weights_ * displacement;
    displacement(this->ids_, allColumns) = tied;
  }
}

void HangingNodes::applyTranspose(Points& gradient) const
{
  if (!this->ids_.empty())
  {
    const Points own = gradient(this->ids_, allColumns);
    gradient(this->ids_, allColumns).setZero();
    gradient += this->weights_.transpose() * own;
  }
}

void HangingNodes::place(const Points& rest, Points& moved) const
{
  if (this->ids_.empty())
  {
    return;
  }
  Points displacement = moved - rest;
  this->apply(displacement);
  for (const Index node : this->ids_)
  {
    moved.row(node) = rest.row(node) + displacement.row(node);
  }
}

void HangingNodes::divideEdges(Polygon& polygon) const
{
  Polygon all;
  for (std::size_t k = 0; k < polygon.size(); ++k)
  {
    const Index from = polygon[k], to = polygon[(k + 1) % polygon.size()];
    all.push_back(from);
    const auto found = this->onEdge_.find({ std::min(from, to), std::max(from, to) });
    if (found != this->onEdge_.end())
    {
      std::vector<Index> nodes = found->second;
      if (from > to)
      {
        std::reverse(nodes.begin(), nodes.end());
      }
      all.insert(all.end(), nodes.begin(), nodes.end());
    }
  }
  polygon = std::move(all);
}

void HangingNodes::divideEdges(BoundaryFaces& faces) const
{
  if (this->onEdge_.empty())
  {
    return;
  }
  std::vector<Index> offsets = { 0 }, connectivity;
  for (std::size_t f = 0; f + 1 < faces.offsets.size(); ++f)
  {
    Polygon polygon(faces.connectivity.begin() + faces.offsets[f],
      faces.connectivity.begin() + faces.offsets[f + 1]);
    this->divideEdges(polygon);
    connectivity.insert(connectivity.end(), polygon.begin(), polygon.end());
    offsets.push_back(static_cast<Index>(connectivity.size()));
  }
  setCorners(std::move(offsets), std::move(connectivity), faces);
}

Mesh HangingNodes::conforming(const Mesh& mesh) const
{
  if (this->empty())
  {
    return mesh;
  }
  std::vector<std::uint8_t> isEnd(mesh.numberOfNodes(), 0);
  for (const auto& [edge, nodes] : this->onEdge_)
  {
    isEnd[edge.first] = isEnd[edge.second] = 1;
  }
  Mesh result;
  result.points = mesh.points;
  result.types = mesh.types;
  result.offsets = { 0 };
  result.faceOffsets = { 0 };
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    const Index *begin = mesh.cell(c), *end = begin + mesh.cellSize(c);
    std::vector<Index> nodes(begin, end);
    const CellShape* shape = cellShape(mesh, c);
    const auto cover = this->covers_.lower_bound({ c, 0 });
    const bool isCovered = cover != this->covers_.end() && cover->first.first == c;
    const bool isVolume = shape && shape->dimension == 3 && shape->shape != Shape::Polyhedron;
    if (isVolume && (isCovered || std::count_if(begin, end, [&](Index n) { return isEnd[n]; }) > 1))
    {
      std::vector<Polygon> polygons;
      bool isDivided = isCovered;
      for (int side = 0; side < shape->numberOfFaces; ++side)
      {
        const FaceShape& face = shape->faces[side];
        Polygon corners;
        for (int k = 0; k < face.size; ++k)
        {
          const Index node = begin[shape->cornerNode[face.corner[k]]];
          if (std::find(corners.begin(), corners.end(), node) == corners.end())
          {
            corners.push_back(node);
          }
        }
        const auto parts = this->covers_.find({ c, side });
        const std::vector<Polygon> own =
          parts == this->covers_.end() ? std::vector<Polygon>{ corners } : parts->second;
        for (Polygon polygon : own)
        {
          const std::size_t before = polygon.size();
          this->divideEdges(polygon);
          isDivided = isDivided || polygon.size() > before;
          if (polygon.size() > 2) // else it is collapsed
          {
            polygons.push_back(std::move(polygon));
          }
        }
      }
      if (isDivided)
      {
        result.types[c] = Polyhedron;
        nodes.clear(); // those between its corners are in no piece
        for (const Polygon& polygon : polygons)
        {
          result.faces.push_back(static_cast<Index>(polygon.size()));
          result.faces.insert(result.faces.end(), polygon.begin(), polygon.end());
          nodes.insert(nodes.end(), polygon.begin(), polygon.end());
        }
        std::sort(nodes.begin(), nodes.end());
        nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
      }
    }
    result.connectivity.insert(result.connectivity.end(), nodes.begin(), nodes.end());
    result.offsets.push_back(static_cast<Index>(result.connectivity.size()));
    result.faceOffsets.push_back(static_cast<Index>(result.faces.size()));
  }
  return result;
}

NodePartition partitionNodes(
  const Mesh& mesh, const HangingNodes& hanging, std::vector<Index> prescribed)
{
  NodePartition partition = partitionNodes(mesh, std::move(prescribed));
  std::vector<Index>& between = partition.higherOrderNodes;
  const auto first = std::stable_partition(
    between.begin(), between.end(), [&](Index node) { return !hanging.hangs(node); });
  const auto known = static_cast<std::ptrdiff_t>(partition.free.size());
  partition.free.insert(partition.free.end(), first, between.end());
  between.erase(first, between.end());
  std::inplace_merge(partition.free.begin(), partition.free.begin() + known, partition.free.end());
  return partition;
}
}
