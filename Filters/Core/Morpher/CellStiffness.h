// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace morph
{
/// How stiff each cell is for a method that treats the mesh as a continuum. Stiff cells keep their
/// shape at the expense of the others. Only ratios count.
struct CellStiffness
{
  enum class Kind
  {
    Uniform,       ///< the method as published
    InverseVolume, ///< 1 / volume: small cells are stiff
    /// 1 / distance from `walls`: cells near them are stiff. The distance of a cell is that of its
    /// center from the nearest wall node, at least 1e-3 of the mesh's mean distance.
    WallDistance
  };
  Kind kind = Kind::Uniform;
  double exponent = 1;        ///< power of volume or distance, in [0, 4]
  std::vector<Index> walls;   ///< node ids; none: all prescribed nodes
  std::vector<double> values; ///< #cells, positive, multiply the kind's; none: 1
  std::string noWalls = {};   ///< the error where there are no walls; empty: no error
  bool areWallsGlobal = true; ///< not numbers in this part of a distributed mesh

  bool operator==(const CellStiffness& other) const;
};

/// What a linear method has that knows the stiffness of cells. It stays linear, affine motions stay
/// exact, and it has an adjoint, whatever the stiffness.
class StiffMethod
{
public:
  virtual ~StiffMethod() = default;

  /// Call it before prepare(), which throws Error for values or walls that do not fit the mesh.
  /// Default Uniform.
  void setStiffness(CellStiffness stiffness) { this->stiffness_ = std::move(stiffness); }
  const CellStiffness& stiffness() const { return this->stiffness_; }

  /// Nodes from this id on are centers of polyhedra and of their faces. A method may eliminate them
  /// before it solves, where the stiffness is uniform. Call it before prepare(). Default: none is
  /// such a center.
  void setFirstCenter(Index node) { this->firstCenter_ = node; }
  Index firstCenter() const { return this->firstCenter_; }

private:
  Index firstCenter_ = std::numeric_limits<Index>::max();
  CellStiffness stiffness_;
};
}
