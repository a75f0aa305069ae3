// SPDX-License-Identifier: BSD-3-Clause
#include "Interpolation/NaturalNeighbors.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace morph
{
namespace
{
constexpr double PowerTolerance = 1e-14; // of the terms that cancel in a power distance
constexpr double HullTolerance = 1e-10;  // of the distance to a corner of the face
constexpr double WorstResidual = 1e-8;   // of the distance to the neighbors
constexpr double LeastWeight = -1e-8;
constexpr double NoWeight = 1e-15; // sites that touch the cell in an edge or a vertex

using Vector = Eigen::RowVector3d;

/// The corners of the face opposite corner k, seen from outside a positively oriented tetrahedron.
constexpr int OuterFaces[4][3] = { { 1, 2, 3 }, { 0, 3, 2 }, { 0, 1, 3 }, { 0, 2, 1 } };
}

NaturalNeighbors::NaturalNeighbors(const Delaunay& delaunay, Monitor& monitor)
{
  const Points& sites = delaunay.sites();
  this->outer_ = delaunay.origin();
  this->origin_ = (sites.colwise().minCoeff() + sites.colwise().maxCoeff()) / 2;
  this->sites_ = sites.rowwise() - this->origin_;
  this->extent_ = this->sites_.cwiseAbs().maxCoeff();
  const Points centers = delaunay.circumcenters(monitor);
  this->cells_.resize(delaunay.tetrahedra().size());
  for (std::size_t t = 0; t < this->cells_.size(); ++t)
  {
    Cell& cell = this->cells_[t];
    cell.sites = delaunay.tetrahedra()[t].sites;
    cell.neighbors = delaunay.tetrahedra()[t].neighbors;
    const Vector center = centers.row(static_cast<Index>(t)) - this->origin_;
    const Vector corner = this->sites_.row(cell.sites[0]);
    std::copy_n(center.data(), 3, cell.center);
    cell.constant = corner.dot(2 * center - corner);
  }
}

NaturalNeighbors::Workspace::Workspace(const NaturalNeighbors& neighbors)
  : zoneMark_(neighbors.cells_.size(), 0)
  , power_(neighbors.cells_.size(), 0)
  , siteMark_(neighbors.sites_.rows(), 0)
  , siteNumber_(neighbors.sites_.rows(), 0)
{
}

/// Returns the slot where the edge waits for its other half, or a free slot.
NaturalNeighbors::Workspace::HalfEdge& NaturalNeighbors::Workspace::halfEdge(int from, int to)
{
  const std::int64_t key = static_cast<std::int64_t>(std::min(from, to)) << 32 | std::max(from, to);
  const std::size_t mask = this->edges_.size() - 1;
  std::size_t at =
    static_cast<std::size_t>((static_cast<std::uint64_t>(key) * 0x9e3779b97f4a7c15ull) >> 32) &
    mask;
  while (this->edges_[at].query == this->query_ && this->edges_[at].key != key)
  {
    at = (at + 1) & mask;
  }
  HalfEdge& edge = this->edges_[at];
  if (edge.query != this->query_)
  {
    edge = HalfEdge{ key, this->query_, -1 };
  }
  return edge;
}

/// Returns a negative value inside the sphere, and 0 on it within rounding: a site on the sphere
/// has no effect.
double NaturalNeighbors::power(const Cell& cell, const Vector& x, double squaredNorm) const
{
  const double product = cell.center[0] * x[0] + cell.center[1] * x[1] + cell.center[2] * x[2];
  const double power = squaredNorm - 2 * product + cell.constant;
  const double center =
    std::abs(cell.center[0]) + std::abs(cell.center[1]) + std::abs(cell.center[2]);
  const double size =
    squaredNorm + 2 * std::abs(product) + this->extent_ * (2 * center + this->extent_);
  return std::abs(power) <= PowerTolerance * size ? 0 : power;
}

void NaturalNeighbors::findZone(const Vector& x, int inside, Workspace& work) const
{
  const double squaredNorm = x.squaredNorm();
  ++work.query_;
  work.zone_.assign(1, inside);
  work.zoneMark_[inside] = work.query_;
  work.power_[inside] = this->power(this->cells_[inside], x, squaredNorm);
  for (std::size_t i = 0; i < work.zone_.size(); ++i)
  {
    for (int next : this->cells_[work.zone_[i]].neighbors)
    {
      if (next != Delaunay::Outside && std::abs(work.zoneMark_[next]) != work.query_)
      {
        work.power_[next] = this->power(this->cells_[next], x, squaredNorm);
        const bool conflict = work.power_[next] < 0;
        work.zoneMark_[next] = conflict ? work.query_ : -work.query_;
        if (conflict)
        {
          work.zone_.push_back(next);
        }
      }
    }
  }
}

/// Numbers the zone's sites, adds its inner faces' shares and lists its border. Returns false where
/// x is outside the hull.
///
/// At a height h over a face of the hull the face's Voronoi vertex is farther away than anything by
/// 1 / h. On the hull the shares are the limits for h to 0 from inside, so only terms in 1 / h
/// count: these are the natural neighbor coordinates in the plane of the face.
bool NaturalNeighbors::visitFaces(const Vector& x, Workspace& work) const
{
  work.local_.clear();
  work.place_.clear();
  work.share_.clear();
  work.farShare_.clear();
  work.border_.clear();
  work.hullNormal_.setZero();
  for (int t : work.zone_)
  {
    const Cell& cell = this->cells_[t];
    int number[4];
    for (int k = 0; k < 4; ++k)
    {
      const int site = cell.sites[k];
      if (work.siteMark_[site] != work.query_)
      {
        work.siteMark_[site] = work.query_;
        work.siteNumber_[site] = static_cast<int>(work.local_.size());
        work.local_.push_back(site);
        work.place_.push_back(this->sites_.row(site) - x);
        work.share_.push_back(0);
        work.farShare_.push_back(0);
      }
      number[k] = work.siteNumber_[site];
    }
    const Vector center = Eigen::Map<const Vector>(cell.center) - x;
    for (int k = 0; k < 4; ++k)
    {
      const int next = cell.neighbors[k];
      const bool inner = next != Delaunay::Outside && work.zoneMark_[next] == work.query_;
      if (inner && next < t)
      {
        continue; // each face once
      }
      const int a = number[OuterFaces[k][0]], b = number[OuterFaces[k][1]],
                c = number[OuterFaces[k][2]];
      const Vector &A = work.place_[a], &B = work.place_[b], &C = work.place_[c];
      Vector end = center, far = Vector::Zero(); // of the dual edge's part in the new cell: + far/h
      if (next == Delaunay::Outside)
      {
        const Vector normal = (B - A).cross(C - A);
        const double height = normal.dot(A), rounding = HullTolerance * normal.norm() * A.norm();
        if (!(height >= -rounding))
        {
          return false;
        }
        if (height > rounding)
        {
          end = center - (work.power_[t] / (2 * height)) * normal;
        }
        else
        {
          work.hullNormal_ = normal.normalized();
          far = -work.power_[t] / 2 * work.hullNormal_;
        }
      }
      else
      {
        end = Eigen::Map<const Vector>(this->cells_[next].center) - x;
        if (!inner)
        {
          const double here = work.power_[t], there = work.power_[next];
          end = center + (here < 0 ? here / (here - there) : 0) * (end - center);
        }
      }
      if (!inner)
      {
        work.border_.push_back({ { a, b, c }, end, far });
      }
      const Vector n = center.cross(end), farN = center.cross(far);
      const int corners[] = { a, b, c };
      const Vector sides[] = { B - C, C - A, A - B };
      for (int i = 0; i < 3; ++i)
      {
        work.share_[corners[i]] += sides[i].dot(n);
        work.farShare_[corners[i]] += sides[i].dot(farN);
      }
    }
  }
  return true;
}

/// Adds the faces between the new cell and the old ones. Each has an edge for every edge of the
/// zone's border.
void NaturalNeighbors::joinBorder(Workspace& work)
{
  std::size_t room = std::max<std::size_t>(64, work.edges_.size());
  while (room < 4 * work.border_.size()) // three half-edges a face, two an edge
  {
    room *= 2;
  }
  work.edges_.resize(room);
  for (std::size_t f = 0; f < work.border_.size(); ++f)
  {
    for (int k = 0; k < 3; ++k)
    {
      const int from = work.border_[f].corners[k], to = work.border_[f].corners[(k + 1) % 3];
      Workspace::HalfEdge& edge = work.halfEdge(from, to);
      if (edge.face < 0)
      {
        edge.face = static_cast<int>(f);
        continue;
      }
      const Workspace::Face &one = work.border_[f], &other = work.border_[edge.face];
      const Vector n = one.vertex.cross(other.vertex);
      const Vector farN = one.far.cross(other.vertex) + one.vertex.cross(other.far);
      edge.face = -1;
      const Vector &V = work.place_[from], &W = work.place_[to];
      work.share_[from] += W.dot(n);
      work.share_[to] -= V.dot(n);
      work.farShare_[from] += W.dot(farN);
      work.farShare_[to] -= V.dot(farN);
    }
  }
}

/// Normalizes the shares, drops zeros, checks and corrects the rest, and sorts by site.
bool NaturalNeighbors::finish(Workspace& work)
{
  if (!work.hullNormal_.isZero())
  {
    work.share_.swap(work.farShare_);
  }
  double total = 0;
  for (double share : work.share_)
  {
    total += share;
  }
  if (!(total > 0))
  {
    return false;
  }
  work.order_.clear();
  double sum = 0, length = 0;
  Vector mean = Vector::Zero();
  for (std::size_t i = 0; i < work.share_.size(); ++i)
  {
    double& weight = work.share_[i];
    weight /= total;
    if (!(weight > LeastWeight))
    {
      return false;
    }
    if (weight > NoWeight)
    {
      work.order_.push_back(static_cast<int>(i));
      sum += weight;
      mean += weight * work.place_[i];
      length += weight * work.place_[i].norm();
    }
  }
  if (!(mean.norm() <= WorstResidual * length && std::abs(sum - 1) <= WorstResidual))
  {
    return false;
  }

  // The smallest relative change of the weights that makes them sum to 1 and reproduce x.
  // Sites of one plane say nothing across it.
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  normal.bottomRightCorner<3, 3>() = work.hullNormal_.transpose() * work.hullNormal_;
  for (int i : work.order_)
  {
    const Eigen::Vector4d row(
      1, work.place_[i][0] / length, work.place_[i][1] / length, work.place_[i][2] / length);
    normal += work.share_[i] * row * row.transpose();
  }
  Eigen::Vector4d wanted(1 - sum, -mean[0] / length, -mean[1] / length, -mean[2] / length);
  const Eigen::Vector4d change = normal.ldlt().solve(wanted);
  if (!change.allFinite())
  {
    return false;
  }

  std::sort(work.order_.begin(), work.order_.end(),
    [&work](int a, int b) { return work.local_[a] < work.local_[b]; });
  work.sites.clear();
  work.weights.clear();
  for (int i : work.order_)
  {
    const double factor = 1 + change[0] + change.tail<3>().dot(work.place_[i].transpose()) / length;
    work.sites.push_back(work.local_[i]);
    work.weights.push_back(factor * work.share_[i]);
  }
  return true;
}

bool NaturalNeighbors::compute(const Vector& x, int inside, Workspace& work) const
{
  const Vector local = (x - this->outer_) - this->origin_;
  for (int site : this->cells_[inside].sites)
  {
    if (this->sites_.row(site) == local)
    {
      work.sites.assign(1, site);
      work.weights.assign(1, 1.);
      return true;
    }
  }
  this->findZone(local, inside, work);
  if (!this->visitFaces(local, work))
  {
    return false;
  }
  joinBorder(work);
  return finish(work);
}
}
