// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Geometry/RotationFit.h"
#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Morpher/Blend.h"
#include "Morpher/Morpher.h"
#include "Private/Morph/BoundaryMatch.h"
#include "Private/Morph/ModeSolver.h"
#include "Private/Pipeline/Ranks.h"
#include "Quality/ValidRange.h"

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

class vtkPointSet;
class vtkUnstructuredGrid;

namespace morph::filters
{
/// The mesh, a linear method prepared for it, and the displacement fields of shapes. All are kept
/// from one execution to the next, under their content; none of it has an effect on the result. The
/// mesh may have pieces on several MPI processes: then all of these make the same calls, functions
/// that take a monitor throw on all or none, and results are those of the whole mesh.
class ShapeModes
{
public:
  struct Shape
  {
    std::string Name;        ///< for messages
    vtkPointSet* Boundary;   ///< displaced
    bool IsRotation = false; ///< to be taken as a rotation about its axis
  };
  struct Options
  {
    BoundaryMatch::Options Matching;
    ModeSolver::CreateMorpher CreateMorpher;
  };
  /// The work of one call of Solve().
  struct Effort
  {
    int Preparations = 0;
    int Solved = 0; ///< displacement fields
    int Iterations = 0;
    double Seconds = 0;
    morph::Index Prescribed = 0; ///< nodes
  };

  /// Takes the grid, unless it is the same as the kept one; returns whether it did.
  /// `isDistributed`: all processes have pieces of it, and call this.
  bool SetGrid(
    vtkUnstructuredGrid* grid, bool isDistributed, const Options& options, morph::Monitor& monitor);
  /// The mesh and the method, or null before SetGrid().
  const ModeSolver* GetSolver() const { return this->Solver.get(); }
  /// The processes with pieces of the mesh.
  const RankGroup& Group() const { return this->Processes; }
  const morph::Mesh& Mesh() const { return this->Solver->Mesh(); }
  const std::vector<std::int8_t>& Orientation() const { return this->Solver->Rest().orientation(); }
  /// See KeptMesh. After SetGrid().
  void SetFeatureLines(bool on, morph::Monitor& monitor)
  {
    this->Solver->SetFeatureLines(on, monitor);
  }

  /// Solves for the displacement fields of shapes that are not kept, and forgets others. A node
  /// that any shape names is prescribed; in shapes that do not name it, it stays. Throws
  /// morph::Error as BoundaryMatch does, naming the shape, and for a shape that is to be a rotation
  /// and is none.
  Effort Solve(const std::vector<Shape>& shapes, const Options& options, morph::Monitor& monitor);
  /// Those of the last Solve(), which it has told.
  const std::vector<std::string>& GetWarnings() const { return this->Warnings; }
  /// The displacement fields of the shapes of the last Solve(), with their weights. `weights`:
  /// #shapes; of a rotation, the factor of its angle.
  std::vector<morph::WeightedMode> Weighted(const std::vector<double>& weights) const;
  /// The fields and angles of the shapes: where both are the same, so is every blend.
  std::vector<std::shared_ptr<const morph::Points>> Fields() const;
  std::vector<double> Angles() const;
  /// The derivatives of an objective with respect to the weights, from those with respect to the
  /// nodes' positions. `gradient`: #nodes of the grid x 3; where several points stand for a node,
  /// each has that of the node.
  std::vector<double> Derivatives(const std::vector<double>& weights, const morph::Points& gradient,
    morph::Monitor& monitor) const;
  bool IsRotation(std::size_t shape) const { return this->Shapes[shape].Angle > 0; }
  /// The motion by the weight of one shape. `base`: #nodes x 3, the mesh at a weight of 0.
  morph::NodeMotion MotionOf(std::size_t shape, const morph::Points& base) const;
  /// The motion by a factor of all weights. `straight`: gets the displacements' sum; the result
  /// points to it.
  morph::NodeMotion Combined(
    const std::vector<double>& weights, morph::Points& straight, morph::Monitor& monitor) const;

private:
  /// A displacement of the boundary and its field.
  struct Mode
  {
    morph::Points Boundary;                     ///< #prescribed x 3
    std::shared_ptr<const morph::Points> Field; ///< #nodes x 3; null until it is solved
  };
  struct Solved
  {
    std::vector<std::size_t> Modes; ///< one, or the two of a rotation
    double Angle = 0;               ///< of a rotation in radians; 0 for a displacement
  };

  std::vector<morph::BoundaryTargets> Match(
    const std::vector<Shape>& shapes, const Options& options, morph::Monitor& monitor);
  /// Adds the boundary displacements of one shape to `modes`, not solved.
  Solved Describe(const Shape& shape, const morph::BoundaryTargets& match,
    const std::vector<morph::Index>& prescribed, double tolerance, std::vector<Mode>& modes) const;
  void Prepare(const std::vector<morph::Index>& prescribed, const Options& options, Effort& effort,
    morph::Monitor& monitor);
  /// Warns of prescribed nodes that the fields of `modes` put elsewhere, as they hang.
  void TellDropped(const std::vector<Mode>& modes, const std::vector<morph::Index>& prescribed,
    morph::Monitor& monitor);
  /// For each of `modes` the number of the kept mode that is the same on all processes, or -1.
  std::vector<int> FindKept(const std::vector<Mode>& modes) const;
  /// The rotation of the nodes that move, and their rows of `displacement`.
  std::pair<morph::AxisRotation, std::vector<morph::Index>> RotationOf(
    const morph::Points& displacement, const std::vector<morph::Index>& prescribed,
    double tolerance) const;

  RankGroup Processes{ false };
  std::unique_ptr<ModeSolver> Solver;
  std::vector<morph::Index> PreparedFor;                ///< the nodes, of Solver
  std::unique_ptr<const morph::LinearMorpher> Settings; ///< of Solver; null: it is not prepared
  std::vector<Mode> Modes;                              ///< of Solver
  std::vector<Solved> Shapes;                           ///< of the last Solve()
  std::vector<std::string> Warnings;
};
}
