// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/Surroundings.h"

#include "BoundaryMorphing/CurveMorph.h"
#include "BoundaryMorphing/SurfaceSmoothing.h"
#include "Support/Error.h"

#include <algorithm>

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

/// Moves mid-side and face nodes that neither move nor are held with their corners. Otherwise the
/// edges between moved and fixed corners would bend.
void moveBetween(const BoundaryModel& model, Surroundings::Result& result)
{
  const morph::BoundaryFaces& faces = model.Faces();
  for (std::size_t i = 0; i < faces.nodes.size(); ++i)
  {
    const Index node = faces.nodes[i], k = static_cast<Index>(i);
    const Index *begin = faces.between.begin(k), *end = faces.between.end(k);
    if (begin == end || result.Roles[node] == Surroundings::Moves ||
        result.Roles[node] == Surroundings::IsHeld)
    {
      continue;
    }
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (const Index* corner = begin; corner != end; ++corner)
    {
      sum += result.Moved.row(*corner) - model.Points().row(*corner);
    }
    const bool moves = !sum.isZero(0);
    result.Roles[node] = moves ? Surroundings::Follows : Surroundings::Stays;
    result.Moved.row(node) = model.Points().row(node);
    if (moves)
    {
      result.Moved.row(node) += sum / static_cast<double>(end - begin);
    }
  }
}
}

Surroundings::Result Surroundings::Spread(const BoundaryModel& model, const Choice::Result& choice,
  const Points& targets, const Options& options, morph::Monitor& monitor)
{
  Result result;
  result.Moved = model.Points();
  result.Roles.assign(model.Points().rows(), Stays);
  for (std::size_t i = 0; i < choice.Moving.size(); ++i)
  {
    result.Roles[choice.Moving[i]] = Moves;
    result.Moved.row(choice.Moving[i]) = targets.row(static_cast<Index>(i));
  }
  for (Index node : choice.Held)
  {
    result.Roles[node] = IsHeld;
  }
  if (choice.Moving.empty())
  {
    return result;
  }
  switch (options.How)
  {
    case Kind::Follow:
      this->Follow(model, choice, targets, options.Follow, result, monitor);
      return result;
    case Kind::Fade:
      this->Fade(model, choice, targets, options.Radius, result, monitor);
      break;
    case Kind::Stay:
      break;
  }
  moveBetween(model, result);
  return result;
}

void Surroundings::Follow(const BoundaryModel& model, const Choice::Result& choice,
  const Points& targets, const morph::SurfaceMorphOptions& options, Result& result,
  morph::Monitor& monitor)
{
  Key& key = this->WeightsKey;
  if (key.MotionVersion != model.MotionVersion() || key.Neighbors != options.neighbors)
  {
    this->Weights.surfaces.clear();
  }
  key.MotionVersion = model.MotionVersion();
  key.Neighbors = options.neighbors;

  std::vector<Index> given = choice.Moving;
  given.insert(given.end(), choice.Held.begin(), choice.Held.end());
  Points places(static_cast<Index>(given.size()), 3);
  places << targets, rowsOf(model.Points(), choice.Held);
  morph::BoundaryMotion motion = morph::beginMotion(
    model.Points(), model.BodyOfNode(), model.Faces(), model.Geometry(), given, places);
  morph::morphCurves(model.Geometry(), options.unattached, motion, monitor);
  const morph::SurfaceMorphReport report =
    morph::morphSurfaces(model.Faces(), model.Geometry(), options, motion, monitor, &this->Weights);
  if (options.method == morph::SurfaceMorphOptions::Method::HarmonicExtension)
  {
    morph::smoothSurfaces(model.Faces(), model.Geometry(), nullptr, motion, monitor);
  }
  result.Moved = motion.moved();
  for (Index node : model.Faces().nodes)
  {
    if (motion.state[node] == morph::BoundaryMotion::Held)
    {
      result.Roles[node] = IsHeld;
    }
    else if (motion.state[node] != morph::BoundaryMotion::Given)
    {
      result.Roles[node] = Follows;
    }
  }
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

int Surroundings::PrepareCount() const
{
  return static_cast<int>(this->Weights.prepared) + this->FalloffCount;
}
}
