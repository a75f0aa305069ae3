// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Data/Results.h"
#include "Private/Morph/MorphOutput.h"
#include "Private/Morph/SerialMesh.h"
#include "Private/Options.h"
#include "Private/Pipeline/Steps.h"
#include "Session/Session.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

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
  /// a step. `isDistributed`: the grid is a piece of a mesh on several MPI processes, and the
  /// boundary a part of it; then all of them call it, also those without cells. Returns an error
  /// that comes with a result, on one process, or nothing. Throws morph::Error, on all or none.
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
  std::unique_ptr<KeptMesh> Alone = std::make_unique<SerialMesh>();
  std::unique_ptr<KeptMesh> Distributed; ///< null until the mesh is on several processes
  bool IsOnRanks = false;                ///< Kept() is Distributed
  morph::Session Session;                ///< of Kept()
  morph::Index BoundaryInverted = 0;     ///< cells for which the last motion has no result

  MotionOptions OptionsOf(const Method& method) const;
  /// The mesh of the last motion.
  KeptMesh& Kept() const { return *(this->IsOnRanks ? this->Distributed : this->Alone); }
  /// Takes the mesh of this motion.
  void Take(vtkUnstructuredGrid* grid, bool isDistributed, const MotionOptions& options,
    morph::Monitor& monitor);
  /// Takes the cost of Session's last motion over.
  void NoteEffort();
  /// Matches the boundary, for that fraction of its motion.
  morph::BoundaryTargets Match(vtkPointSet* boundary, double fraction, const MotionOptions& options,
    morph::Monitor& monitor, BoundaryMatch::Followers* followers = nullptr) const;
  std::shared_ptr<const morph::StepResult> MorphSeries(vtkPointSet* displaced, const Motion& motion,
    const MotionOptions& options, morph::Monitor& monitor);
};
}
