// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Data/Results.h"
#include "Private/Distributed/OnRanks.h"
#include "Private/Morph/KeptMesh.h"
#include "Private/Options.h"
#include "Private/Pipeline/Steps.h"
#include "Session/Session.h"

#include <functional>
#include <memory>
#include <string>

class vtkAlgorithm;
class vtkDataArray;
class vtkDataObject;
class vtkDoubleArray;
class vtkPointSet;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace morph::filters
{
/// Morphs grids by their displaced boundary, for a filter that has dealt with its pipeline. It
/// keeps the mesh, what the method has prepared for it, and the steps of a series.
class GridMorpher
{
public:
  /// `filter`: is told of aborts, and named in messages. `results`: get those of each motion.
  GridMorpher(vtkAlgorithm* filter, Results& results);

  struct Method
  {
    MorphOptions Options;
    std::function<std::unique_ptr<morph::Morpher>()> Create; ///< see Session::Options
  };
  /// The steps of the motion, and the one that is asked for.
  struct Motion
  {
    filters::Steps Steps;
    int Step = -1;
    /// The boundary at a step, for a series alone. Null: a step has a part of the displacements.
    std::function<vtkDataObject*(int step)> Boundary = {};
  };
  using Outputs = MorphOutput::Outputs;

  /// Moves the grid and writes the outputs and results. `boundary`: displaced; of a series that of
  /// a step. `isDistributed`: the grid is a piece of a
  /// mesh on several MPI processes; then all of them call it. Returns an error that comes with a
  /// result, or nothing. Throws morph::Error.
  std::string Morph(vtkUnstructuredGrid* grid, vtkDataObject* boundary, bool isDistributed,
    const Motion& motion, const Method& method, const Outputs& outputs, morph::Monitor& monitor);
  /// After an error or an abort: makes the outputs the undeformed mesh, as far as `input` can be
  /// read, without a result.
  void WriteUndeformed(vtkDataObject* input, const char* status, const Outputs& outputs);
  /// vtkMorphAlgorithm::ApplyTranspose(). `isDistributed`: as for Morph().
  void Transpose(vtkUnstructuredGrid* rest, vtkDataObject* boundary, bool isDistributed,
    vtkDataArray* gradient, const Method& method, vtkDoubleArray* boundaryGradient,
    morph::Monitor& monitor);

  /// See Series::check(). Returns the last step up to `step` that is kept, or -1.
  int CheckSeries(std::uint64_t options, bool varies, std::uint64_t boundary, int step);
  static bool IsSeries(int stepping, const filters::Steps& steps);

private:
  vtkAlgorithm* Filter;
  filters::Results& Results;
  KeptMesh Kept;
  morph::Session Session;                         ///< of Kept
  std::unique_ptr<OnRanks::Morphing> Distributed; ///< null until the mesh is on several processes
  bool IsOnRanks = false;                         ///< the last motion was that of Distributed
  morph::Index BoundaryInverted = 0;              ///< cells for which the last motion has no result

  MotionOptions OptionsOf(const Method& method) const;
  std::string MorphAlone(vtkUnstructuredGrid* grid, vtkDataObject* boundary, const Motion& motion,
    const Method& method, const Outputs& outputs, morph::Monitor& monitor);
  OnRanks::Morphing& Ranks();
  /// Takes the cost of Session's last motion over.
  void NoteEffort();
  /// Matches the boundary, for that fraction of its motion.
  morph::BoundaryTargets Match(vtkPointSet* boundary, double fraction, const MotionOptions& options,
    morph::Monitor& monitor) const;
  std::shared_ptr<const morph::StepResult> MorphSeries(vtkPointSet* displaced, const Motion& motion,
    const MotionOptions& options, morph::Monitor& monitor);
};
}
