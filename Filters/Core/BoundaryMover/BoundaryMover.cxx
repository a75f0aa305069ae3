// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryMover/BoundaryMover.h"

#include "Support/ProgressRange.h"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace morph
{
const Surroundings::Result& BoundaryMover::move(const BoundaryModel& model, const Choice& choice,
  const Points& targets, const Options& options, const InnerPieces* pieces, Monitor& monitor)
{
  // What the boundary alone decides is the same on all processes.
  const auto alike = [pieces](const std::function<void()>& work)
  { pieces ? pieces->together(work) : work(); };
  const bool hasInner = options.hasInner();
  Surroundings::Result last = std::exchange(this->result_, {}); // nothing is left if it throws
  Surroundings::Result result;
  Choice chosen = choice; // with what zones and contact add
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
          result = this->surroundings_.spread(
            model, chosen, places, options.rest, spreading, std::move(result));
        }
      }
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
