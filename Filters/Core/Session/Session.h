// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearMethods/AttachedNodes.h"
#include "Mesh/Mesh.h"
#include "Mesh/NodePartition.h"
#include "Morpher/AffineModes.h"
#include "Morpher/Morpher.h"
#include "Quality/MovableQuality.h"
#include "Session/BoundaryTargets.h"
#include "Session/UndeformedMesh.h"
#include "Session/Validity.h"
#include "Support/Error.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace morph
{
/// The mesh of one motion, with the numbers of its computation.
struct StepResult
{
  Points moved; ///< #nodes x 3
  Validity::Outcome valid;
  int iterations = 0;                ///< of the method's solver
  std::vector<Statistic> statistics; ///< the method's own, and PostSmoothSteps
  Index prescribed = 0;              ///< nodes
  Index unmatched = 0;               ///< see BoundaryTargets
  Index attached = 0;                ///< nodes; see AttachedNodes.h
  std::vector<Index> loose;          ///< ids; see AttachedNodes.h
  /// Of an inverted mesh: the cells that the boundary inverts at corners that no free node can
  /// mend.
  Index boundaryInverted = 0;
  /// The minimum scaled Jacobian at corners whose nodes are all prescribed; NaN without one.
  double boundaryMinimum = std::numeric_limits<double>::quiet_NaN();
};

/// The meshes of a run in which each step starts from the mesh of the step before. As many are kept
/// as the memory allows: the last one, and of the others every first, second, fourth, ... Going
/// back costs fewer steps than that number.
class Series
{
public:
  using Step = std::shared_ptr<const StepResult>;

  void clear();
  /// Clears if a number is not that of the last call: `options` tells the state of the options,
  /// `boundary` that of a boundary that varies from step to step. VTK's times of modification are
  /// such numbers.
  void check(std::uint64_t options, bool varies, std::uint64_t boundary);
  /// Keeps a step's mesh, and drops others if necessary. `megabytes`: the memory for all meshes in
  /// 10^6 bytes; the last one is kept besides.
  void keep(int number, Step step, double megabytes);
  /// The nearest step that is kept, `number` itself or one before it: its number, or -1 and null.
  std::pair<int, Step> lastUntil(int number) const;

private:
  std::map<int, Step> kept_;
  int stride_ = 1;
  /// the last step: the only kept one that may be between strides
  int last_ = 0;
  using State = std::tuple<std::uint64_t, bool, std::uint64_t>;
  State state_; ///< of the last check()

  /// Drops all but every stride_-th and the last one.
  void thin();
};

/// Returns what `work` does. Its errors name the step.
template <typename Work>
auto inStep(int step, const Work& work)
{
  const std::string subject = "Step " + std::to_string(step) + ": ";
  try
  {
    return work();
  }
  catch (const Validity::Infeasible& infeasible)
  {
    throw Validity::Infeasible(subject + infeasible.what(), infeasible.cells);
  }
  catch (const Error& error)
  {
    throw Error(error.kind(), subject + error.what());
  }
}

/// A mesh, the method prepared for it, and the steps of a series, kept from one motion to the next:
///
///     Session session;
///     session.setMesh(mesh, monitor);
///     Session::Options options;
///     options.createMorpher = [] { return std::make_unique<FemWarp>(); };
///     options.validity = Validity::Mode::Repair;
///     const auto step = session.morph({ ids, targets }, options, monitor);
///     // step->moved has the new points, step->valid.status says how it ended
///
/// A result depends on the mesh, the options and the motion alone, never on the motions before it.
/// Lengths are in the unit of the mesh. What is wrong throws Error, which names node or cell ids
/// and what to do; a warning goes to the monitor. One thread at a time may use a session; a monitor
/// gives it more.
///
/// The mesh may be on several processes (UndeformedMesh::Part). All functions but setMesh() and
/// steps() are collective then; nodes are those of this process's part, with all copies, while
/// numbers and messages are those of the whole mesh. Warnings are those of the first process.
class Session
{
public:
  struct Options
  {
    /// Makes a method with all its options, not prepared.
    std::function<std::unique_ptr<Morpher>()> createMorpher;
    std::string method = "The method"; ///< in messages
    Validity::Mode validity = Validity::Mode::Report;
    /// Whether cells are measured; false only with a validity that changes nothing.
    bool measureAll = true;
    Index maximumSubSteps = 64;
    /// Whether the mesh is smoothed before its validity is seen to, and by how many steps at most.
    ///@{
    bool postSmooth = false;
    int postSmoothIterations = 20;
    ///@}
    double stepMemoryLimit = 1000; ///< 10^6 bytes; see Series::keep()

    /// Returns createMorpher(). `onPieces`: for the pieces of polyhedra; see adaptToPieces().
    std::unique_ptr<Morpher> settings(bool onPieces) const;
  };

  /// A boundary's own description of its motion: the targets are the undeformed places and
  /// affineDisplacement(). A linear method keeps its answer to the fields, so that a motion with
  /// the same fields costs one pass over the nodes.
  struct AffineHandle
  {
    AffineFields fields; ///< #ids x 4
    AffineMotion motion;
  };

  /// The cost of morph(), morphSeries() and transpose(), until the caller takes it by setting it
  /// back to {}: the seconds of the last motion or step, NaN for what was not reached.
  struct Effort
  {
    double prepareSeconds = std::numeric_limits<double>::quiet_NaN();  ///< 0: it was prepared
    double evaluateSeconds = std::numeric_limits<double>::quiet_NaN(); ///< with all that follows
    int preparations = 0;
  };
  Effort effort;

  /// Takes a mesh, and forgets all that was kept unless it is the same object. The first throws
  /// Error as validate(), both as UndeformedMesh; the kept mesh stays then.
  ///@{
  void setMesh(Mesh mesh, Monitor& monitor);
  void setMesh(std::shared_ptr<const UndeformedMesh> mesh);
  ///@}
  const UndeformedMesh& mesh() const { return *this->mesh_; }
  /// Warns of what is odd about the mesh: bodies that are mirrored, cells that were inverted before
  /// or are there twice, and nodes where bodies touch.
  void reportMesh(const Options& options, Monitor& whole) const;

  /// Does the part of morph() that depends on the prescribed nodes alone, ascending. Throws Error
  /// as morph().
  void prepare(const std::vector<Index>& ids, const Options& options, Monitor& monitor);
  /// Moves the mesh. `handle`: of the boundary, or null. Nodes that the boundary does not prescribe
  /// are free, those of the outer faces, too. Throws Error for ids that do not exist, occur twice
  /// or do not ascend, and for another number of targets. Also where targets or results are not
  /// finite or beyond 1e50, and as the method and Validity do. Cost: Morpher::prepare(), if the
  /// prescribed nodes or the method's options are others than before; Morpher::evaluate();
  /// Validity::ensure().
  std::shared_ptr<StepResult> morph(const BoundaryTargets& boundary, const Options& options,
    Monitor& monitor, const AffineHandle* handle = nullptr);
  /// Takes the steps up to `step` >= 0, from the last one that is kept: each starts from the mesh
  /// of the step before. `boundaryOf`: returns the boundary of a step. `whole`: the whole motion,
  /// whose change drops what is kept, or null: then the caller tells changes by Series::check().
  /// Errors name the step, but for those of `boundaryOf`. Memory: a mesh, and the steps that are
  /// kept.
  std::shared_ptr<const StepResult> morphSeries(int step,
    const std::function<BoundaryTargets(int step)>& boundaryOf, const BoundaryTargets* whole,
    const Options& options, Monitor& monitor);
  /// The steps that are kept.
  Series& steps() { return this->steps_; }

  /// The adjoint of a linear method with these prescribed nodes. `gradient`: #nodes x 3, the
  /// derivatives of an objective with respect to the positions of the moved nodes. Returns #ids x
  /// 3, those with respect to the targets, of the method alone: smoothing and repairs have none.
  /// Throws Error for a method that is not linear, and as morph(). Cost: as morph().
  Points transpose(
    const std::vector<Index>& ids, Points gradient, const Options& options, Monitor& monitor);

private:
  const Communicator& all() const { return this->mesh_->all(); }
  bool countsHere(Index node) const;
  std::vector<Index> counting(const std::vector<Index>& nodes) const; ///< those that count here
  /// The last step until `number` that all processes keep: their memory may differ.
  std::pair<int, Series::Step> lastUntil(int number) const;
  StepResult morphStep(const Mesh& from, const BoundaryTargets& boundary,
    const AffineHandle* handle, const Options& options, Monitor& monitor);
  /// Prepares modes_ for the handle, and returns the method that they are of. Null without a
  /// handle, or for a method that has none.
  const LinearMorpher* preparedModes(const AffineHandle* handle, Monitor& monitor);
  /// The partition with these prescribed nodes, kept while they stay.
  const NodePartition& partitionOf(const std::vector<Index>& prescribed);
  /// Prepares the method for the mesh, with its own points or others, and for partition_, unless it
  /// is prepared. Sets its other options.
  void prepareFor(const Mesh& from, const Options& options, Monitor& monitor);

  std::shared_ptr<const UndeformedMesh> mesh_ = std::make_shared<UndeformedMesh>();
  /// of mesh_, or empty
  std::shared_ptr<const NodePartition> partition_ = std::make_shared<NodePartition>();
  std::shared_ptr<const CopiedRows> copies_; ///< of mesh_; null without a partition
  AttachedNodes attached_;                   ///< of mesh_ and partition_
  std::unique_ptr<MovableQuality> samples_;  ///< of the same, or null
  std::unique_ptr<Morpher> method_;          ///< prepared for mesh_ under settings_, or null
  bool methodIsOfMesh_ = false;              ///< not of a step's points
  bool methodIsCurved_ = false; ///< of a curved layer, or a plane one that leaves its plane
  std::unique_ptr<const Morpher> settings_;
  AffineModes modes_; ///< of method_

  Series steps_;
  BoundaryTargets whole_; ///< the whole motion, for steps_, of one that has it
};
}
