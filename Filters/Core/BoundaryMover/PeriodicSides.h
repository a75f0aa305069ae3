// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMover/BoundaryModel.h"
#include "BoundaryMover/Choice.h"
#include "BoundaryMover/Surroundings.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace morph
{
/// Surfaces that are images of each other by a translation or a rotation, and stay so: if u is the
/// displacement of a node, that of its image is R u. What moves or is held takes its image along;
/// other nodes take the mean of both.
class PeriodicSides
{
public:
  /// The names of each pair. With the same name twice its faces are parted by their directions, as
  /// front and back of a plane case that have one name.
  using Names = std::vector<std::array<std::string, 2>>;
  /// The pairs in "left = right; front = back". Throws Error for another text.
  static Names parse(const std::string& text);

  /// Finds the images at the current positions, unless the same are kept. Throws Error where nodes
  /// have none to 1e-6 of the size, or as findPatches(). Cost: a search for each node of the
  /// surfaces.
  void find(const BoundaryModel& model, const Names& names);
  /// Adds the images of what moves and is held to these. A node and its image that both move take
  /// the mean.
  void addImages(const BoundaryModel& model, Choice& choice, Points& targets) const;
  /// Moves nodes, other than those that move, are held or in a zone, with their images. Throws
  /// Error where some are free.
  void tie(const BoundaryModel& model, Surroundings::Result& result) const;

private:
  struct Image
  {
    Index from, to; ///< the same on the axis of a rotation
    std::size_t pair;
  };

  /// Gives nodes the mean with their images. `placeOf`: of a node its place, of 3 numbers, or null
  /// for it and its images. `isGiven`: whether the place stays.
  void average(const BoundaryModel& model, const std::function<double*(Index)>& placeOf,
    const std::function<bool(Index)>& isGiven) const;

  std::int64_t version_ = -1; ///< BoundaryModel::inputVersion, as sets have names
  Names names_;
  std::vector<Eigen::Matrix3d> turns_; ///< R of each pair
  std::vector<Image> images_;
};
}
