// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMover/BoundaryMover.h"

#include "BoundaryMover/Patches.h"
#include "Support/Error.h"
#include "Support/Lists.h"
#include "Support/Monitor.h"

#include <algorithm>
#include <functional>
#include <map>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace morph
{
namespace
{
constexpr double Rounding = 1e-9; // of the boundary's size

/// Nodes, and the largest distance of one. Images across a shell do not count.
class Off
{
public:
  explicit Off(const BoundaryModel& model)
    : layer_(model.mesh.layer)
    , rounding_(Rounding * model.size)
  {
  }
  void add(Index node, double distance)
  {
    if (distance > this->rounding_ && this->layer_.frontOf(node) == node)
    {
      this->nodes_.push_back(node);
      this->largest_ = std::max(this->largest_, distance);
    }
  }
  void write(const char* what, std::ostream& text)
  {
    if (!this->nodes_.empty())
    {
      std::sort(this->nodes_.begin(), this->nodes_.end());
      text << " " << this->nodes_.size() << " nodes that " << what << " by up to " << this->largest_
           << ": point ids " << listIds(this->nodes_) << ".";
    }
  }

private:
  const ShellLayer& layer_;
  double rounding_;
  std::vector<Index> nodes_;
  double largest_ = 0;
};
}

void warnOfUnmet(const BoundaryModel& model, const Choice& choice, const Points& targets,
  const std::vector<Index>& sliding, const Surroundings::Result& result, Surroundings& surroundings,
  Monitor& monitor)
{
  Off moving(model), held(model), off(model);
  for (std::size_t i = 0; i < choice.moving.size(); ++i)
  {
    const Index node = choice.moving[i];
    moving.add(node, (result.moved.row(node) - targets.row(static_cast<Index>(i))).norm());
  }
  for (const Index node : choice.held)
  {
    held.add(node, (result.moved.row(node) - model.points().row(node)).norm());
  }
  for (const Index s : sliding)
  {
    for (const Index node : model.geometry.surfaces[s].nodes)
    {
      if (result.roles[node] == Surroundings::IsZone)
      {
        const Eigen::RowVector3d to = result.moved.row(node);
        off.add(node, (surroundings.slid(model, { s }, model.points().row(node), to) - to).norm());
      }
    }
  }
  std::ostringstream text;
  text.precision(3);
  moving.write("move miss their places", text);
  held.write("are held move", text);
  off.write("slide leave their surfaces", text);
  if (!text.str().empty())
  {
    monitor.warn(
      "Zones, sliding and periodic surfaces win over what else is asked of the boundary." +
      text.str() + " Leave these nodes out of one or the other if that is not meant.");
  }
}

void TouchingNodes::find(const BoundaryModel& model)
{
  if (this->version_ == model.motionVersion)
  {
    return;
  }
  this->version_ = model.motionVersion;
  this->pairs_.clear();
  this->sides_ = {};
  const auto key = [&](Index n)
  {
    const auto x = model.points().row(n);
    return std::make_tuple(x[0], x[1], x[2], model.bodyOfNode[n], n);
  };
  std::vector<Index> nodes = model.faces.nodes;
  std::sort(nodes.begin(), nodes.end(), [&](Index a, Index b) { return key(a) < key(b); });
  auto first = nodes.begin(); // of those of one body at one place
  for (auto node = nodes.begin(); node != nodes.end(); ++node)
  {
    const auto next = node + 1;
    const bool isAtPlace =
      next != nodes.end() && model.points().row(*node) == model.points().row(*next);
    if (isAtPlace && model.bodyOfNode[*node] == model.bodyOfNode[*next])
    {
      continue;
    }
    if (isAtPlace)
    {
      this->pairs_.push_back({ *node, *next });
    }
    if (next - first > 1)
    {
      this->sides_.add(first, next);
    }
    first = next;
  }
}

bool TouchingNodes::addOtherSides(const BoundaryModel& model, const Surroundings::Options& rest,
  Choice& choice, Points& targets) const
{
  if (this->sides_.values.empty())
  {
    return false;
  }
  std::vector<Index> left = choice.held;
  left.insert(left.end(), rest.freeNodes.begin(), rest.freeNodes.end());
  for (const auto* surfaces : { &rest.sliding, &rest.free })
  {
    for (const Index surface : *surfaces)
    {
      const std::vector<Index>& nodes = model.geometry.surfaces[surface].nodes;
      left.insert(left.end(), nodes.begin(), nodes.end());
    }
  }
  sortUnique(left);
  TargetOfNode moving = targetsOf(choice, targets);
  const std::size_t before = moving.size();
  for (std::size_t place = 0; place + 1 < this->sides_.offsets.size(); ++place)
  {
    const Index* end = this->sides_.end(static_cast<Index>(place));
    const Index* begin = this->sides_.begin(static_cast<Index>(place));
    const Index* from = std::find_if(begin, end, [&](Index n) { return moving.count(n) > 0; });
    for (const Index* to = begin; to != end && from != end; ++to)
    {
      if (!std::binary_search(left.begin(), left.end(), *to))
      {
        moving.try_emplace(*to, moving.at(*from));
      }
    }
  }
  if (moving.size() == before)
  {
    return false;
  }
  setMoving(moving, choice, targets);
  markMovingFaces(model.faces, choice);
  return true;
}

void TouchingNodes::joinFollowing(const BoundaryModel& model, Surroundings::Result& result) const
{
  const auto follows = [&](Index n) { return result.roles[n] == Surroundings::Follows; };
  std::map<Index, Eigen::RowVector3d> change; // of joined nodes
  for (std::size_t place = 0; place + 1 < this->sides_.offsets.size(); ++place)
  {
    const Index* begin = this->sides_.begin(static_cast<Index>(place));
    const Index* end = this->sides_.end(static_cast<Index>(place));
    if (!std::all_of(begin, end, follows))
    {
      continue;
    }
    const Eigen::RowVector3d first = result.moved.row(*begin); // equal places stay, bit by bit
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    std::for_each(begin, end, [&](Index n) { sum += result.moved.row(n) - first; });
    const Eigen::RowVector3d mean = first + sum / static_cast<double>(end - begin);
    for (const Index* n = begin; n != end; ++n)
    {
      change[*n] = mean - result.moved.row(*n);
      result.moved.row(*n) = mean;
    }
  }
  for (std::size_t i = 0; i < model.faces.nodes.size() && !change.empty(); ++i)
  {
    const Index node = model.faces.nodes[i];
    if (follows(node) && change.count(node) == 0)
    {
      result.moved.row(node) += meanBetween(model.faces, static_cast<Index>(i), model.points(),
        [&](Index corner)
        { return change.count(corner) > 0 ? change[corner] : Eigen::RowVector3d::Zero(); });
    }
  }
}

void TouchingNodes::warnOfParted(
  const BoundaryModel& model, const Surroundings::Result& result, Monitor& monitor) const
{
  double most = 0;
  std::vector<Index> parted;
  for (const auto& [a, b] : this->pairs_)
  {
    const double distance = (result.moved.row(a) - result.moved.row(b)).norm();
    if (distance > Rounding * model.size)
    {
      most = std::max(most, distance);
      parted.insert(parted.end(), { a, b });
    }
  }
  if (parted.empty())
  {
    return;
  }
  std::sort(parted.begin(), parted.end());
  std::string surfaces;
  for (std::size_t s = 0; s < model.geometry.surfaces.size(); ++s)
  {
    const std::vector<Index>& faces = model.geometry.surfaces[s].faces;
    const auto isParted = [&](Index n)
    { return std::binary_search(parted.begin(), parted.end(), n); };
    const auto corner = model.faces.connectivity.begin();
    if (std::any_of(faces.begin(), faces.end(),
          [&](Index f)
          {
            return std::all_of(
              corner + model.faces.offsets[f], corner + model.faces.offsets[f + 1], isParted);
          }))
    {
      surfaces +=
        (surfaces.empty() ? "" : ", ") + surfaceName(model.geometry, static_cast<Index>(s));
    }
  }
  std::ostringstream text;
  text << "Bodies touch and are not tied: " << parted.size()
       << " nodes part from nodes of other bodies at their places, by up to " << most
       << (surfaces.empty() ? "" : ", on ") << surfaces
       << ". `ContactDistance` lets a body follow one that it touches: a length above 0 ties "
          "nodes at one place.";
  monitor.warn(text.str());
}

const Surroundings::Result& BoundaryMover::move(const BoundaryModel& model, const Choice& choice,
  const Points& targets, const Options& options, const InnerPieces* pieces, Monitor& monitor)
{
  // What the boundary alone decides is the same on all processes.
  const auto alike = [pieces](const std::function<void()>& work)
  { pieces ? pieces->together(work) : work(); };
  const bool hasInner = options.hasInner();
  Surroundings::Result last = std::exchange(this->result_, {}); // nothing is left if it throws
  Surroundings::Result result;
  Choice chosen = choice; // with what zones, baffles, periodic sides and contact add
  Points places = targets;
  this->inner_.clear();
  if (hasInner)
  {
    this->inner_.take(model, options.fixedZones, options.rigidZones, pieces);
  }
  // Of the last spread alone: one that is repeated, with more that moves, stands in place of those
  // before.
  QuietRange spreading(monitor, 0, options.slide.rounds > 0 ? 0.8 : 1);
  alike(
    [&]
    {
      if (hasInner)
      {
        this->inner_.constrain(model, options.inner, chosen, places);
      }
      this->touching_.find(model);
      this->movesOtherSides_ = this->touching_.addOtherSides(model, options.rest, chosen, places);
      this->periodic_.find(model, options.periodic);
      this->periodic_.addImages(model, chosen, places);
      result =
        this->surroundings_.spread(model, chosen, places, options.rest, spreading, std::move(last));
      if (options.contact.distance > 0)
      {
        this->contact_.find(model, options.contact);
        while (this->contact_.follow(model, result, chosen, places))
        {
          spreading.take();
          this->movesOtherSides_ |=
            this->touching_.addOtherSides(model, options.rest, chosen, places);
          result = this->surroundings_.spread(
            model, chosen, places, options.rest, spreading, std::move(result));
        }
      }
      this->touching_.joinFollowing(model, result);
    });
  if (hasInner)
  {
    result.motionVersion = -1; // inner nodes move, too
    this->inner_.place(model, chosen, options.inner, result, monitor);
    const std::vector<std::string> before = spreading.take();
    bool isAgain = false;
    alike(
      [&] {
        isAgain = this->inner_.spreadAround(model, chosen, places, options.rest, result, spreading);
      });
    for (const std::string& warning : isAgain ? std::vector<std::string>() : before)
    {
      spreading.warn(warning);
    }
  }
  for (const std::string& warning : spreading.take())
  {
    monitor.warn(warning);
  }
  this->rounds_.clear();
  if (options.slide.rounds > 0)
  {
    ProgressRange sliding(monitor, 0.8, 1);
    this->rounds_.run(model, chosen.held, options.rest.sliding, options.slide, this->surroundings_,
      pieces, this->inner_, result, sliding);
  }
  alike([&] { this->periodic_.tie(model, result); });
  if (hasInner || !options.rest.sliding.empty() || !options.periodic.empty())
  {
    alike(
      [&]
      {
        warnOfUnmet(
          model, choice, targets, options.rest.sliding, result, this->surroundings_, monitor);
      });
  }
  if (options.contact.distance > 0)
  {
    alike([&] { this->contact_.warnOfLost(model, choice, result, monitor); });
    this->contact_.setRoles(result);
  }
  else
  {
    alike([&] { this->touching_.warnOfParted(model, result, monitor); });
  }
  this->result_ = std::move(result);
  return this->result_;
}
}
