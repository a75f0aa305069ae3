// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/Surroundings.h"

#include "BoundaryMorphing/CurveMorph.h"
#include "BoundaryMorphing/MidNodes.h"
#include "BoundaryMorphing/SurfaceSmoothing.h"
#include "Support/Error.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <sstream>
#include <tuple>
#include <utility>

namespace morph::filters
{
namespace
{
using morph::Index;
using morph::Points;

Points rowsOf(const Points& all, const std::vector<Index>& ids)
{
  Points some(static_cast<Index>(ids.size()), 3);
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    some.row(static_cast<Index>(i)) = all.row(ids[i]);
  }
  return some;
}

/// The shapes along which surfaces slide, as a target.
class ShapeTarget : public morph::ProjectionTarget
{
public:
  /// `shapes`: one for each surface, null where it does not slide.
  explicit ShapeTarget(std::vector<const SurfaceShape*> shapes)
    : Shapes(std::move(shapes))
  {
  }
  bool holds(Index surface) const override { return this->Shapes[surface] != nullptr; }
  bool closestOnSurface(Index surface, const Row& x, const Row&, Row& y) const override
  {
    y = this->Shapes[surface]->Closest(x);
    return true;
  }
  bool closestOnFeatures(Index, const Row&, Row&) const override { return false; }

private:
  std::vector<const SurfaceShape*> Shapes;
};

/// The part of the largest displacement by which a surface may leave its shape, and is still said
/// to keep it.
constexpr double OffShape = 0.01;

double largestDisplacement(const BoundaryModel& model, const Surroundings::Result& result)
{
  double largest = 0;
  for (const Index node : model.Faces().nodes)
  {
    if (result.Roles[node] == Surroundings::Moves)
    {
      largest = std::max(largest, (result.Moved.row(node) - model.Points().row(node)).norm());
    }
  }
  return largest;
}

/// Tells for each surface whether it touches what moves, along an edge or at a moving node that has
/// no moving neighbor: a surface that shares no more than a vertex with a moving edge does not.
std::vector<std::uint8_t> touched(const BoundaryModel& model, const Surroundings::Result& result)
{
  const morph::BoundaryFaces& faces = model.Faces();
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
          f, a, result.Roles[a] == Surroundings::Moves, b, result.Roles[b] == Surroundings::Moves);
      }
    }
  };
  std::vector<std::uint8_t> hasMovingNeighbor(model.Points().rows(), 0);
  forMovingPairs(
    [&](std::size_t, Index a, bool aMoves, Index b, bool bMoves)
    {
      hasMovingNeighbor[a] = hasMovingNeighbor[a] || bMoves;
      hasMovingNeighbor[b] = hasMovingNeighbor[b] || aMoves;
    });
  std::vector<std::uint8_t> isTouched(model.Geometry().surfaces.size(), 0);
  forMovingPairs(
    [&](std::size_t f, Index a, bool aMoves, Index, bool bMoves)
    {
      if (aMoves && (bMoves || !hasMovingNeighbor[a]))
      {
        isTouched[model.Geometry().surfaceOfFace[f]] = 1;
      }
    });
  return isTouched;
}

/// Moves mid-side and face nodes of these roles with their corners. Otherwise the edges between
/// moved and fixed corners would bend. A held node moves only beside a corner with the role Moves.
void moveBetween(const BoundaryModel& model, const std::vector<Surroundings::Role>& roles,
  Surroundings::Result& result)
{
  const morph::BoundaryFaces& faces = model.Faces();
  for (std::size_t i = 0; i < faces.nodes.size(); ++i)
  {
    const Index node = faces.nodes[i], k = static_cast<Index>(i);
    const Index *begin = faces.between.begin(k), *end = faces.between.end(k);
    if (begin == end || std::count(roles.begin(), roles.end(), result.Roles[node]) == 0 ||
        (result.Roles[node] == Surroundings::IsHeld &&
          std::none_of(
            begin, end, [&](Index corner) { return result.Roles[corner] == Surroundings::Moves; })))
    {
      continue;
    }
    const Eigen::RowVector3d shift = morph::meanBetween(faces, k, model.Points(),
      [&](Index corner)
      { return Eigen::RowVector3d(result.Moved.row(corner) - model.Points().row(corner)); });
    result.Moved.row(node) = model.Points().row(node);
    if (!shift.isZero(0))
    {
      result.Roles[node] = Surroundings::Follows;
      result.Moved.row(node) += shift;
    }
    else if (result.Roles[node] == Surroundings::Follows)
    {
      result.Roles[node] = Surroundings::Stays;
    }
  }
}

/// A result in which nothing moves, in the memory of another one.
Surroundings::Result atRest(const BoundaryModel& model, Surroundings::Result last)
{
  if (last.MotionVersion != model.MotionVersion())
  {
    last.Moved = model.Points();
    last.Roles.assign(model.Points().rows(), Surroundings::Stays);
    last.MotionVersion = model.MotionVersion();
    return last;
  }
  for (const Index node : model.Faces().nodes)
  {
    last.Moved.row(node) = model.Points().row(node);
    last.Roles[node] = Surroundings::Stays;
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
  std::vector<std::uint8_t> isFree = model.NodesOnlyOn(surfaces);
  const auto mark = [&](const std::vector<Index>& nodes, std::uint8_t value)
  {
    for (const Index node : nodes)
    {
      isFree[node] = value;
    }
  };
  mark(nodes, 1);
  mark(held, 0);
  for (const Index node : model.Faces().nodes)
  {
    if (isFree[node] && result.Roles[node] != Surroundings::Moves)
    {
      result.Roles[node] = Surroundings::IsFree;
      result.Moved.row(node) = model.Points().row(node);
    }
  }
}
}

Surroundings::Result Surroundings::Spread(const BoundaryModel& model, const Choice::Result& choice,
  const Points& targets, const Options& options, morph::Monitor& monitor, Result last)
{
  Result result = atRest(model, std::move(last));
  for (std::size_t i = 0; i < choice.Moving.size(); ++i)
  {
    result.Roles[choice.Moving[i]] = Moves;
    result.Moved.row(choice.Moving[i]) = targets.row(static_cast<Index>(i));
  }
  for (Index node : choice.Held)
  {
    result.Roles[node] = IsHeld;
  }
  if (!choice.Moving.empty())
  {
    this->Place(model, choice, options, result, monitor);
  }
  leaveFree(model, choice.Held, options.Free, options.FreeNodes, result);
  return result;
}

void Surroundings::Place(const BoundaryModel& model, const Choice::Result& choice,
  const Options& options, Result& result, morph::Monitor& monitor)
{
  const std::vector<Index> sliding = options.Follow.linear ? std::vector<Index>() : options.Sliding;
  this->Slide(model, sliding, { Moves }, result);
  const Points placed = rowsOf(result.Moved, choice.Moving);
  switch (options.How)
  {
    case Kind::Follow:
    case Kind::FollowAll:
      this->Follow(model, choice, placed, options, result, monitor);
      return;
    case Kind::Fade:
      this->Fade(model, choice, placed, options.Radius, result, monitor);
      break;
    case Kind::Stay:
      break;
  }
  moveBetween(model, { Stays, Follows, IsHeld }, result);
  this->Slide(model, sliding, { Follows }, result);
}

const SurfaceShape& Surroundings::ShapeOf(const BoundaryModel& model, Index surface)
{
  const std::vector<morph::GeometrySurface>& surfaces = model.Geometry().surfaces;
  if (this->ShapesVersion != model.MotionVersion())
  {
    this->Shapes.clear();
    this->Shapes.resize(surfaces.size());
    this->ShapesVersion = model.MotionVersion();
  }
  if (!this->Shapes[surface])
  {
    this->Shapes[surface] =
      std::make_unique<SurfaceShape>(model.Points(), model.Faces(), surfaces[surface]);
  }
  return *this->Shapes[surface];
}

Eigen::RowVector3d Surroundings::Slid(const BoundaryModel& model,
  const std::vector<Index>& surfaces, Index node, const Eigen::RowVector3d& to)
{
  Eigen::RowVector3d x = to;
  for (int round = 0; round < (surfaces.size() > 1 ? 100 : 1); ++round)
  {
    const Eigen::RowVector3d before = x;
    for (const Index s : surfaces)
    {
      x = this->ShapeOf(model, s).Slid(model.Points().row(node), x);
    }
    if (x == before)
    {
      break;
    }
  }
  return x;
}

std::vector<Index> Surroundings::AbleToSlide(const BoundaryModel& model,
  const std::vector<Index>& surfaces, const Result& result, morph::Monitor& monitor)
{
  const double largest = largestDisplacement(model, result);
  std::vector<Index> able;
  std::ostringstream off;
  off.precision(3);
  for (const Index s : surfaces)
  {
    const SurfaceShape& shape = this->ShapeOf(model, s);
    double given = 0, all = 0;
    for (const Index node : model.Geometry().surfaces[s].nodes)
    {
      if (result.Roles[node] == Moves || result.Roles[node] == Follows)
      {
        const Eigen::RowVector3d to = result.Moved.row(node);
        const double distance = (shape.Slid(model.Points().row(node), to) - to).norm();
        all = std::max(all, distance);
        given = std::max(given, result.Roles[node] == Moves ? distance : 0);
      }
    }
    if (given <= OffShape * largest)
    {
      able.push_back(s);
    }
    else
    {
      off << (off.tellp() > 0 ? ", " : "") << "Surface " << model.Geometry().surfaces[s].id
          << " by " << all << " (" << 100 * all / largest << " % of the largest displacement)";
    }
  }
  if (off.tellp() > 0)
  {
    monitor.warn("What moves pulls surfaces off their own shape, which follow it: " + off.str() +
                 ". Hold them, or let the rest of the boundary stay, if that is not meant.");
  }
  return able;
}

void Surroundings::Slide(const BoundaryModel& model, const std::vector<Index>& surfaces,
  const std::vector<Role>& roles, Result& result)
{
  std::map<Index, std::vector<Index>> surfacesOf;
  for (const Index s : surfaces)
  {
    for (const Index node : model.Geometry().surfaces[s].nodes)
    {
      if (std::count(roles.begin(), roles.end(), result.Roles[node]) > 0 &&
          result.Moved.row(node) != model.Points().row(node))
      {
        surfacesOf[node].push_back(s);
      }
    }
  }
  for (const auto& [node, on] : surfacesOf)
  {
    result.Moved.row(node) = this->Slid(model, on, node, result.Moved.row(node));
  }
}

void Surroundings::Follow(const BoundaryModel& model, const Choice::Result& choice,
  const Points& targets, const Options& all, Result& result, morph::Monitor& monitor)
{
  const morph::SurfaceMorphOptions& options = all.Follow;
  Key& key = this->WeightsKey;
  if (key.MotionVersion != model.MotionVersion() || key.Neighbors != options.neighbors)
  {
    this->Weights.surfaces.clear();
  }
  key.MotionVersion = model.MotionVersion();
  key.Neighbors = options.neighbors;

  const bool touchedOnly = all.How == Kind::Follow;
  const std::vector<std::uint8_t> isTouched = touched(model, result);
  std::vector<Index> fixed = choice.Held, following;
  for (std::size_t s = 0; touchedOnly && s < isTouched.size(); ++s)
  {
    const morph::GeometrySurface& surface = model.Geometry().surfaces[s];
    const bool hasMovingFace = std::any_of(surface.faces.begin(), surface.faces.end(),
      [&](Index face) { return choice.IsMovingFace[face] != 0; });
    if (!isTouched[s])
    {
      std::copy_if(surface.nodes.begin(), surface.nodes.end(), std::back_inserter(fixed),
        [&](Index node) { return result.Roles[node] == Stays; });
    }
    else if (!hasMovingFace && !std::count(all.Sliding.begin(), all.Sliding.end(), Index(s)) &&
             !std::count(all.Free.begin(), all.Free.end(), Index(s)))
    {
      following.push_back(static_cast<Index>(s));
    }
  }
  std::sort(fixed.begin(), fixed.end());
  fixed.erase(std::unique(fixed.begin(), fixed.end()), fixed.end());
  std::vector<Index> given = choice.Moving;
  given.insert(given.end(), fixed.begin(), fixed.end());
  Points places(static_cast<Index>(given.size()), 3);
  places << targets, rowsOf(model.Points(), fixed);
  this->Local.Update(model);
  const LocalBoundary& local = this->Local;
  morph::BoundaryMotion motion = morph::beginMotion(local.Points(), local.BodyOfNode(),
    local.Faces(), local.Geometry(), local.NumbersOf(given), places);
  morph::morphCurves(local.Geometry(), options.unattached, motion, monitor);
  const morph::SurfaceMorphReport report =
    morph::morphSurfaces(local.Faces(), local.Geometry(), options, motion, monitor, &this->Weights);
  using Method = morph::SurfaceMorphOptions::Method;
  if (options.method != Method::WeightedResidual && !options.linear)
  {
    morph::smoothSurfaces(local.Faces(), local.Geometry(), nullptr, motion, monitor);
  }
  const Points moved = motion.moved();
  for (std::size_t i = 0; i < local.Nodes().size(); ++i)
  {
    const Index node = local.Nodes()[i];
    result.Moved.row(node) = moved.row(static_cast<Index>(i));
    if (motion.state[i] == morph::BoundaryMotion::Held)
    {
      result.Roles[node] = IsHeld;
    }
    else if (motion.state[i] != morph::BoundaryMotion::Given)
    {
      result.Roles[node] = Follows;
    }
  }
  moveBetween(model, { Stays, IsHeld }, result);
  if (options.linear)
  {
    return;
  }
  std::vector<Index> sliding = all.Sliding;
  if (largestDisplacement(model, result) > 0)
  {
    const std::vector<Index> able = this->AbleToSlide(model, following, result, monitor);
    sliding.insert(sliding.end(), able.begin(), able.end());
  }
  this->Slide(model, sliding, { Follows }, result);
  this->SmoothMeshes(model, sliding,
    options.method == Method::MeshSmoothing ? morph::SmoothedSurfaces::All
                                            : morph::SmoothedSurfaces::Folded,
    motion, result, monitor);
  if (!report.reflected.empty())
  {
    std::vector<Index> ids;
    for (Index s : report.reflected)
    {
      ids.push_back(model.Geometry().surfaces[s].id);
    }
    monitor.warn("The motion reflects or flattens surfaces, which follow the nearest rotation and "
                 "scale instead: surface ids " +
                 morph::listIds(ids) + ".");
  }
}

void Surroundings::SmoothMeshes(const BoundaryModel& model, const std::vector<Index>& sliding,
  morph::SmoothedSurfaces which, morph::BoundaryMotion& motion, Result& result,
  morph::Monitor& monitor)
{
  const LocalBoundary& local = this->Local;
  for (std::size_t i = 0; i < local.Nodes().size(); ++i)
  {
    const Index here = static_cast<Index>(i);
    if (result.Roles[local.Nodes()[i]] == Follows)
    {
      motion.displacement.row(here) = result.Moved.row(local.Nodes()[i]) - local.Points().row(here);
    }
  }
  std::vector<const SurfaceShape*> shapes(model.Geometry().surfaces.size(), nullptr);
  for (const Index s : sliding)
  {
    shapes[s] = &this->ShapeOf(model, s);
  }
  const ShapeTarget target(std::move(shapes));
  const Points before = motion.displacement;
  const morph::SurfaceMeshSmoothing report =
    morph::smoothSurfaceMeshes(local.Faces(), local.Geometry(), &target, which, motion, monitor);
  if (report.smoothed.empty())
  {
    return;
  }
  const Points moved = motion.moved();
  const auto hasSlid = [&](Index here)
  { return motion.displacement.row(here) != before.row(here); };
  for (std::size_t i = 0; i < local.Nodes().size(); ++i)
  {
    const Index here = static_cast<Index>(i);
    if (hasSlid(here))
    {
      result.Moved.row(local.Nodes()[i]) = moved.row(here);
    }
  }
  if (which == morph::SmoothedSurfaces::All)
  {
    return;
  }
  std::ostringstream said;
  said.precision(2);
  for (const Index s : report.smoothed)
  {
    Index count = 0;
    double most = 0;
    for (const Index here : local.Geometry().surfaces[s].nodes)
    {
      count += hasSlid(here) ? 1 : 0;
      most = std::max(most, (motion.displacement.row(here) - before.row(here)).norm());
    }
    said << (s == report.smoothed.front() ? "" : ", ") << count << " nodes of Surface "
         << model.Geometry().surfaces[s].id << " slid by up to " << most;
  }
  monitor.warn("Surfaces folded as they followed, and were smoothed: " + said.str() + ".");
}

void Surroundings::Fade(const BoundaryModel& model, const Choice::Result& choice,
  const Points& targets, double radius, Result& result, morph::Monitor& monitor)
{
  if (radius == 0)
  {
    return;
  }
  Key& key = this->FalloffKey;
  if (key.MotionVersion != model.MotionVersion() || key.Radius != radius ||
      key.Moving != choice.Moving || key.Held != choice.Held)
  {
    key = Key(); // in case it throws
    this->Others.clear();
    for (Index node : model.Faces().nodes)
    {
      if (result.Roles[node] == Stays)
      {
        this->Others.push_back(node);
      }
    }
    this->Falloff.prepare(
      rowsOf(model.Points(), choice.Moving), rowsOf(model.Points(), this->Others), radius, monitor);
    ++this->FalloffCount;
    key.MotionVersion = model.MotionVersion();
    key.Radius = radius;
    key.Moving = choice.Moving;
    key.Held = choice.Held;
  }
  const Points displacement =
    this->Falloff.evaluate(targets - rowsOf(model.Points(), choice.Moving), monitor);
  for (Index i : this->Falloff.reached())
  {
    const Index node = this->Others[i];
    result.Roles[node] = Follows;
    if (!displacement.row(i).isZero(0))
    {
      result.Moved.row(node) += displacement.row(i);
    }
  }
}

bool Surroundings::Options::operator==(const Options& other) const
{
  const auto all = [](const Options& o)
  { return std::tie(o.How, o.Follow, o.Radius, o.Sliding, o.Free, o.FreeNodes); };
  return all(*this) == all(other);
}

int Surroundings::PrepareCount() const
{
  return static_cast<int>(this->Weights.prepared) + this->FalloffCount;
}
}
