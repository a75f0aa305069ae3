// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/HigherOrderNodes.h"
#include "Mesh/Mesh.h"
#include "Mesh/NodePartition.h"
#include "Support/Monitor.h"

#include <string>
#include <vector>

namespace morph
{
/// A number that the method found worth telling, for instance how many nodes took a fall-back.
struct Statistic
{
  std::string name;
  Index value = 0;
};

/// What the last evaluate or applyTranspose took.
struct EvaluateReport
{
  int iterations = 0;          ///< of the iterative solver, 0 for direct formulas
  double relativeResidual = 0; ///< largest over the three coordinates, 0 for direct formulas
  double bytesMoved = 0;       ///< estimate of the memory traffic, for benchmarks
  /// always the same names for a method; none where no node is free
  std::vector<Statistic> statistics;
};

/// A morphing method, one subclass per method. prepare() does all that depends on the undeformed
/// mesh and on which nodes are prescribed; evaluate() moves the mesh for one set of prescribed
/// positions and may be called any number of times, in any order: a result depends on the
/// undeformed mesh, the partition, the options and the prescribed positions alone, never on the
/// thread count or on earlier calls.
///
/// Several threads may call evaluate(), and applyTranspose(), of one prepared object at once, each
/// with its own Monitor and its own result: they get the same bits as one after another. prepare()
/// and the setters need the object for themselves.
class Morpher
{
public:
  virtual ~Morpher();

  /// Keeps a copy of the rest points and of the partition (24 bytes per node and 8 per id) and lets
  /// the method make its weights, matrices or tessellation. Throws Error for a mesh or partition it
  /// cannot work with: no prescribed node, a body without one, cells it does not know, more
  /// than 32 bits can number. Without a
  /// free node every place is known: the method prepares nothing then, and evaluate() only moves
  /// the prescribed nodes and their followers.
  void prepare(const Mesh& rest, const NodePartition& partition, Monitor& monitor);

  /// `prescribed`: #prescribed x 3 new positions, in the order of NodePartition::prescribed.
  /// `moved`: becomes #nodes x 3; prescribed nodes exactly as given, nodes outside the partition at
  /// rest. Where nothing moves the rest positions come back bit for bit (smoothing towards ideal
  /// shapes apart). Throws Error, leaving `moved` untouched, for a wrong number of rows, positions
  /// that are not finite, given or found, or where no prepare() has succeeded last.
  EvaluateReport evaluate(const ConstPoints& prescribed, Points& moved, Monitor& monitor) const;

  /// For methods that aim for the shapes the cells have in some mesh, where that is not the
  /// undeformed mesh: `reference`, #nodes x 3, their nodes there. Before prepare(); no rows: the
  /// undeformed mesh. Ignored by methods that only follow the motion.
  virtual void setReference(Points reference);

  const NodePartition& partition() const { return this->partition_; }
  const Points& restPoints() const { return this->rest_; }

protected:
  virtual void doPrepare(const Mesh& rest, Monitor& monitor) = 0;
  /// `prescribed`: #prescribed x 3 displacements, finite. `free`: #free x 3, to be filled with
  /// displacements.
  virtual EvaluateReport displace(
    const Points& prescribed, Points& free, Monitor& monitor) const = 0;

  HigherOrderNodes higherOrderNodes_;

  /// Throws Error unless the last prepare() succeeded.
  void requirePrepared() const;

private:
  /// #prescribed x 3; throws Error where it is not finite.
  Points displacementOf(const ConstPoints& prescribed, Monitor& monitor) const;
  template <typename Displacement>
  void place(Index node, const Displacement& displacement, Points& result) const;

  bool prepared_ = false;
  Points rest_;
  NodePartition partition_;
  std::vector<Index> outside_;
};

/// A method whose free displacements are a fixed matrix times the prescribed ones: x_free = M
/// x_prescribed.
class LinearMorpher : public Morpher
{
public:
  /// The adjoint. `gradient`: #nodes x 3, d(objective)/d(position) of every node of the moved mesh.
  /// `prescribed`: becomes #prescribed x 3, d(objective)/d(prescribed position), the prescribed
  /// nodes' own gradient included: g_B + M^T g_I. Errors and cost: as evaluate().
  EvaluateReport applyTranspose(
    const ConstPoints& gradient, Points& prescribed, Monitor& monitor) const;

protected:
  /// `free`: #free x 3; adds M^T free to `prescribed` (#prescribed x 3).
  virtual EvaluateReport displaceTranspose(
    const Points& free, Points& prescribed, Monitor& monitor) const = 0;
};
}
