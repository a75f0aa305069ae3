// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMover/Surroundings.h"

#include "Boundary/NodesBetween.h"
#include "BoundaryMorphing/SurfaceMorph.h"
#include "BoundaryMorphing/SurfaceSmoothing.h"
#include "Mesh/ShellLayer.h"
#include "Support/Error.h"
#include "Support/Lists.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <sstream>
#include <tuple>
#include <utility>

namespace morph
{
namespace
{
/// The values of these nodes.
template <typename Value>
std::vector<Value> some(const std::vector<Value>& all, const std::vector<Index>& nodes)
{
  std::vector<Value> values;
  values.reserve(nodes.size());
  for (const Index node : nodes)
  {
    values.push_back(all[node]);
  }
  return values;
}
}

void LocalBoundary::update(const BoundaryModel& model)
{
  if (this->version_ == model.motionVersion)
  {
    return;
  }
  this->version_ = -1; // in case there is not enough memory
  this->nodes_ = model.faces.nodes;
  this->number_.assign(model.points().rows(), -1);
  for (std::size_t i = 0; i < this->nodes_.size(); ++i)
  {
    this->number_[this->nodes_[i]] = static_cast<Index>(i);
  }
  const auto renumber = [this](std::vector<Index>& nodes) { nodes = this->numbersOf(nodes); };
  this->points_ = model.points()(this->nodes_, allColumns);
  this->bodyOfNode_ = some(model.bodyOfNode, this->nodes_);
  this->faces_ = model.faces;
  renumber(this->faces_.nodes);
  renumber(this->faces_.connectivity);
  renumber(this->faces_.between.values);

  this->geometry_ = model.geometry;
  this->geometry_.dimension = some(model.geometry.dimension, this->nodes_);
  this->geometry_.entity = some(model.geometry.entity, this->nodes_);
  this->geometry_.parameter = some(model.geometry.parameter, this->nodes_);
  for (GeometryVertex& vertex : this->geometry_.vertices)
  {
    vertex.node = this->number_[vertex.node];
  }
  for (GeometryCurve& curve : this->geometry_.curves)
  {
    renumber(curve.nodes);
  }
  for (GeometrySurface& surface : this->geometry_.surfaces)
  {
    renumber(surface.nodes);
  }
  for (auto& ends : this->geometry_.edges.nodes)
  {
    ends = { this->number_[ends[0]], this->number_[ends[1]] };
  }
  this->version_ = model.motionVersion;
}

std::vector<Index> LocalBoundary::numbersOf(const std::vector<Index>& nodes) const
{
  return some(this->number_, nodes);
}

namespace
{
/// The shapes along which surfaces slide, as a target.
class ShapeTarget : public ProjectionTarget
{
public:
  /// `shapes`: one for each surface, null where it does not slide.
  explicit ShapeTarget(std::vector<const SurfaceShape*> shapes)
    : shapes_(std::move(shapes))
  {
  }
  bool holds(Index surface) const override { return this->shapes_[surface] != nullptr; }
  bool closestOnSurface(Index surface, const Row& x, const Row&, Row& y) const override
  {
    y = this->shapes_[surface]->closest(x);
    return true;
  }
  bool closestOnFeatures(Index, const Row&, Row&) const override { return false; }

private:
  std::vector<const SurfaceShape*> shapes_;
};

/// The part of the largest displacement by which a surface may leave its shape, and is still said
/// to keep it.
constexpr double OffShape = 0.01;

double largestDisplacement(const BoundaryModel& model, const Surroundings::Result& result)
{
  double largest = 0;
  for (const Index node : model.faces.nodes)
  {
    if (result.roles[node] == Surroundings::Moves)
    {
      largest = std::max(largest, (result.moved.row(node) - model.points().row(node)).norm());
    }
  }
  return largest;
}

/// Tells for each surface whether it touches what moves, along an edge or at a moving node that has
/// no moving neighbor: a surface that shares no more than a vertex with a moving edge does not.
std::vector<std::uint8_t> touched(const BoundaryModel& model, const Surroundings::Result& result)
{
  const BoundaryFaces& faces = model.faces;
  const auto forMovingPairs = [&](const auto& action)
  {
    for (std::size_t f = 0; f + 1 < faces.offsets.size(); ++f)
    {
      const Index first = faces.offsets[f], last = faces.offsets[f + 1];
      for (Index k = first; k < last; ++k)
      {
        const Index a = faces.connectivity[k];
        const Index b = faces.connectivity[k + 1 < last ? k + 1 : first];
        action(
          f, a, result.roles[a] == Surroundings::Moves, b, result.roles[b] == Surroundings::Moves);
      }
    }
  };
  std::vector<std::uint8_t> hasMovingNeighbor(model.points().rows(), 0);
  forMovingPairs(
    [&](std::size_t, Index a, bool aMoves, Index b, bool bMoves)
    {
      hasMovingNeighbor[a] = hasMovingNeighbor[a] || bMoves;
      hasMovingNeighbor[b] = hasMovingNeighbor[b] || aMoves;
    });
  std::vector<std::uint8_t> isTouched(model.geometry.surfaces.size(), 0);
  forMovingPairs(
    [&](std::size_t f, Index a, bool aMoves, Index, bool bMoves)
    {
      if (aMoves && (bMoves || !hasMovingNeighbor[a]))
      {
        isTouched[model.geometry.surfaceOfFace[f]] = 1;
      }
    });
  return isTouched;
}

/// The motion of the place between corners at which a node, by its number in faces.nodes, is.
Eigen::RowVector3d shiftBetween(
  const BoundaryModel& model, Index k, const Surroundings::Result& result)
{
  return meanBetween(model.faces, k, model.points(),
    [&](Index corner)
    { return Eigen::RowVector3d(result.moved.row(corner) - model.points().row(corner)); });
}

/// Moves mid-side and face nodes of these roles with their corners. Otherwise the edges between
/// moved and fixed corners would bend. A held node moves only beside a corner with the role Moves.
/// `which`: their numbers in faces.nodes.
void moveBetween(const BoundaryModel& model, const std::vector<Index>& which,
  const std::vector<Surroundings::Role>& roles, Surroundings::Result& result)
{
  const BoundaryFaces& faces = model.faces;
  for (const Index k : which)
  {
    const Index node = faces.nodes[k];
    const Index *begin = faces.between.begin(k), *end = faces.between.end(k);
    if (begin == end || std::count(roles.begin(), roles.end(), result.roles[node]) == 0 ||
        (result.roles[node] == Surroundings::IsHeld &&
          std::none_of(
            begin, end, [&](Index corner) { return result.roles[corner] == Surroundings::Moves; })))
    {
      continue;
    }
    const Eigen::RowVector3d shift = shiftBetween(model, k, result);
    result.moved.row(node) = model.points().row(node);
    if (!shift.isZero(0))
    {
      result.roles[node] = Surroundings::Follows;
      result.moved.row(node) += shift;
    }
    else if (result.roles[node] == Surroundings::Follows)
    {
      result.roles[node] = Surroundings::Stays;
    }
  }
}

void moveBetween(const BoundaryModel& model, const std::vector<Surroundings::Role>& roles,
  Surroundings::Result& result)
{
  moveBetween(model, consecutive(model.faces.nodes.size()), roles, result);
}

/// A result in which nothing moves, in the memory of another one.
Surroundings::Result atRest(const BoundaryModel& model, Surroundings::Result last)
{
  if (last.motionVersion != model.motionVersion)
  {
    last.moved = model.points();
    last.roles.assign(model.points().rows(), Surroundings::Stays);
    last.motionVersion = model.motionVersion;
    return last;
  }
  for (const Index node : model.faces.nodes)
  {
    last.moved.row(node) = model.points().row(node);
    last.roles[node] = Surroundings::Stays;
  }
  return last;
}

/// Leaves the nodes on free surfaces alone, and those of `nodes`, to the morph of the interior
/// where they neither move nor are held.
void leaveFree(const BoundaryModel& model, const std::vector<Index>& held,
  const std::vector<Index>& surfaces, const std::vector<Index>& nodes, Surroundings::Result& result)
{
  if (surfaces.empty() && nodes.empty())
  {
    return;
  }
  std::vector<std::uint8_t> isFree = model.nodesOnlyOn(surfaces);
  const auto mark = [&](const std::vector<Index>& nodes, std::uint8_t value)
  {
    for (const Index node : nodes)
    {
      isFree[node] = value;
    }
  };
  mark(nodes, 1);
  mark(held, 0);
  for (const Index node : model.faces.nodes)
  {
    if (isFree[node] && result.roles[node] != Surroundings::Moves)
    {
      result.roles[node] = Surroundings::IsFree;
      result.moved.row(node) = model.points().row(node);
    }
  }
}
}

Surroundings::Result Surroundings::spread(const BoundaryModel& model, const Choice& choice,
  const Points& targets, const Options& options, Monitor& monitor, Result last)
{
  Result result = atRest(model, std::move(last));
  for (std::size_t i = 0; i < choice.moving.size(); ++i)
  {
    result.roles[choice.moving[i]] = Moves;
    result.moved.row(choice.moving[i]) = targets.row(static_cast<Index>(i));
  }
  for (Index node : choice.held)
  {
    result.roles[node] = IsHeld;
  }
  if (!choice.moving.empty())
  {
    this->place(model, choice, options, result, monitor);
    moveBetween(model, model.onLinearEdges, { Stays, Follows, IsHeld }, result);
  }
  leaveFree(model, choice.held, options.free, options.freeNodes, result);
  return result;
}

void Surroundings::place(const BoundaryModel& model, const Choice& choice, const Options& options,
  Result& result, Monitor& monitor)
{
  const std::vector<Index> sliding = options.follow.linear ? std::vector<Index>() : options.sliding;
  this->slide(model, sliding, { Moves }, result);
  const Points placed = result.moved(choice.moving, allColumns);
  switch (options.how)
  {
    case Kind::Follow:
    case Kind::FollowAll:
      this->follow(model, choice, placed, options, result, monitor);
      return;
    case Kind::Fade:
      this->fade(model, choice, placed, options.radius, result, monitor);
      break;
    case Kind::Stay:
      break;
  }
  moveBetween(model, { Stays, Follows, IsHeld }, result);
  this->slide(model, sliding, { Follows }, result);
}

const SurfaceShape& Surroundings::shapeOf(const BoundaryModel& model, Index surface)
{
  const std::vector<GeometrySurface>& surfaces = model.geometry.surfaces;
  if (this->shapesVersion_ != model.motionVersion)
  {
    this->shapes_.clear();
    this->shapes_.resize(surfaces.size());
    this->shell_.reset();
    this->shapesVersion_ = model.motionVersion;
  }
  if (!this->shapes_[surface])
  {
    this->shapes_[surface] =
      std::make_unique<SurfaceShape>(model.points(), model.faces, surfaces[surface]);
    const bool isCurve =
      model.mesh.layer.isCurved() && this->shapes_[surface]->kind() == SurfaceShape::Kind::Facets;
    if (isCurve && !this->shell_)
    {
      const BoundaryFaces faces = frontFaces(model.mesh);
      GeometrySurface front;
      front.nodes = faces.nodes;
      front.faces = consecutive(faces.cells.size());
      this->shell_ = std::make_unique<SurfaceShape>(model.points(), faces, front);
    }
  }
  return *this->shapes_[surface];
}

Eigen::RowVector3d Surroundings::slid(const BoundaryModel& model,
  const std::vector<Index>& surfaces, const Eigen::RowVector3d& from, const Eigen::RowVector3d& to)
{
  std::vector<const SurfaceShape*> shapes;
  bool isCurve = false;
  for (const Index s : surfaces)
  {
    shapes.push_back(&this->shapeOf(model, s));
    isCurve = isCurve || shapes.back()->kind() == SurfaceShape::Kind::Facets;
  }
  if (isCurve && this->shell_)
  {
    shapes.push_back(this->shell_.get());
  }
  Eigen::RowVector3d x = to;
  for (int round = 0; round < (shapes.size() > 1 ? 100 : 1); ++round)
  {
    const Eigen::RowVector3d before = x;
    for (const SurfaceShape* shape : shapes)
    {
      x = shape->slid(from, x);
    }
    if (x == before)
    {
      break;
    }
  }
  return x;
}

std::vector<Index> Surroundings::ableToSlide(const BoundaryModel& model,
  const std::vector<Index>& surfaces, const Result& result, Monitor& monitor)
{
  const double largest = largestDisplacement(model, result);
  std::vector<Index> able;
  std::ostringstream off, names;
  off.precision(3);
  for (const Index s : surfaces)
  {
    double given = 0, all = 0;
    bool follows = false; // else it stays but for its edge, as it was asked to
    for (const Index node : model.geometry.surfaces[s].nodes)
    {
      if (result.roles[node] == Moves || result.roles[node] == Follows)
      {
        const Eigen::RowVector3d to = result.moved.row(node);
        const double distance =
          (this->slid(model, { s }, model.points().row(node), to) - to).norm();
        all = std::max(all, distance);
        given = std::max(given, result.roles[node] == Moves ? distance : 0);
        follows |= result.roles[node] == Follows;
      }
    }
    if (given <= OffShape * largest)
    {
      able.push_back(s);
    }
    else if (follows)
    {
      names << (off.tellp() > 0 ? ", " : "") << "'Surface " << model.geometry.surfaces[s].id << "'";
      off << (off.tellp() > 0 ? ", " : "") << "Surface " << model.geometry.surfaces[s].id << " by "
          << all << " (" << 100 * all / largest << " % of the largest displacement)";
    }
  }
  if (off.tellp() > 0)
  {
    monitor.warn("Surfaces beside what moves leave their own shape: " + off.str() +
                 ". If you do not want that, set `FixedSurfaces` to " + names.str() +
                 ", or set `Surroundings` to Stay.");
  }
  return able;
}

void Surroundings::slide(const BoundaryModel& model, const std::vector<Index>& surfaces,
  const std::vector<Role>& roles, Result& result)
{
  std::map<Index, std::vector<Index>> surfacesOf;
  for (const Index s : surfaces)
  {
    for (const Index node : model.geometry.surfaces[s].nodes)
    {
      if (std::count(roles.begin(), roles.end(), result.roles[node]) > 0 &&
          result.moved.row(node) != model.points().row(node))
      {
        surfacesOf[node].push_back(s);
      }
    }
  }
  for (const auto& [node, on] : surfacesOf)
  {
    result.moved.row(node) =
      this->slid(model, on, model.points().row(node), result.moved.row(node));
  }
}

void Surroundings::follow(const BoundaryModel& model, const Choice& choice, const Points& targets,
  const Options& all, Result& result, Monitor& monitor)
{
  const SurfaceMorphOptions& options = all.follow;
  Key& key = this->weightsKey_;
  if (key.motionVersion != model.motionVersion || key.neighbors != options.neighbors)
  {
    this->weights_.surfaces.clear();
  }
  key.motionVersion = model.motionVersion;
  key.neighbors = options.neighbors;

  const bool touchedOnly = all.how == Kind::Follow;
  const std::vector<std::uint8_t> isTouched = touched(model, result);
  std::vector<Index> fixed = choice.held, following;
  for (std::size_t s = 0; touchedOnly && s < isTouched.size(); ++s)
  {
    const GeometrySurface& surface = model.geometry.surfaces[s];
    const bool hasMovingFace = std::any_of(surface.faces.begin(), surface.faces.end(),
      [&](Index face) { return choice.isMovingFace[face] != 0; });
    if (!isTouched[s])
    {
      std::copy_if(surface.nodes.begin(), surface.nodes.end(), std::back_inserter(fixed),
        [&](Index node) { return result.roles[node] == Stays; });
    }
    else if (!hasMovingFace && !std::count(all.sliding.begin(), all.sliding.end(), Index(s)) &&
             !std::count(all.free.begin(), all.free.end(), Index(s)))
    {
      following.push_back(static_cast<Index>(s));
    }
  }
  sortUnique(fixed);
  std::vector<Index> given = choice.moving;
  given.insert(given.end(), fixed.begin(), fixed.end());
  Points places(static_cast<Index>(given.size()), 3);
  places << targets, model.points()(fixed, allColumns);
  this->local_.update(model);
  const LocalBoundary& local = this->local_;
  BoundaryMotion motion = beginMotion(local.points(), local.bodyOfNode(), local.faces(),
    local.geometry(), local.numbersOf(given), places);
  morphCurves(local.geometry(), options.unattached, motion, monitor);
  const SurfaceMorphReport report =
    morphSurfaces(local.faces(), local.geometry(), options, motion, monitor, &this->weights_);
  using Method = SurfaceMorphOptions::Method;
  if (options.method != Method::WeightedResidual && !options.linear)
  {
    smoothSurfaces(local.faces(), local.geometry(), nullptr, motion, monitor);
  }
  const Points moved = motion.moved();
  for (std::size_t i = 0; i < local.nodes().size(); ++i)
  {
    const Index node = local.nodes()[i];
    result.moved.row(node) = moved.row(static_cast<Index>(i));
    if (motion.state[i] == BoundaryMotion::Held)
    {
      result.roles[node] = IsHeld;
    }
    else if (motion.state[i] != BoundaryMotion::Given)
    {
      result.roles[node] = Follows;
    }
  }
  moveBetween(model, { Stays, IsHeld }, result);
  if (options.linear)
  {
    return;
  }
  std::vector<Index> sliding = all.sliding;
  if (largestDisplacement(model, result) > 0)
  {
    const std::vector<Index> able = this->ableToSlide(model, following, result, monitor);
    sliding.insert(sliding.end(), able.begin(), able.end());
  }
  this->slide(model, sliding, { Follows }, result);
  this->smoothMeshes(model, sliding,
    options.method == Method::MeshSmoothing ? SmoothedSurfaces::All : SmoothedSurfaces::Folded,
    motion, result, monitor);
  if (!report.reflected.empty())
  {
    std::vector<Index> ids;
    for (Index s : report.reflected)
    {
      ids.push_back(model.geometry.surfaces[s].id);
    }
    monitor.warn("The motion reflects or flattens surfaces, which follow the nearest rotation and "
                 "scale instead: surface ids " +
                 listIds(ids) + ".");
  }
}

void Surroundings::smoothMeshes(const BoundaryModel& model, const std::vector<Index>& sliding,
  SmoothedSurfaces which, BoundaryMotion& motion, Result& result, Monitor& monitor)
{
  const LocalBoundary& local = this->local_;
  for (std::size_t i = 0; i < local.nodes().size(); ++i)
  {
    const Index here = static_cast<Index>(i);
    if (result.roles[local.nodes()[i]] == Follows)
    {
      motion.displacement.row(here) = result.moved.row(local.nodes()[i]) - local.points().row(here);
    }
  }
  std::vector<const SurfaceShape*> shapes(model.geometry.surfaces.size(), nullptr);
  for (const Index s : sliding)
  {
    shapes[s] = &this->shapeOf(model, s);
  }
  const ShapeTarget target(std::move(shapes));
  const Points before = motion.displacement;
  const SurfaceMeshSmoothing report =
    smoothSurfaceMeshes(local.faces(), local.geometry(), &target, which, motion, monitor);
  if (report.smoothed.empty())
  {
    return;
  }
  const Points moved = motion.moved();
  const auto hasSlid = [&](Index here)
  { return motion.displacement.row(here) != before.row(here); };
  for (std::size_t i = 0; i < local.nodes().size(); ++i)
  {
    const Index here = static_cast<Index>(i);
    if (hasSlid(here))
    {
      result.moved.row(local.nodes()[i]) = moved.row(here);
    }
  }
  if (which == SmoothedSurfaces::All)
  {
    return;
  }
  std::ostringstream said;
  said.precision(2);
  for (const Index s : report.smoothed)
  {
    Index count = 0;
    double most = 0;
    for (const Index here : local.geometry().surfaces[s].nodes)
    {
      count += hasSlid(here) ? 1 : 0;
      most = std::max(most, (motion.displacement.row(here) - before.row(here)).norm());
    }
    said << (s == report.smoothed.front() ? "" : ", ") << count << " nodes of Surface "
         << model.geometry.surfaces[s].id << " slid by up to " << most;
  }
  monitor.warn("Surfaces folded as they followed, and were smoothed: " + said.str() + ".");
}

void Surroundings::fade(const BoundaryModel& model, const Choice& choice, const Points& targets,
  double radius, Result& result, Monitor& monitor)
{
  if (radius == 0)
  {
    return;
  }
  Key& key = this->falloffKey_;
  if (key.motionVersion != model.motionVersion || key.radius != radius ||
      key.moving != choice.moving || key.held != choice.held)
  {
    key = Key(); // in case it throws
    std::map<Index, Fading> bodies;
    for (std::size_t i = 0; i < choice.moving.size(); ++i)
    {
      bodies[model.bodyOfNode[choice.moving[i]]].moving.push_back(static_cast<Index>(i));
    }
    for (const Index node : model.faces.nodes)
    {
      const auto body = bodies.find(model.bodyOfNode[node]);
      if (result.roles[node] == Stays && body != bodies.end())
      {
        body->second.others.push_back(node);
      }
    }
    this->fading_.clear();
    const Points moving = model.points()(choice.moving, allColumns);
    for (auto& [number, body] : bodies)
    {
      body.falloff.prepare(
        moving(body.moving, allColumns), model.points()(body.others, allColumns), radius, monitor);
      this->fading_.push_back(std::move(body));
    }
    ++this->falloffCount_;
    key.motionVersion = model.motionVersion;
    key.radius = radius;
    key.moving = choice.moving;
    key.held = choice.held;
  }
  const Points motion = targets - model.points()(choice.moving, allColumns);
  for (const Fading& body : this->fading_)
  {
    const Points displacement = body.falloff.evaluate(motion(body.moving, allColumns), monitor);
    for (const Index i : body.falloff.reached())
    {
      const Index node = body.others[i];
      result.roles[node] = Follows;
      if (!displacement.row(i).isZero(0))
      {
        result.moved.row(node) += displacement.row(i);
      }
    }
  }
}

bool Surroundings::Options::operator==(const Options& other) const
{
  const auto all = [](const Options& o)
  { return std::tie(o.how, o.follow, o.radius, o.sliding, o.free, o.freeNodes); };
  return all(*this) == all(other);
}

int Surroundings::prepareCount() const
{
  return static_cast<int>(this->weights_.prepared) + this->falloffCount_;
}
}
