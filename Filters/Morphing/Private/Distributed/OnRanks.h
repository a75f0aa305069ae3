// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Private/Morph/BoundaryMatch.h"
#include "Private/Morph/ModeSolver.h"
#include "Private/Morph/MorphOutput.h"
#include "Quality/Certificate.h"
#include "Quality/ScaledJacobian.h"
#include "Session/Session.h"

#include <vtkType.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

class vtkDataObject;
class vtkDoubleArray;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace morph::filters
{
class Results;

/// What filters do with a mesh whose pieces are on several MPI processes. Every function is
/// collective: all processes call it, also those without cells, and it throws morph::Error on all
/// or none of them. Not to be called unless Ranks::TakePieces().
namespace OnRanks
{
/// The steps of a motion, each of which starts from the mesh of the step before.
struct Motion
{
  int Step;    ///< the one that is asked for
  bool Varies; ///< the boundary varies in time
  std::function<double(int step)> Fraction;
  /// All processes call it for the same steps.
  std::function<vtkPointSet*(int step)> Boundary;
};

/// A distributed mesh and the method that is prepared for it, kept from one motion to the next.
class Morphing
{
public:
  virtual ~Morphing() = default;

  struct Task
  {
    vtkUnstructuredGrid* Grid; ///< this process's piece
    vtkDataObject* Boundary;   ///< this process's part of the boundary
    double Fraction;           ///< of the motion
    const Motion* Series;      ///< the relative steps instead of Boundary and Fraction, or null
    int Precision;             ///< of the points, see MorphOutput::Write()
    MorphOutput::Measures Measures;
    bool FeatureLines;
    MorphOutput::Outputs Outputs;
  };
  /// Moves the mesh and writes the outputs. Names the options that need one rank. Returns an error
  /// that comes with a result, on one process, or nothing.
  virtual std::string Run(
    const Task& task, const MotionOptions& options, morph::Monitor& monitor) = 0;
  /// The outer faces of this process's cells, if `grid` has the cells of the mesh, or else nothing.
  /// Not collective.
  virtual void WriteUndeformedSurface(vtkUnstructuredGrid* grid, vtkPolyData* surface) const = 0;
  /// vtkMorphAlgorithm::ApplyTranspose(). `gradient`: of the piece's points, those of copies as of
  /// the node. Points of several processes that stand for one node get the same derivatives.
  virtual void Transpose(vtkUnstructuredGrid* rest, vtkDataObject* boundary, vtkDataArray* gradient,
    const MotionOptions& options, vtkDoubleArray* boundaryGradient, morph::Monitor& monitor) = 0;
};
/// `results`: gets the numbers of the whole mesh on all processes. `session`: gets the mesh.
std::unique_ptr<Morphing> MakeMorphing(Results& results, morph::Session& session);

/// The mesh and method of vtkMorphShapes.
std::unique_ptr<ModeSolver> MakeModeSolver();

/// Writes the outer faces of the whole mesh that belong to this process's cells, as
/// Surface::Write() does, with global ids.
void ExtractBoundary(vtkUnstructuredGrid* grid, vtkPolyData* output, morph::Monitor& monitor);

/// The quality of the mesh; see vtkScaledJacobian.
struct Measured
{
  morph::Quality Whole;                  ///< the numbers of the whole mesh, without cells
  std::vector<morph::Index> Unmeasured;  ///< Quality::Unmeasured() of the whole mesh
  morph::CertificateReport Certificates; ///< counts of the whole mesh
  morph::Index MirroredBodies = 0;
};
/// Measures the mesh, also by `criteria`, and, if `certified`, examines it; `output` becomes the
/// grid with the arrays.
Measured Measure(vtkUnstructuredGrid* grid, bool certified,
  std::vector<Quality::OfCriterion>& criteria, vtkUnstructuredGrid* output,
  morph::Monitor& monitor);
}
}
