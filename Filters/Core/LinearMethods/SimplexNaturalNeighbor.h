// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Geometry/Delaunay.h"
#include "Interpolation/InterpolationSites.h"
#include "Interpolation/NaturalNeighbors.h"
#include "Interpolation/PointLocation.h"
#include "Interpolation/WeightMatrix.h"
#include "Morpher/Morpher.h"

#include <functional>
#include <vector>

namespace morph
{
/// Simplex-natural neighbor: each free node follows its natural neighbors among the prescribed
/// nodes, weighted by natural-neighbor coordinates (Staten et al., IMR 2011, section 3.4, equation
/// (8); Owen, "An implementation of natural neighbor interpolation in three dimensions", MSc
/// thesis, Brigham Young University, 1992). Smoother than simplex-linear, and independent of how
/// the Delaunay tessellation of cospherical nodes is chosen; affine motions come out exactly. It
/// takes no notice of the mesh's cells, and its weights are many: about 1000 a node within a cube
/// whose surface has 15,000 nodes.
///
/// Prescribed nodes in the same place (1e-12 of the size) count as one that moves by their mean. A
/// node on or outside the prescribed nodes' convex hull, and one whose weights rounding spoils,
/// takes the barycentric coordinates of simplex-linear.
///
/// Counts: `BarycentricNodes`, that took those; `ExtrapolatedNodes`, outside the hull by more than
/// rounding; `WeightsStored`, 1 or 0.
///
/// prepare(): 0.6 microseconds of processor time a free node and natural neighbor. The weights, 12
/// bytes each, are estimated from a sample of the nodes and kept if they stay within the memory
/// limit; evaluate() is then one pass over them. Otherwise a warning tells the number, and each
/// evaluate() and applyTranspose() recomputes them: as slow as prepare(), with the same results.
class SimplexNaturalNeighbor : public LinearMorpher
{
public:
  using Coordinates = NaturalNeighbors::Coordinates;
  /// Before prepare(). Default Sibson.
  void setCoordinates(Coordinates coordinates) { this->coordinates_ = coordinates; }
  /// Bytes that the weights may take. Before prepare(). Default 4e9.
  void setMemoryLimit(std::size_t bytes) { this->memoryLimit_ = bytes; }

  /// The sites that the numbers in weightsOf() stand for.
  const InterpolationSites& sites() const { return this->sites_; }
  /// Calls `use` with the place in NodePartition::free, the sites and the weights of one node after
  /// another, for checks.
  void forEachNode(
    const std::function<void(Index, const std::vector<std::int32_t>&, const std::vector<double>&)>&
      use) const;
  /// Bytes that prepare() keeps.
  std::size_t memory() const;

protected:
  void doPrepare(const Mesh& rest, Monitor& monitor) override;
  EvaluateReport displace(const Points& prescribed, Points& free, Monitor& monitor) const override;
  EvaluateReport displaceTranspose(
    const Points& free, Points& prescribed, Monitor& monitor) const override;

private:
  Index blocks() const;
  double estimateMemory() const;
  bool weightsOf(Index position, NaturalNeighbors::Workspace& workspace) const;
  Index computeBlock(
    Index block, NaturalNeighbors::Workspace& workspace, WeightMatrix& weights) const;
  Index forEachBlock(
    Index first, Index last, const std::function<void(Index, const WeightMatrix&)>& use) const;

  Coordinates coordinates_ = Coordinates::Sibson;
  std::size_t memoryLimit_ = 4000000000;
  InterpolationSites sites_;
  Delaunay delaunay_;
  NaturalNeighbors neighbors_;
  PointLocation enclosing_;
  std::vector<Index> order_; ///< places in NodePartition::free, along a space-filling curve
  /// one a block of nodes in that order; empty where they are recomputed
  std::vector<WeightMatrix> stored_;
  Index barycentric_ = 0;
};
}
