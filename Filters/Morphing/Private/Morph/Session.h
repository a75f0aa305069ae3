// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LinearMethods/AttachedNodes.h"
#include "Mesh/Mesh.h"
#include "Mesh/NodePartition.h"
#include "Morpher/AffineModes.h"
#include "Morpher/Morpher.h"
#include "Private/Data/Results.h"
#include "Private/Morph/AffineHandle.h"
#include "Private/Morph/BoundaryMatch.h"
#include "Private/Morph/KeptMesh.h"
#include "Private/Morph/Series.h"
#include "Quality/MovableQuality.h"

#include <vtkType.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

class vtkDataArray;
class vtkDataObject;
class vtkDoubleArray;
class vtkPointSet;
class vtkUnstructuredGrid;

namespace morph::filters
{
/// A mesh, the method prepared for it, and the steps of a series, kept from one motion to the next.
/// It knows no pipeline: its inputs come with the motion.
class Session
{
public:
  struct Options
  {
    std::string Method; ///< named in messages
    BoundaryMatch::Options Matching;
    int Validity = 0;       ///< vtkMorphAlgorithm::ValidityType
    bool MeasureAll = true; ///< false only with a validity that changes nothing
    int MaximumSubSteps = 0;
    bool PostSmooth = false;
    int PostSmoothIterations = 0;
    double StepMemoryLimit = 0; ///< megabytes
    bool IsFloat = false;       ///< the result is rounded to single precision
    /// Makes a method with all its options.
    std::function<std::unique_ptr<morph::Morpher>()> CreateMorpher;
  };

  /// The steps of a motion, each of which starts from the mesh of the step before.
  struct Motion
  {
    int Step = 0;        ///< the one that is asked for
    bool Varies = false; ///< the boundary varies in time
    std::function<double(int step)> Fraction;
    std::function<vtkPointSet*(int step)> Boundary;
  };

  /// `results`: gets the seconds, the number of preparations and of mirrored bodies.
  explicit Session(filters::Results& results)
    : Results(results)
  {
  }

  /// Copies the grid, unless it is the same as the kept one.
  void SetGrid(vtkUnstructuredGrid* grid, morph::Monitor& monitor);
  const KeptMesh& GetKept() const { return this->Kept; }
  /// See KeptMesh. After SetGrid().
  void SetFeatureLines(bool on) { this->Kept.SetFeatureLines(on); }
  /// Warns of what is odd about the mesh: bodies that are mirrored, cells that were inverted before
  /// or are there twice, and nodes where bodies touch.
  void ReportMesh(const Options& options, morph::Monitor& monitor);

  /// Moves the mesh by that fraction of the boundary's motion.
  std::shared_ptr<StepResult> Morph(
    vtkPointSet* boundary, double fraction, const Options& options, morph::Monitor& monitor);
  /// Takes the steps up to the one that is asked for, from the last one that is kept.
  std::shared_ptr<const StepResult> MorphSeries(
    const Motion& motion, const Options& options, morph::Monitor& monitor);
  /// vtkMorphAlgorithm::ApplyTranspose(). Throws morph::Error.
  void Transpose(vtkUnstructuredGrid* rest, vtkDataObject* boundary, vtkDataArray* gradient,
    const Options& options, vtkDoubleArray* boundaryGradient, morph::Monitor& monitor);

  /// See Series::Check().
  void CheckSeries(vtkMTimeType options, bool varies, vtkMTimeType boundary)
  {
    this->Steps.Check(options, varies, boundary);
  }
  /// The last step up to this one that is kept, or -1.
  int LastStepUntil(int step) const { return this->Steps.LastUntil(step).first; }

private:
  /// Matches the boundary, for that fraction of its motion.
  BoundaryMatch::Result Match(
    vtkPointSet* boundary, double fraction, const Options& options, morph::Monitor& monitor) const;
  /// `handle`: of the match, or nothing. `first`, `last`: of the progress.
  StepResult MorphStep(const morph::Mesh& from, const BoundaryMatch::Result& match,
    const std::optional<AffineHandle>& handle, const Options& options, double first, double last,
    morph::Monitor& monitor);
  /// Moves the mesh by the prepared method, by its modes where a handle has some.
  morph::EvaluateReport Evaluate(const BoundaryMatch::Result& match,
    const std::optional<AffineHandle>& handle, morph::Points& moved, morph::Monitor& monitor);
  /// The partition with these prescribed nodes, kept while they stay.
  const morph::NodePartition& PartitionOf(const std::vector<morph::Index>& prescribed);
  /// Prepares the method for the mesh, with its own points or others, and for Partition, unless it
  /// is prepared. Sets its other options.
  void Prepare(const morph::Mesh& from, const Options& options, morph::Monitor& monitor);

  filters::Results& Results;
  KeptMesh Kept;
  /// Of Kept, or empty.
  std::shared_ptr<const morph::NodePartition> Partition = std::make_shared<morph::NodePartition>();
  morph::AttachedNodes Attached;                  ///< of Kept and Partition
  std::unique_ptr<morph::MovableQuality> Samples; ///< of the same, or null
  std::unique_ptr<morph::Morpher> Method;         ///< prepared for Kept under Settings, or null
  bool MethodIsOfKept = false;                    ///< not of a step's points
  std::unique_ptr<const morph::Morpher> Settings;
  morph::AffineModes Modes; ///< of Method

  Series Steps;
  BoundaryMatch::Result Whole; ///< the whole motion, for Steps, of one that does not
};
}
