// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "BoundaryMorphing/BoundaryMotion.h"
#include "BoundaryMorphing/SurfaceResidual.h"
#include "Mesh/Topology.h"
#include "Support/Monitor.h"

#include <vector>

namespace morph
{
/// Moves the `free` nodes of one surface by u + r. u is the affine field that fits the motion of
/// the `fixed` nodes, and r is the discrete harmonic extension of their residuals. At each free
/// corner r is the mean of its neighbors', weighted by 1 / undeformed edge length. So r never
/// exceeds the residuals around the surface, affine motions are exact, and a curved surface keeps
/// its shape. A mid-side or face node has the mean r of its corners.
///
/// `faceIds`: the surface's faces; `fixed`, `free`: its nodes, ascending. Cost: one sparse solve a
/// surface.
void extendHarmonically(const BoundaryFaces& faces, const std::vector<Index>& faceIds,
  const std::vector<Index>& fixed, const std::vector<Index>& free, BoundaryMotion& motion,
  Monitor& monitor);

/// Moves the nodes of all curves that are not given: each keeps its parameter on the moved curve.
/// Vertices, and nodes given on curves and surfaces, keep their positions.
///
/// A node at parameter t between the known nodes (or vertices) a and b, t_a <= t <= t_b, moves by
///   u(x) + (1 - s) (U_a - u(x_a)) + s (U_b - u(x_b)),   s = (t - t_a) / (t_b - t_a),
/// where u is the affine field that fits the motion around the curve.
///
/// On a straight curve by arc length u cancels, and U is linear in t. On a curved one u maps its
/// shape, so affine motions are exact. u fits the first set whose affine span contains the curve.
/// The sets are the known nodes of the curve, of its adjacent surfaces, of its body. If none does,
/// u has minimum norm; a body without known nodes stays.
///
/// A closed curve without a known node follows the nodes of the same sets by `unattached`. Without
/// motion the result is exactly zero. It does not depend on the order of curves.
///
/// Returns the number of known nodes that the fits summed. Cost: linear in the boundary for any
/// number of curves. The sums of a surface and of a body are computed once; see KnownMotion.
Index morphCurves(const Classification& geometry, UnattachedMotion unattached,
  BoundaryMotion& motion, Monitor& monitor);

/// Returns the closed chains of corners (node ids) around `some` faces, in the direction of the
/// faces. The outer chain is counter-clockwise around the normals, holes are clockwise. Each chain
/// starts at its lowest node; these order the chains. The result is empty for closed surfaces, for
/// opposite windings, and for rims that touch in a node.
std::vector<std::vector<Index>> boundaryLoops(
  const BoundaryFaces& faces, const std::vector<Index>& some);

struct SurfaceMorphOptions
{
  enum class Method : std::uint8_t
  {
    WeightedResidual,  ///< the paper's choice: SurfaceResidual.h
    HarmonicExtension, ///< SurfaceMorph.h
    MeshSmoothing      ///< the same; then call smoothSurfaceMeshes()
  };
  Method method = Method::WeightedResidual;
  Index neighbors = 20; ///< number for the weighted residual, at least 1
  UnattachedMotion unattached = UnattachedMotion::FollowAffinely;
  /// Only the part of the weighted residual that is linear in the displacements, see
  /// SurfaceResidual::evaluateLinear(); `method` has no effect.
  bool linear = false;

  bool operator==(const SurfaceMorphOptions& other) const
  {
    return this->method == other.method && this->neighbors == other.neighbors &&
           this->unattached == other.unattached && this->linear == other.linear;
  }
};

struct SurfaceMorphReport
{
  /// surfaces whose affine map reflects or flattens them; they took the nearest similarity
  std::vector<Index> reflected;
  std::vector<Index> unattached; ///< surfaces without known nodes; they moved by `unattached`
};

/// The weights of the weighted residual, kept between calls of morphSurfaces(). They are valid for
/// one undeformed mesh, one classification and one number of neighbors. A surface's weights are
/// reused while the same of its nodes are fixed. Assign an empty object if anything else changes.
struct SurfaceWeights
{
  struct Surface
  {
    std::vector<Index> fixed; ///< the nodes that `residual` is prepared for; empty for none
    SurfaceResidual residual;
  };
  std::vector<Surface> surfaces; ///< #surfaces, or none yet
  Index prepared = 0;            ///< number of surfaces whose weights were computed
};

/// Moves the unknown nodes of all surfaces. Each surface moves by itself; nodes of its curves and
/// vertices, and given nodes on it, are fixed. Call it after morphCurves(). A surface without known
/// nodes (closed, without curves) follows the known nodes of its body by options.unattached, and
/// stays where there are none. A surface whose known nodes do not move stays exactly. `kept`:
/// reused weights, or null; the result is the same. Throws Error as SurfaceResidual does. Cost:
/// that of the method on each surface.
SurfaceMorphReport morphSurfaces(const BoundaryFaces& faces, const Classification& geometry,
  const SurfaceMorphOptions& options, BoundaryMotion& motion, Monitor& monitor,
  SurfaceWeights* kept = nullptr);
}
