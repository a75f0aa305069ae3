// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryShapes.h"

#include "Boundary/Classification.h"
#include "BoundaryMorphing/BoundaryMotion.h"
#include "Mesh/Topology.h"

namespace shapes
{
/// A mesh with its boundary, classified.
struct ClassifiedShape
{
  morph::Mesh mesh;
  morph::BoundaryFaces faces;
  morph::Classification geometry;

  explicit ClassifiedShape(const morph::Mesh& m, const morph::ClassificationOptions& options = {});

  /// Boundary nodes of a dimension of at most `highest`.
  std::vector<Index> upTo(int highest) const;
  /// A motion that prescribes the nodes `ids`, where `map` takes them.
  morph::BoundaryMotion begin(
    const std::vector<Index>& ids, const std::function<Row(const Row&)>& map) const;
  /// A motion that prescribes vertices and curves, where `map` takes them. Surfaces are not moved.
  morph::BoundaryMotion withEdgesMoved(const std::function<Row(const Row&)>& map) const;
};
}
