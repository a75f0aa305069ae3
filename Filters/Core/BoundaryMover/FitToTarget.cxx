// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMover/FitToTarget.h"

#include "Boundary/FaceQuality.h"
#include "BoundaryMorphing/SurfaceMorph.h"
#include "BoundaryMover/Patches.h"
#include "Mesh/ShellLayer.h"
#include "Support/Error.h"
#include "Support/Lists.h"
#include "Support/Monitor.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <utility>

namespace morph
{
namespace
{
using Vector = Eigen::Vector3d;
using Rigid = Eigen::Isometry3d;

constexpr Index Landmarks = 500;
constexpr int Iterations = 100;
/// To find the best start.
constexpr Index FewLandmarks = 100;
constexpr int FewIterations = 30;
/// Iterations end where one moves the landmarks by less, root mean square, of the place's size.
constexpr double Still = 1e-9;

/// Center of area and principal axes of a surface.
struct Moments
{
  Vector center = Vector::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity(); ///< right-handed, by ascending variance
};

Moments momentsOf(const TriangleTree& surface)
{
  Moments moments;
  std::vector<std::pair<Vector, double>> triangles; ///< center and area
  double area = 0;
  for (const auto& [a, b, c] : surface.triangles())
  {
    triangles.emplace_back((a + b + c).transpose() / 3, (b - a).cross(c - a).norm() / 2);
    area += triangles.back().second;
    moments.center += triangles.back().second * triangles.back().first;
  }
  if (area == 0)
  {
    return moments;
  }
  moments.center /= area;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const auto& [center, weight] : triangles)
  {
    const Vector x = center - moments.center;
    covariance += weight * x * x.transpose();
  }
  moments.axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors();
  if (moments.axes.determinant() < 0)
  {
    moments.axes.col(0) *= -1;
  }
  return moments;
}

std::vector<Rigid> startsOf(const Moments& from, const Moments& to)
{
  const auto about = [&](const Eigen::Matrix3d& rotation)
  {
    Rigid start = Rigid::Identity();
    start.linear() = rotation;
    start.translation() = to.center - rotation * from.center;
    return start;
  };
  std::vector<Rigid> starts = { Rigid::Identity(), about(Eigen::Matrix3d::Identity()) };
  const Vector signs[] = { { 1, 1, 1 }, { 1, -1, -1 }, { -1, 1, -1 }, { -1, -1, 1 } };
  for (const Vector& sign : signs)
  {
    starts.push_back(about(to.axes * sign.asDiagonal() * from.axes.transpose()));
  }
  return starts;
}

/// At most about `most` of the points, evenly from all.
std::vector<Vector> someOf(const Points& points, Index most)
{
  std::vector<Vector> some;
  for (Index i = 0; i < points.rows(); i += 1 + points.rows() / most)
  {
    some.emplace_back(points.row(i).transpose());
  }
  return some;
}

/// The surface onto which another one is turned and shifted.
struct Place
{
  const TriangleTree& triangles;
  double size; ///< diagonal of its box

  Vector closest(const Vector& x) const
  {
    return this->triangles.nearest(x.transpose(), std::numeric_limits<double>::infinity())
      .place.transpose();
  }
};

double sizeOf(const TriangleTree& surface)
{
  Eigen::AlignedBox3d box;
  for (const TriangleTree::Triangle& triangle : surface.triangles())
  {
    for (const TriangleTree::Row& corner : triangle)
    {
      box.extend(corner.transpose());
    }
  }
  return box.diagonal().norm();
}

/// The motion after closest-point iterations from a start: each takes the landmarks as near as
/// rigid motion can to their closest points.
Rigid iterated(const std::vector<Vector>& landmarks, const Rigid& start, const Place& place,
  int iterations, Monitor& monitor)
{
  Rigid motion = start;
  const auto count = static_cast<Eigen::Index>(landmarks.size());
  Eigen::Matrix3Xd from(3, count), to(3, count);
  double moved = std::numeric_limits<double>::infinity();
  for (int done = 0; done < iterations && moved > Still * place.size; ++done)
  {
    monitor.check();
    monitor.progress(static_cast<double>(done) / iterations);
    for (Eigen::Index i = 0; i < count; ++i)
    {
      from.col(i) = motion * landmarks[i];
      to.col(i) = place.closest(from.col(i));
    }
    const Rigid step(Eigen::umeyama(from, to, false));
    motion = step * motion;
    moved = std::sqrt((step * from - from).colwise().squaredNorm().mean());
  }
  monitor.progress(1);
  return motion;
}

double meanDistance(const std::vector<Vector>& landmarks, const Rigid& motion, const Place& place)
{
  double sum = 0;
  for (const Vector& x : landmarks)
  {
    const Vector y = motion * x;
    sum += (place.closest(y) - y).norm();
  }
  return sum / static_cast<double>(landmarks.size());
}
}

Rigid alignment(
  const TriangleTree& surface, const Points& landmarks, const TriangleTree& onto, Monitor& monitor)
{
  const Place place{ onto, sizeOf(onto) };
  const std::vector<Vector> few = someOf(landmarks, FewLandmarks);
  Rigid best = Rigid::Identity();
  double least = -1;
  const std::vector<Rigid> starts = startsOf(momentsOf(surface), momentsOf(onto));
  for (std::size_t i = 0; i < starts.size(); ++i)
  {
    const double share = 0.5 / static_cast<double>(starts.size());
    const double done = share * static_cast<double>(i);
    ProgressRange part(monitor, done, done + share);
    const Rigid motion = iterated(few, starts[i], place, FewIterations, part);
    const double distance = meanDistance(few, motion, place);
    if (motion.matrix().allFinite() && (least < 0 || distance < 0.99 * least - 1e-6 * place.size))
    {
      least = distance;
      best = motion;
    }
  }
  ProgressRange last(monitor, 0.5, 1);
  return iterated(someOf(landmarks, Landmarks), best, place, Iterations, last);
}

namespace
{
using Row = ProjectionTarget::Row;

constexpr double Anywhere = std::numeric_limits<double>::infinity();

/// The edges of curves with nodes that move, as flat triangles.
std::vector<TriangleTree::Triangle> curvesAt(
  const Points& at, const Classification& geometry, const Choice& choice)
{
  const auto moves = [&](Index node)
  { return std::binary_search(choice.moving.begin(), choice.moving.end(), node); };
  std::vector<TriangleTree::Triangle> edges;
  for (const GeometryCurve& curve : geometry.curves)
  {
    const std::size_t n = curve.nodes.size();
    for (std::size_t i = 0; i + 1 < n + curve.loop; ++i)
    {
      const Index first = curve.nodes[i], second = curve.nodes[(i + 1) % n];
      if (moves(first) || moves(second))
      {
        edges.push_back({ at.row(first), at.row(second), at.row(second) });
      }
    }
  }
  return edges;
}

/// A target whose surface serves for curves too, where it has no feature edge of theirs. An edge to
/// which other curves are less than half as far is not. Nodes on the rim of what moves that are on
/// surfaces which slide go to target and sliding surfaces together.
class WithCurves : public ProjectionTarget
{
public:
  WithCurves(const Target& target, const TargetRim& rim, std::vector<TriangleTree::Triangle> curves)
    : place_(target)
    , rim_(rim)
    , curves_(std::move(curves))
  {
  }
  bool closestOnSurface(Index surface, const Row& x, const Row& normal, Row& y) const override
  {
    return this->place_.closestOnSurface(surface, x, normal, y);
  }
  bool closestOnFeatures(Index node, const Row& x, Row& y) const override
  {
    if (this->rim_.has(node))
    {
      return this->rim_.meet(
        node, x, [&](const Row& at, Row& to) { return this->anywhere(at, to); }, y);
    }
    return (this->place_.closestOnFeatures(node, x, y) &&
             2 * (this->curves_.nearest(y, Anywhere).place - y).norm() >= (x - y).norm()) ||
           this->anywhere(x, y);
  }
  /// Of a vertex that no vertex of the target belongs to.
  bool closestForVertex(Index node, const Row& x, Row& y) const
  {
    if (!this->rim_.has(node))
    {
      return this->closestOnFeatures(node, x, y);
    }
    // Where surfaces that move meet, their common edge goes to the target's.
    const auto onEdge = [&](const Row& at, Row& to)
    { return this->place_.closestOnFeatures(node, at, to); };
    return (this->rim_.isOnEdge(node) && this->rim_.meet(node, x, onEdge, y)) ||
           this->closestOnFeatures(node, x, y);
  }

private:
  bool anywhere(const Row& x, Row& y) const
  {
    return this->place_.closestOnSurface(-1, x, Row::Zero(), y);
  }

  const Target& place_;
  const TargetRim& rim_;
  TriangleTree curves_;
};

/// Where vertices go to vertices of the target. Where one is the nearest to several of them, the
/// nearest of these has it.
TargetOfNode vertexPlaces(
  const BoundaryModel& model, const Choice& choice, const Target& target, const TargetRim& rim)
{
  std::map<std::array<double, 3>, std::pair<double, Index>> nearest;
  for (const Index node : choice.moving)
  {
    const Row x = model.points().row(node);
    Row y;
    if (model.geometry.dimension[node] == 0 && !rim.has(node) && target.closestOnVertices(x, y))
    {
      const auto candidate = std::make_pair((y - x).norm(), node);
      const auto found = nearest.emplace(std::array<double, 3>{ y[0], y[1], y[2] }, candidate);
      found.first->second = std::min(found.first->second, candidate);
    }
  }
  TargetOfNode places;
  for (const auto& [place, node] : nearest)
  {
    places.emplace(node.second, Row(place[0], place[1], place[2]));
  }
  return places;
}

/// The triangles of faces, and the face of each.
std::pair<std::vector<TriangleTree::Triangle>, std::vector<Index>> trianglesOf(
  const BoundaryModel& model, const std::vector<Index>& ids)
{
  std::vector<TriangleTree::Triangle> triangles;
  std::vector<Index> faceOf;
  for (const Index face : ids)
  {
    addTriangles(model.points(), model.faces, face, triangles);
    faceOf.resize(triangles.size(), face);
  }
  return { std::move(triangles), std::move(faceOf) };
}

BoundaryMotion allHeld(const BoundaryModel& model)
{
  BoundaryMotion motion;
  motion.rest = model.points();
  motion.displacement = Points::Zero(motion.rest.rows(), 3);
  motion.state.assign(motion.rest.rows(), BoundaryMotion::Unknown);
  motion.bodyOfNode = model.bodyOfNode;
  for (const Index node : model.faces.nodes)
  {
    motion.state[node] = BoundaryMotion::Held;
  }
  return motion;
}

/// The motion's start: what does not move is given, and vertices that move are, where they find a
/// place. `missed`: those that find none.
BoundaryMotion begin(const BoundaryModel& model, const Choice& choice, const TargetOfNode& places,
  const WithCurves& place, std::vector<Index>& missed)
{
  const Classification& geometry = model.geometry;
  BoundaryMotion motion = allHeld(model);
  for (const Index node : choice.moving)
  {
    motion.state[node] = BoundaryMotion::Unknown;
    Row y;
    if (geometry.dimension[node] == 0)
    {
      motion.state[node] = BoundaryMotion::Held;
      const auto found = places.find(node);
      if (found != places.end())
      {
        motion.displacement.row(node) = found->second - motion.rest.row(node);
      }
      else if (place.closestForVertex(node, motion.rest.row(node), y))
      {
        motion.displacement.row(node) = y - motion.rest.row(node);
      }
      else
      {
        missed.push_back(node);
      }
    }
  }
  return motion;
}

/// Nodes of closed curves or surfaces, about which nothing is known, wait where they are.
void await(const Choice& choice, const Classification& geometry, int dimension,
  BoundaryMotion::State state, BoundaryMotion& motion)
{
  for (const Index node : choice.moving)
  {
    if (motion.state[node] == BoundaryMotion::Unknown && geometry.dimension[node] == dimension)
    {
      motion.state[node] = state;
    }
  }
}

/// surfaceNodeNormals() of the nodes that move, and zero of others: the target is oriented by them.
Points movingNormals(const BoundaryModel& model, const Choice& choice, const Points& moved)
{
  const Points all = surfaceNodeNormals(model.points(), moved, model.faces, model.geometry);
  Points normals = Points::Zero(all.rows(), 3);
  normals(choice.moving, allColumns) = all(choice.moving, allColumns);
  return normals;
}

void moveAlong(Target& target, const BoundaryModel& model, const Choice& choice,
  const TargetRim& rim, const Row& along, BoundaryMotion& motion, std::vector<Index>& missed)
{
  Points directions = along.normalized().replicate(static_cast<Index>(choice.moving.size()), 1);
  if (along.isZero(0))
  {
    directions = nodeNormals(
      model.outwardAreas(model.points()), model.faces, choice.isMovingFace, choice.moving);
  }
  const Points normals = movingNormals(model, choice, model.points());
  target.orient(model.points(), normals);
  for (std::size_t i = 0; i < choice.moving.size(); ++i)
  {
    const Index node = choice.moving[i];
    const Row direction = rim.along(node, directions.row(static_cast<Index>(i)));
    const auto find = [&](const Row& at, Row& to)
    { return target.closestAlong(at, direction, normals.row(node), to); };
    const Row x = model.points().row(node);
    Row y;
    if (rim.has(node) ? rim.meet(node, x, find, y) : find(x, y))
    {
      motion.displacement.row(node) = y - x;
    }
    else
    {
      // A vertex has nothing to follow.
      motion.state[node] =
        model.geometry.dimension[node] == 0 ? BoundaryMotion::Held : BoundaryMotion::Unknown;
      missed.push_back(node);
    }
  }
}
}

Eigen::Isometry3d alignedOnto(
  const BoundaryModel& model, const Choice* choice, const Target& target, Monitor& monitor)
{
  std::vector<Index> ids = consecutive(model.faces.offsets.size() - 1);
  if (choice && std::count(choice->isMovingFace.begin(), choice->isMovingFace.end(), 1) > 0)
  {
    ids.erase(std::remove_if(ids.begin(), ids.end(),
                [&](Index face) { return choice->isMovingFace[face] == 0; }),
      ids.end());
  }
  std::vector<Index> corners;
  for (const TargetTriangle& triangle : target.triangles())
  {
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  }
  sortUnique(corners);
  return alignment(target.tree(), target.points()(corners, allColumns),
    TriangleTree(trianglesOf(model, ids).first), monitor);
}

std::set<std::string> surfacesNearest(const Target& target, const BoundaryModel& model)
{
  const Classification& geometry = model.geometry;
  auto [triangles, faceOf] = trianglesOf(model, consecutive(model.faces.offsets.size() - 1));
  const TriangleTree boundary(std::move(triangles));
  std::vector<double> votes(geometry.surfaces.size(), 0), own(geometry.surfaces.size(), 0);
  const Points areas = faceAreas(model.points(), model.faces);
  for (Index f = 0; f < areas.rows(); ++f)
  {
    own[geometry.surfaceOfFace[f]] += areas.row(f).norm();
  }
  for (const auto& [a, b, c] : target.tree().triangles())
  {
    // Triangles of an STL file may be as large as the surface: a sample in each quarter.
    const double area = (b - a).cross(c - a).norm() / 2;
    const Row center = (a + b + c) / 3;
    for (const Row& sample :
      { center, Row((center + a) / 2), Row((center + b) / 2), Row((center + c) / 2) })
    {
      const Index found = boundary.nearest(sample, Anywhere).triangle;
      if (found >= 0)
      {
        votes[geometry.surfaceOfFace[faceOf[found]]] += area / 4;
      }
    }
  }
  std::set<std::string> names;
  for (std::size_t s = 0; s < votes.size(); ++s)
  {
    if (votes[s] >= 0.5 * own[s] && votes[s] > 0)
    {
      names.insert(surfaceName(geometry, static_cast<Index>(s)));
    }
  }
  if (names.empty())
  {
    throw Error("No surface of the mesh belongs to the target: none has half of its area "
                "beside it. Choose the surfaces that are to fit, or align the target.");
  }
  return names;
}

TargetRim::TargetRim(const BoundaryModel& model, const Choice& choice,
  const std::vector<Index>& sliding, Surroundings& surroundings)
  : model_(model)
  , surfaces_(surroundings)
{
  const std::vector<GeometrySurface>& surfaces = model.geometry.surfaces;
  for (const Index s : sliding)
  {
    surroundings.shapeOf(model, s); // before several threads ask for it
    for (const Index node : surfaces[s].nodes)
    {
      if (model.geometry.dimension[node] < 2 &&
          std::binary_search(choice.moving.begin(), choice.moving.end(), node))
      {
        this->nodes_[node].sliding.push_back(s);
      }
    }
  }
  for (const GeometrySurface& surface : surfaces)
  {
    const bool moves = std::any_of(surface.faces.begin(), surface.faces.end(),
      [&](Index face) { return choice.isMovingFace[face] != 0; });
    for (const Index node : surface.nodes)
    {
      const auto found = this->nodes_.find(node);
      if (moves && found != this->nodes_.end())
      {
        ++found->second.moving;
      }
    }
  }
}

Eigen::RowVector3d TargetRim::along(Index node, const Row& direction) const
{
  const auto found = this->nodes_.find(node);
  Row along = direction;
  if (found != this->nodes_.end())
  {
    std::vector<Row> normals; // orthonormal
    for (const Index s : found->second.sliding)
    {
      const Row x = this->model_.points().row(node);
      Row normal = this->surfaces_.shapeOf(this->model_, s).normal(x);
      for (const Row& other : normals)
      {
        normal -= normal.dot(other) * other;
      }
      if (normal.norm() > 1e-6)
      {
        normals.push_back(normal.normalized());
        along -= along.dot(normals.back()) * normals.back();
      }
    }
  }
  return along.norm() > 1e-6 ? Row(along.normalized()) : direction;
}

namespace
{
/// The remedy for nodes that are farther from the target than its reach; empty where none is. Of
/// the boundary's size, two digits, rounded up.
std::string reachFor(
  const Target& target, const BoundaryModel& model, const std::vector<Index>& nodes)
{
  constexpr double Most = 10, Anywhere = std::numeric_limits<double>::infinity();
  double farthest = 0;
  for (const Index node : nodes)
  {
    const Row x = model.points().row(node);
    farthest = std::max(farthest, (target.tree().nearest(x, Anywhere).place - x).norm());
  }
  const double reach = std::ceil(100 * farthest / model.size) / 100;
  if (farthest <= target.options().reach || reach > Most)
  {
    return "";
  }
  std::ostringstream text;
  text << " set `TargetReach` to " << reach << ".";
  return text.str();
}
}

Points fittedTo(Target& target, const BoundaryModel& model, const Choice& all,
  const std::vector<Index>& sliding, const Row* along, Surroundings& surroundings, Monitor& monitor)
{
  const Classification& geometry = model.geometry;
  const ShellLayer& layer = model.mesh.layer;
  Choice choice = all;
  choice.moving.erase(std::remove_if(choice.moving.begin(), choice.moving.end(),
                        [&](Index node) { return layer.frontOf(node) != node; }),
    choice.moving.end());
  const TargetRim rim(model, choice, sliding, surroundings);
  std::vector<Index> missed;
  BoundaryMotion motion;
  if (along)
  {
    motion = allHeld(model);
    moveAlong(target, model, choice, rim, *along, motion, missed);
  }
  else
  {
    motion = begin(model, choice, vertexPlaces(model, choice, target, rim),
      WithCurves(target, rim, curvesAt(model.points(), geometry, choice)), missed);
  }
  SurfaceMorphOptions following;
  following.unattached = UnattachedMotion::Stay;
  ProgressRange onCurves(monitor, 0.55, 0.75), onSurfaces(monitor, 0.75, 1);
  const auto add = [&missed](const ProjectionReport& report)
  {
    for (const auto* some : { &report.missed, &report.kept })
    {
      missed.insert(missed.end(), some->begin(), some->end());
    }
  };
  morphCurves(geometry, following.unattached, motion, onCurves);
  await(choice, geometry, 1, BoundaryMotion::OnCurve, motion);
  const WithCurves place(target, rim, curvesAt(motion.moved(), geometry, choice));
  if (!along)
  {
    add(projectCurves(geometry, place, motion, monitor));
  }
  morphSurfaces(model.faces, geometry, following, motion, onSurfaces);
  await(choice, geometry, 2, BoundaryMotion::OnSurface, motion);
  if (!along)
  {
    const Points moved = motion.moved();
    target.assign(geometry, moved);
    target.orient(moved, movingNormals(model, choice, moved));
    add(projectSurfaces(model.faces, geometry, place, motion, monitor));
  }
  std::sort(missed.begin(), missed.end());
  const std::string how = along ? " along the direction" : "";
  const std::string needed = along ? "" : reachFor(target, model, missed);
  if (missed.size() == choice.moving.size())
  {
    throw Error("No node that moves reaches the target: it has no place within "
                "`TargetReach`" +
                how + " whose normal is within `TargetAngle`. Align the target" +
                (needed.empty() ? "." : ", or" + needed));
  }
  if (!missed.empty())
  {
    monitor.warn("Nodes do not reach the target, since it has no place within `TargetReach`" + how +
                 " whose normal is within `TargetAngle`, or faces would fold there: point ids " +
                 listIds(missed) + " of the input." +
                 (needed.empty() ? "" : " To let them," + needed));
  }
  for (const auto& [front, back] : imagesAmong(layer, all.moving))
  {
    motion.displacement.row(all.moving[back]) = motion.displacement.row(all.moving[front]);
  }
  return motion.moved()(all.moving, allColumns);
}
}
