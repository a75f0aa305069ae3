// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/DividedFaces.h"

#include "Mesh/CellShape.h"
#include "Support/Lists.h"
#include "Support/Parallel.h"

#include <Eigen/Dense>

#include <cmath>

namespace morph
{
/// The shape functions of a face at a place, in the order of its nodes, and their derivatives.
struct FaceFunctions
{
  std::array<double, DividedFaces::MostNodes> N = {}, dU = {}, dV = {};
};

namespace
{
constexpr int MostNodes = DividedFaces::MostNodes;
/// Of a face's size: how far a node may be off it, and a vector area off that of the small faces.
constexpr double OnFace = 1e-6;

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

/// The nodes of each face: its corners, then the middles of its sides, then its own middle. None of
/// a face whose shape functions are not known here.
Adjacency nodesOfFaces(const Mesh& mesh, const BoundaryFaces& faces)
{
  Adjacency result;
  for (std::size_t f = 0; f < faces.cells.size(); ++f)
  {
    const Index cell = faces.cells[f];
    const CellShape& shape = *cellShape(mesh, cell);
    const Index* corners = faces.connectivity.data() + faces.offsets[f];
    const Index size = faces.offsets[f + 1] - faces.offsets[f];
    std::vector<Index> nodes(corners, corners + size), middles(size, -1), center;
    for (int k = shape.numberOfCorners; k < shape.numberOfNodes; ++k) // -1 of a polyhedron
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
      if (isOn && between.size() == 2 && between[0] == between[1])
      {
        continue; // in the middle of an edge without length
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
    const bool isKnown =
      (size == 3 || size == 4) && mesh.types[cell] < LagrangeCurve && (isLinear || isQuadratic);
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
}

DividedFaces::DividedFaces(const Mesh& mesh, const BoundaryFaces& faces, Monitor& monitor)
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

bool DividedFaces::isCorner(Index f, Index node) const
{
  const Index* last = this->begin(f) + std::min(this->corners(f), this->size(f));
  return std::find(this->begin(f), last, node) != last;
}

bool DividedFaces::hasPartsAtCorners(Index f) const
{
  return this->size(f) > 0 &&
         std::all_of(this->begin(f), this->begin(f) + this->corners(f),
           [&](Index corner)
           {
             return std::any_of(this->ofNode_.begin(corner), this->ofNode_.end(corner),
               [&](Index g) { return this->isCorner(g, corner) && this->isPart(g, f); });
           });
}

std::vector<Index> DividedFaces::parts(Index f) const
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

std::optional<DividedFaces::PlaceOnFace> DividedFaces::placeOn(
  Index f, const Eigen::RowVector3d& x) const
{
  std::optional<PlaceOnFace> found;
  const auto zeros = [](const PlaceOnFace& at) { return std::count(at.N.begin(), at.N.end(), 0); };
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

std::optional<std::tuple<Index, Index, double>> DividedFaces::sideOf(
  Index f, const PlaceOnFace& at) const
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

FaceFunctions DividedFaces::functions(Index f, double u, double v) const
{
  const auto nodes = static_cast<int>(this->size(f));
  return this->corners(f) == 3 ? triangleFunctions(nodes, u, v)
                               : quadrilateralFunctions(nodes, u, v);
}

Eigen::Vector3d DividedFaces::sum(Index f, const std::array<double, MostNodes>& weights) const
{
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  for (Index a = 0; a < this->size(f); ++a)
  {
    result += weights[a] * (this->place(f, a) - this->place(f, 0)).transpose();
  }
  return result;
}

std::pair<double, double> DividedFaces::placeOf(Index node, Index f) const
{
  constexpr std::pair<double, double> OfTriangle[] = { { 0, 0 }, { 1, 0 }, { 0, 1 }, { 0.5, 0 },
    { 0.5, 0.5 }, { 0, 0.5 } };
  constexpr std::pair<double, double> OfQuadrilateral[] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 },
    { 0.5, 0 }, { 1, 0.5 }, { 0.5, 1 }, { 0, 0.5 }, { 0.5, 0.5 } };
  return this->corners(f) == 3 ? OfTriangle[node] : OfQuadrilateral[node];
}

bool DividedFaces::isFolded(Index f) const
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

std::optional<DividedFaces::PlaceOnFace> DividedFaces::placeFrom(
  Index start, Index f, const Eigen::RowVector3d& x) const
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

Eigen::RowVector3d DividedFaces::areaOf(Index f) const
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

double DividedFaces::magnitudeOf(Index f) const
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

bool DividedFaces::isPart(Index g, Index f) const
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

bool DividedFaces::mayReach(Index f, Index g) const
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
}
