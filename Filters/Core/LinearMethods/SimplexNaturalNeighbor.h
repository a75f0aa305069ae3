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
/// Coarsening bounds the neighbors' number, for large meshes. A node at the distance d from the
/// nearest site takes the neighbors among a subset of the sites: each site is within `coarsening` d
/// of one in the subset. So the motion of single sites reaches only the nodes near them. Subsets
/// have 1 / sqrt(2) of each other's spacing (FarthestPoints.h). Weights are blended between two of
/// them, so they stay continuous. They still sum to 1 and reproduce affine motions. A subset
/// whose hull does not contain the node is left out for the next finer.
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
  using Coordinates = NaturalNeighbors::Coordinates;
  /// Call it before prepare(). Default Sibson.
  void setCoordinates(Coordinates coordinates) { this->coordinates_ = coordinates; }
  /// Sets the spacing of the sites that a node sees, over its distance from the nearest site. 0:
  /// all sites. Range [0, 1]. Call it before prepare(). Default 0.
  void setCoarsening(double coarsening) { this->coarsening_ = coarsening; }
  /// Sets the maximum number of bytes for the weights. Call it before prepare(). Default 4e9.
  void setMemoryLimit(std::size_t bytes) { this->memoryLimit_ = bytes; }

  /// Returns the sites that the numbers in weightsOf() denote.
  const InterpolationSites& sites() const { return this->sites_; }
  /// Calls `use` for each node with its index in NodePartition::free, its sites and weights, for
  /// checks.
  void forEachNode(
    const std::function<void(Index, const std::vector<std::int32_t>&, const std::vector<double>&)>&
      use) const;
  /// Returns the bytes that prepare() keeps.
  std::size_t memory() const;

protected:
  void doPrepare(const Mesh& rest, Monitor& monitor) override;
  EvaluateReport displace(const Points& prescribed, Points& free, Monitor& monitor) const override;
  EvaluateReport displaceTranspose(
    const Points& free, Points& prescribed, Monitor& monitor) const override;

private:
  /// A subset of the sites.
  struct Level
  {
    double spacing;                  ///< no site is farther from the subset
    std::vector<std::int32_t> sites; ///< ascending
    Delaunay delaunay;
    NaturalNeighbors neighbors;
  };
  /// Buffers of one thread, for all sites and for each level, and its result.
  struct Workspace
  {
    explicit Workspace(const SimplexNaturalNeighbor& method);
    NaturalNeighbors::Workspace all;
    std::vector<NaturalNeighbors::Workspace> levels;
    std::vector<std::int32_t> sites;
    std::vector<double> weights;
  };

  void buildLevels(Monitor& monitor);
  void measureDistances(Monitor& monitor);
  bool levelWeights(Index place, std::size_t level, double factor, Workspace& workspace) const;
  bool coarseWeights(Index place, Workspace& workspace) const;
  bool allWeights(Index place, NaturalNeighbors::Workspace& workspace) const;
  Index blocks() const;
  double estimateMemory() const;
  bool weightsOf(Index position, Workspace& workspace) const;
  Index computeBlock(Index block, Workspace& workspace, WeightMatrix& weights) const;
  Index forEachBlock(
    Index first, Index last, const std::function<void(Index, const WeightMatrix&)>& use) const;

  Coordinates coordinates_ = Coordinates::Sibson;
  std::size_t memoryLimit_ = 4000000000;
  double coarsening_ = 0;
  std::vector<Level> levels_; ///< the finest first, each with sqrt(2) of the spacing of the last
  std::vector<double> distances_; ///< of each free node from the nearest site; empty without levels
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
