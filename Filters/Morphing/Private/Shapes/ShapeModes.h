// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Morpher/Blend.h"
#include "Morpher/Morpher.h"
#include "Private/Morph/BoundaryMatch.h"
#include "Private/Morph/KeptMesh.h"
#include "Quality/LargestFactor.h"
#include "Quality/ValidRange.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

class vtkPointSet;
class vtkUnstructuredGrid;

namespace morph::filters
{
/// The mesh, a linear method prepared for it, and the displacement fields of shapes. All are kept
/// from one execution to the next, under their content; none of it has an effect on the result.
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
    /// A text that differs for any two settings of the method.
    std::string Method;
    std::function<std::unique_ptr<morph::LinearMorpher>()> CreateMorpher;
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

  /// Copies the grid, unless it is the same as the kept one; returns whether it was copied.
  bool SetGrid(vtkUnstructuredGrid* grid, morph::Monitor& monitor);
  const KeptMesh& GetKept() const { return this->Kept; }
  /// See KeptMesh. After SetGrid().
  void SetFeatureLines(bool on) { this->Kept.SetFeatureLines(on); }

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
  /// nodes' positions. `gradient`: #nodes x 3.
  std::vector<double> Derivatives(const std::vector<double>& weights, const morph::Points& gradient,
    morph::Monitor& monitor) const;
  /// Whether the range of a weight in which cells stay valid can be found: not of polyhedra, whose
  /// centres are no polynomials of it.
  bool HasRanges() const;
  bool IsRotation(std::size_t shape) const { return this->Shapes[shape].Angle > 0; }
  /// The motion by the weight of one shape. `base`: #nodes x 3, the mesh at a weight of 0.
  morph::NodeMotion MotionOf(std::size_t shape, const morph::Points& base) const;
  /// The motion by a factor of all weights. `straight`: gets the displacements' sum; the result
  /// points to it.
  morph::CombinedMotion Combined(
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

  std::vector<BoundaryMatch::Result> Match(
    const std::vector<Shape>& shapes, const Options& options, morph::Monitor& monitor);
  /// Adds the boundary displacements of one shape to `modes`, not solved.
  Solved Describe(const Shape& shape, const BoundaryMatch::Result& match,
    const std::vector<morph::Index>& prescribed, double tolerance, std::vector<Mode>& modes) const;
  void Prepare(const std::vector<morph::Index>& prescribed, const Options& options, Effort& effort,
    morph::Monitor& monitor);

  KeptMesh Kept;
  std::unique_ptr<morph::LinearMorpher> Method; ///< prepared for Kept under MethodOptions, or null
  std::string MethodOptions;
  std::vector<Mode> Modes;    ///< of Method
  std::vector<Solved> Shapes; ///< of the last Solve()
  std::vector<std::string> Warnings;
};
}
