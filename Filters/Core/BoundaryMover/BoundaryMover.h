// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMover/BoundaryModel.h"
#include "BoundaryMover/Choice.h"
#include "BoundaryMover/Contact.h"
#include "BoundaryMover/InnerNodes.h"
#include "BoundaryMover/PeriodicSides.h"
#include "BoundaryMover/SlideRounds.h"
#include "BoundaryMover/Surroundings.h"
#include "Support/Lists.h"

#include <array>
#include <cstdint>
#include <vector>

namespace morph
{
/// Warns of nodes that are not where they were asked to be, to rounding: those that move, at
/// `targets` (of choice.moving), those that are held, and those of zones on surfaces that slide.
/// `choice`: as the user has it, before zones win over it.
void warnOfUnmet(const BoundaryModel& model, const Choice& choice, const Points& targets,
  const std::vector<Index>& sliding, const Surroundings::Result& result, Surroundings& surroundings,
  Monitor& monitor);

/// Nodes of the boundary at the places of others: of the other side of a baffle, whose body is the
/// same, or of other bodies, which are not tied to them.
class TouchingNodes
{
public:
  /// Finds them, unless the boundary is the same as before. Cost: a sort of the boundary's nodes.
  void find(const BoundaryModel& model);
  /// Lets the other sides of what moves go along, but for nodes that are held, free or on a surface
  /// that slides or is free. Returns whether there are some.
  bool addOtherSides(const BoundaryModel& model, const Surroundings::Options& rest, Choice& choice,
    Points& targets) const;
  /// Takes the sides of a place to the mean of theirs if all of them follow what moves: those of a
  /// crack's front, or of a baffle, would part if each followed its own surface.
  void joinFollowing(Surroundings::Result& result) const;
  /// Warns of nodes that the motion parts from those of other bodies, by more than rounding: their
  /// number, the surfaces of both and the largest distance.
  void warnOfParted(
    const BoundaryModel& model, const Surroundings::Result& result, Monitor& monitor) const;

private:
  std::int64_t version_ = -1;               ///< BoundaryModel::motionVersion
  std::vector<std::array<Index, 2>> pairs_; ///< of two bodies
  Adjacency sides_;                         ///< of each place the nodes of one body, if several
};

/// Moves a part of a boundary, other sides of baffles and the rest of the boundary with it, and
/// zones and layers inside. What does not depend on the motion is kept from one call to the next; a
/// result does not depend on it.
///
///     const Choice choice = choosePatches(model, { "BORE" }, { "FEET" });
///     const auto& moved = mover.move(model, choice, targets, {}, nullptr, monitor);
///     // A morph prescribes InnerNodes::prescribed(model, moved), at moved.moved of these nodes.
class BoundaryMover
{
public:
  struct Options
  {
    Surroundings::Options rest;
    std::vector<Zone> fixedZones, rigidZones; ///< of the mesh or, with pieces, of the piece
    InnerNodes::Options inner;
    SlidingWarp::Limits slide; ///< see SlideRounds
    Contact::Options contact;
    PeriodicSides::Names periodic;

    bool hasInner() const
    {
      return !this->fixedZones.empty() || !this->rigidZones.empty() || this->inner.keepLayers > 0;
    }
  };

  /// `targets`: of choice.moving, #moving x 3, finite. `pieces`: of a mesh on several processes,
  /// whose boundary alone `model` is; else null. Then this is collective. Warns of what is not met
  /// where zones, sliding and periodic surfaces win over what else is asked, and of bodies that
  /// touch and part. Throws Error as InnerNodes, SlideRounds, Contact and PeriodicSides do; then
  /// there is no result. Cost: passes over the boundary and, the first time, the weights of
  /// surfaces that follow.
  const Surroundings::Result& move(const BoundaryModel& model, const Choice& choice,
    const Points& targets, const Options& options, const InnerPieces* pieces, Monitor& monitor);

  const Surroundings::Result& result() const { return this->result_; } ///< of the last move()
  const InnerNodes& inner() const { return this->inner_; }
  const SlideRounds& rounds() const { return this->rounds_; }
  const Contact& contact() const { return this->contact_; } ///< of options.contact
  /// Whether the other sides of baffles go along in the last move().
  bool movesOtherSides() const { return this->movesOtherSides_; }
  Surroundings& surroundings() { return this->surroundings_; }
  const Surroundings& surroundings() const { return this->surroundings_; }

private:
  Surroundings surroundings_;
  InnerNodes inner_;
  SlideRounds rounds_;
  Contact contact_;
  PeriodicSides periodic_;
  TouchingNodes touching_;
  bool movesOtherSides_ = false;
  Surroundings::Result result_;
};
}
