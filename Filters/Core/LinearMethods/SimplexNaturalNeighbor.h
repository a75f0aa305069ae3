// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Geometry/Delaunay.h"
#include "Interpolation/InterpolationSites.h"
#include "Interpolation/NaturalNeighbors.h"
#include "Interpolation/PointLocation.h"
#include "Interpolation/WeightMatrix.h"
#include "Mesh/ShellLayer.h"
#include "Morpher/Morpher.h"

#include <functional>
#include <memory>
#include <vector>

namespace morph
{
/// Simplex-natural neighbor: free nodes follow prescribed ones, weighted by natural neighbor
/// coordinates. It is smoother than simplex-linear and does not depend on the tessellation of
/// cospherical nodes; affine motions are exact. It ignores the mesh's cells, and its weights are
/// many: about 1000 a node within a cube whose surface has 15,000 nodes. Sources: Staten et al.,
/// IMR 2011, section 3.4, equation (8); Owen, "An implementation of natural neighbor interpolation
/// in three dimensions", MSc thesis, Brigham Young University, 1992.
///
/// Coincident prescribed nodes (1e-12 of the size) count as one that moves by their mean. A node
/// takes the barycentric coordinates of simplex-linear if it is on or outside the prescribed nodes'
/// convex hull, or if rounding spoils its weights.
///
/// Counts: `BarycentricNodes`, which take these coordinates; `ExtrapolatedNodes`, outside the hull
/// by more than rounding; `WeightsStored`, 1 or 0.
///
/// prepare(): 0.6 microseconds of processor time a free node and natural neighbor. A sample of the
/// nodes estimates the weights' memory, 12 bytes each. Within the memory limit they are kept, and
/// evaluate() is one pass over them. Otherwise a warning tells the estimate, and each evaluate()
/// and applyTranspose() recomputes them, as slowly as prepare() and with the same results.
class SimplexNaturalNeighbor : public LinearMorpher
{
public:
  /// Sets the maximum number of bytes for the weights. Call it before prepare(). Default 4e9.
  void setMemoryLimit(std::size_t bytes) { this->memoryLimit_ = bytes; }

  std::unique_ptr<Morpher> copyWithoutCells() const override
  {
    return std::make_unique<SimplexNaturalNeighbor>(*this);
  }
  void requireMesh(const Mesh& rest) const override { requireRegion(rest); }

protected:
  void doPrepare(const Mesh& rest, Monitor& monitor) override;
  bool hasPrepareOptionsOf(const Morpher& other) const override
  {
    return this->memoryLimit_ == static_cast<const SimplexNaturalNeighbor&>(other).memoryLimit_;
  }
  EvaluateReport displace(const Points& prescribed, Points& free, Monitor& monitor) const override;
  EvaluateReport displaceTranspose(
    const Points& free, Points& prescribed, Monitor& monitor) const override;

private:
  using Workspace = NaturalNeighbors::Workspace; ///< buffers of one thread, and its result

  Index blocks() const;
  double estimateMemory() const;
  bool weightsOf(Index position, Workspace& workspace) const;
  Index computeBlock(Index block, Workspace& workspace, WeightMatrix& weights) const;
  Index forEachBlock(
    Index first, Index last, const std::function<void(Index, const WeightMatrix&)>& use) const;

  std::size_t memoryLimit_ = 4000000000;
  InterpolationSites sites_;
  Delaunay delaunay_;
  NaturalNeighbors neighbors_;
  PointLocation enclosing_;
  std::vector<Index> order_; ///< indices in NodePartition::free, along a space-filling curve
  /// one a block of nodes in this order; empty if they are recomputed
  std::vector<WeightMatrix> stored_;
  Index barycentric_ = 0;
};
}
