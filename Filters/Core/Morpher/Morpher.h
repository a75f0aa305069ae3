// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/NodePartition.h"
#include "Morpher/ShellFits.h"
#include "Support/Communicator.h"
#include "Support/Monitor.h"
#include "Support/Types.h"

#include <limits>
#include <memory>
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

/// n x 4: four scalar fields, one row per node.
using FourFields = Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>;

/// A named count that a method reports, for instance nodes that took a fall-back.
struct Statistic
{
  std::string name;
  Index value = 0;
};

/// The cost of the last evaluate or applyTranspose.
struct EvaluateReport
{
  int iterations = 0;          ///< of the iterative solver, 0 for direct formulas
  double relativeResidual = 0; ///< maximum over the three coordinates, 0 for direct formulas
  /// the same names always for a method; empty where no node is free
  std::vector<Statistic> statistics;
};

/// A morphing method. prepare() does all work that depends on the undeformed mesh and the choice of
/// prescribed nodes. evaluate() moves the mesh for one set of prescribed positions, any number of
/// times, in any order. A result depends only on the undeformed mesh, the partition, the options
/// and the prescribed positions. It never depends on the thread count or on earlier calls.
///
/// Several threads may call evaluate() and applyTranspose() of one prepared object at once, each
/// with its own Monitor and result. They get the same bits as serial calls. prepare() and the
/// setters need exclusive access.
class Morpher
{
public:
  virtual ~Morpher();

  /// Copies the undeformed points and the partition (24 bytes a node and 8 an id), and builds the
  /// method's weights, matrices or tessellation. Throws Error for a mesh or partition that the
  /// method cannot use: no prescribed node, a body without one, unknown cells, counts beyond 32
  /// bits. Without a free node the method prepares nothing. evaluate() then only moves the
  /// prescribed and higher-order nodes.
  ///
  /// `processes`: null, or several that have parts of the mesh, of which `rest` is this process's,
  /// with all cells around the nodes that count here; see Communicator. All functions are then
  /// collective, the free nodes of partition() are those that count here, and ids in messages are
  /// those of the whole mesh. Of a gradient, and of what applyTranspose() returns, the rows of
  /// nodes that count here count; the others are zero in the second.
  void prepare(const Mesh& rest, const NodePartition& partition, Monitor& monitor,
    std::shared_ptr<const Communicator> processes = nullptr);
  /// The same without copies: keeps the mesh and the partition, which must not change any more.
  void prepare(std::shared_ptr<const Mesh> rest, std::shared_ptr<const NodePartition> partition,
    Monitor& monitor, std::shared_ptr<const Communicator> processes = nullptr);

  /// Moves the mesh. `prescribed`: #prescribed x 3 new positions, in the order of
  /// NodePartition::prescribed. `moved`: becomes #nodes x 3. Prescribed nodes are exactly as given;
  /// nodes outside the partition stay. Images across a curved layer, prescribed ones too, follow
  /// the front. Without motion the undeformed positions are returned bit for bit, except by
  /// smoothing towards ideal shapes. Throws Error, leaving `moved` untouched, for a wrong number of
  /// rows, for positions, given or computed, that are not finite, or unless the last prepare()
  /// succeeded.
  EvaluateReport evaluate(const ConstPoints& prescribed, Points& moved, Monitor& monitor) const;

  /// Sets the mesh whose cell shapes the method aims for, if not the undeformed mesh. `reference`:
  /// #nodes x 3; no rows mean the undeformed mesh. Call it before prepare(). Methods that only
  /// follow the motion ignore it.
  virtual void setReference(Points reference);
  /// The layers of cells around the nodes of a process that prepare() reads there. 0: the method
  /// needs one process.
  virtual int layers() const { return 0; }

  /// A copy with the same options of a linear method that reads no cells, null of all others. Such
  /// a method interpolates between all prescribed nodes, so that motions would cross the gaps
  /// between bodies; see SiteMethod.h.
  virtual std::unique_ptr<Morpher> copyWithoutCells() const { return nullptr; }

  /// Whether prepare() of `other` reads the same options, so that a preparation serves both. That
  /// of another class never does.
  bool preparesLike(const Morpher& other) const;
  /// Takes the options that evaluate() alone reads from an object of the same class. By default
  /// there are none.
  virtual void takeEvaluateOptions(const Morpher& other);
  /// Throws Error for a mesh that the method cannot move, as one without a region to tessellate.
  /// prepare() calls it.
  virtual void requireMesh(const Mesh& /*rest*/) const {}

  const NodePartition& partition() const { return *this->partition_; }
  const Points& restPoints() const { return *this->rest_; }
  /// Those that have parts of the mesh.
  const Communicator& processes() const
  {
    return this->processes_ ? *this->processes_ : Communicator::alone();
  }

protected:
  virtual void doPrepare(const Mesh& rest, Monitor& monitor) = 0;
  /// preparesLike() for an object of the same class. By default doPrepare() reads no options.
  virtual bool hasPrepareOptionsOf(const Morpher& other) const;
  /// `prescribed`: #prescribed x 3 displacements, finite. `free`: #free x 3, receives
  /// displacements.
  virtual EvaluateReport displace(
    const Points& prescribed, Points& free, Monitor& monitor) const = 0;
  /// Warns of what is wrong with a motion as a whole, `prescribed` as above. evaluate() calls it.
  /// Modes are none: only their sums are.
  virtual void warnOf(const Points& prescribed, Monitor& monitor) const;

  /// displace() and warnOf() of another method, prepared, for one that works by others.
  ///@{
  static EvaluateReport displaceBy(
    const Morpher& method, const Points& prescribed, Points& free, Monitor& monitor)
  {
    return method.displace(prescribed, free, monitor);
  }
  static void warnBy(const Morpher& method, const Points& prescribed, Monitor& monitor)
  {
    method.warnOf(prescribed, monitor);
  }
  /// prepare() for the same partition and processes.
  void prepareAlike(Morpher& method, const Mesh& rest, Monitor& monitor) const
  {
    method.prepare(rest, this->partition(), monitor, this->processes_);
  }
  ///@}

  /// The copies of all nodes, and those that count on another process, ascending.
  ///@{
  const CopiedRows& copies() const { return *this->copies_; }
  const std::vector<Index>& countedElsewhere() const { return this->copies_->countedElsewhere(); }
  ///@}
  /// Completes displacements of the prescribed and the free nodes, #nodes x 3.
  void complete(Points& displacement) const;

  Followers higherOrderNodes_;

  /// Throws Error unless the last prepare() succeeded.
  void requirePrepared() const;

private:
  friend class LinearMorpher;
  /// On a layer, makes displacements of free nodes, or a gradient of them, those of a plane mesh.
  /// They are in the plane, and for both images of a node their mean. It is its own transpose.
  /// `free`: #free x 3.
  void keepInPlane(Points& free) const;

  void prepareFor(const Mesh& rest, std::shared_ptr<const Points> points,
    std::shared_ptr<const NodePartition> partition, Monitor& monitor);
  /// Returns #prescribed x 3; throws Error where it is not finite.
  Points displacementOf(const ConstPoints& prescribed, Monitor& monitor) const;
  template <typename Displacement>
  void place(Index node, const Displacement& displacement, Points& result) const;

  /// displace() for the rest that the affine fits of a curved layer leave, and the fits.
  EvaluateReport displaceRest(const Points& prescribed, Points& free, Monitor& monitor) const;

  bool prepared_ = false;
  std::shared_ptr<const Communicator> processes_; ///< null for one
  std::shared_ptr<const CopiedRows> copies_;      ///< of all nodes
  bool hasFree_ = false;                          ///< on any process
  bool isComplete_ = false;                       ///< prescribed and free nodes are all that move
  std::shared_ptr<const Points> rest_ = std::make_shared<Points>();
  std::shared_ptr<const NodePartition> partition_ = std::make_shared<NodePartition>();
  std::vector<Index> outside_;
  Eigen::RowVector3d normal_;                   ///< of a layer, or zero
  std::vector<std::pair<Index, Index>> images_; ///< of a layer, among the free nodes
  std::shared_ptr<const Mesh> shell_;           ///< null unless the mesh is a curved layer
  std::vector<std::pair<Index, Index>> prescribedImages_; ///< of that, among the prescribed nodes
  ShellFits fits_;
};

/// A method with a fixed matrix from prescribed to free displacements: u_free = M u_prescribed.
class LinearMorpher : public Morpher
{
public:
  /// The relative residual at which evaluate() stops; 0 for a method without an iterative solver.
  virtual double tolerance() const { return 0; }

  /// The adjoint: converts a gradient over the moved mesh to one over the prescribed positions.
  /// `gradient`: #nodes x 3, d(objective)/d(position). `prescribed`: becomes #prescribed x 3,
  /// d(objective)/d(prescribed position) = g_B + M^T g_I. Errors and cost: as evaluate().
  EvaluateReport applyTranspose(
    const ConstPoints& gradient, Points& prescribed, Monitor& monitor) const;

  /// Returns the mode of each boundary displacement: the displacement of every node of the mesh.
  /// `displacements`: #prescribed x 3 each, in the order of NodePartition::prescribed. The modes
  /// are #nodes x 3; prescribed nodes move exactly as given, and nodes outside the partition not at
  /// all. blend() adds weighted modes. `reports`: null, or becomes one report a mode. A mode does
  /// not depend on the others. Cost: one solve each, whose three coordinates share each pass over
  /// the matrix; 24 bytes a node and mode. Throws Error as evaluate() does.
  std::vector<Points> basis(const std::vector<Points>& displacements, Monitor& monitor,
    std::vector<EvaluateReport>* reports = nullptr) const;

  /// basis() of four scalar fields in one solve: a field has one number a node, which the method
  /// takes as it takes one coordinate. `prescribed`: #prescribed x 4. Returns #nodes x 4; a column
  /// does not depend on the others beyond the tolerance. `report`: null, or becomes the solve's.
  FourFields fields(
    const FourFields& prescribed, Monitor& monitor, EvaluateReport* report = nullptr) const;

protected:
  /// displace() of four scalar fields: `prescribed` #prescribed x 4, `free` #free x 4. By default
  /// in two calls of displace().
  virtual EvaluateReport displaceFields(
    const FourFields& prescribed, FourFields& free, Monitor& monitor) const;
  /// Adds M^T free to `prescribed` (#prescribed x 3); `free`: #free x 3.
  virtual EvaluateReport displaceTranspose(
    const Points& free, Points& prescribed, Monitor& monitor) const = 0;
  static EvaluateReport transposeBy(
    const LinearMorpher& method, const Points& free, Points& prescribed, Monitor& monitor)
  {
    return method.displaceTranspose(free, prescribed, monitor);
  }

private:
  Points mode(const Points& displacement, EvaluateReport& report, Monitor& monitor) const;
};
}
