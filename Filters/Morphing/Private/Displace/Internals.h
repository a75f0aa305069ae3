// SPDX-License-Identifier: BSD-3-Clause
// What a filter that displaces a boundary keeps from one execution to the next, and one execution.
#pragma once

#include "vtkDisplacementAlgorithm.h"

#include "BoundaryMover/BoundaryMover.h"
#include "Private/Blocks/Blocks.h"
#include "Private/Data/Unchanged.h"
#include "Private/Displace/BoundaryFields.h"
#include "Private/Displace/Chosen.h"
#include "Private/Displace/ControlPoints.h"
#include "Private/Displace/InputBoundary.h"
#include "Private/Displace/Motion.h"
#include "Private/Displace/Pick.h"
#include "Private/Displace/Selection.h"
#include "Private/Displace/Zones.h"
#include "Private/Distributed/WholeSurface.h"
#include "Private/Options.h"
#include "Private/Pipeline/Input.h"
#include "Private/Pipeline/Monitor.h"
#include "Private/Project/TargetData.h"

#include <vtkAbstractTransform.h>
#include <vtkDataArraySelection.h>
#include <vtkDoubleArray.h>
#include <vtkExtractSelection.h>
#include <vtkImplicitFunction.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

struct vtkDisplacementAlgorithm::vtkInternals
{
  using Options = morph::DisplacementOptions;

  /// The properties that are objects or lists.
  ///@{
  vtkSmartPointer<vtkImplicitFunction> Region, ZoneRegion;
  vtkSmartPointer<vtkAbstractTransform> Transform, RigidTransform;
  vtkSmartPointer<vtkExtractSelection> Extractor;
  std::vector<std::array<double, 7>> Handles;
  std::vector<std::array<double, 6>> LatticeDisplacements;
  morph::filters::Picker Picker;
  ///@}

  /// The lists of surfaces and zones, of Model, of this version of it; -1: of none.
  ///@{
  vtkNew<vtkDataArraySelection> SurfaceList, ZoneList;
  vtkNew<vtkStringArray> SurfaceSizes, SurfaceShapes, ZoneSizes;
  vtkNew<vtkDoubleArray> SurfaceBounds;
  vtkIdType ListedVersion = -1;
  ///@}

  morph::filters::Blocks Blocks; ///< of the mesh
  morph::filters::InputBoundary Model;
  morph::filters::FittedTarget Fit;
  morph::BoundaryMover Mover;
  /// The boundary of a mesh on several MPI processes, of which Model is then; else null.
  std::unique_ptr<morph::filters::WholeSurface> Whole;
  /// Handles, or the lattice, of the last motion, and the undeformed points of the lattice.
  ///@{
  vtkNew<vtkPolyData> ControlPoints;
  vtkNew<vtkDoubleArray> LatticePoints;
  ///@}
  vtkNew<vtkPolyData> Displaced; ///< the whole boundary, as the last execution has displaced it

  /// Results of the last execution: the points of each Surroundings::Role, and a text.
  ///@{
  std::array<vtkIdType, morph::Surroundings::IsLayer + 1> Count = {};
  std::string SlideReport, ContactReport;
  double PresentDimension = 0; ///< of DISPLACEMENT_DIMENSION, else 0
  int ChooseCount = 0;         ///< of all executions
  ///@}

  /// Solutions while something is dragged need be no finer than a picture.
  static constexpr double DragTolerance = 1e-5;
  bool IsDragged = false;

  vtkInternals() { this->ResetResults(); }
  void ResetResults();
  void ClearList();
  /// Finds the boundary and its geometry, and the names of patches and zones. `input`: as
  /// Blocks.Gather() returns it; not a mesh without cells.
  void List(const Options& options, vtkDataObject* input);
  /// Finds SurfaceShapes, unless it has those of the list.
  void ListShapes();

  /// What the ports hold; each may be null.
  struct Inputs
  {
    vtkSelection* Selection;      ///< of what moves
    vtkDataObject* Target;        ///< of DISPLACEMENT_TARGET
    vtkSelection* Zone;           ///< of a zone
    vtkDataObject* ControlPoints; ///< of DISPLACEMENT_HANDLES and DISPLACEMENT_LATTICE
    vtkDataObject* Field;         ///< of DISPLACEMENT_FIELD
  };
  static Inputs InputsOf(vtkInformationVector** inputVector);
  /// See filters::Time: of these inputs.
  static void WarnOfSeries(
    vtkInformationVector** inputVector, vtkInformation* output, morph::Monitor& monitor);

  /// Displaces the boundary of a mesh, or a boundary that was extracted before. Of a mesh on
  /// several MPI processes each gets the part that its cells have; then all processes call it. The
  /// output stays empty where another process has the mesh. Throws morph::Error.
  void Displace(const Options& options, const morph::filters::Input::Mesh& mesh,
    const Inputs& inputs, vtkPolyData* output, morph::Monitor& monitor);

  /// The zones of that kind. `grid`: the mesh of Model, or this process's piece of it. After
  /// Displace(). Collective on ranks.
  std::vector<morph::filters::Zones::Part> FindZones(morph::filters::Zones::Kind kind,
    vtkUnstructuredGrid* grid, const morph::filters::Zones::Options& zones) const;
  morph::filters::Zones::Options ZoneOptions(const Options& options, vtkSelection* zone);

  /// Whether the messages of this process are shown: what is wrong with a boundary that all have is
  /// told once.
  bool IsTeller() const;

private:
  morph::filters::Unchanged Checked; ///< the input, where it is a grid
  /// The faces of a shell that moves as a whole, and the input that they are of.
  ///@{
  vtkSmartPointer<vtkPolyData> Shell;
  const vtkDataObject* ShellOf = nullptr; ///< compared, never used
  vtkMTimeType ShellTime = 0;
  bool IsShellClosed = false;
  ///@}
  morph::filters::BlockSelection Selected, ZoneSelected;
  std::vector<std::string> Warnings; ///< of the geometry, not reported yet
  vtkIdType ChosenVersion = -1;      ///< of Model, that Choice is of
  morph::filters::Chosen::Options ChosenBy;
  morph::Choice Choice;
  morph::filters::BoundaryFields Fields;
  std::vector<std::uint8_t> IsSelected; ///< #nodes of Whole, of MOVING_SELECTION
  /// The displacements of DISPLACEMENT_FIELD, and what they depend on: the field, its time and
  /// array, the reach, the version of Model, and ChooseCount. Unused with Whole.
  ///@{
  std::tuple<const vtkDataObject*, vtkMTimeType, std::string, double, vtkIdType, int> FieldOrigin;
  morph::Points FieldValues;
  ///@}

  /// What moves, and how the rest of the boundary does.
  struct Moves
  {
    morph::Points Given, Targets;
    morph::filters::Motion::Options Motion;
    morph::Choice Choice;
    morph::BoundaryMover::Options Mover;
  };
  void Classify(const Options& options, vtkPointSet* input, morph::Monitor& monitor);
  void ListZones();
  /// The faces of a shell that goes to a target as a whole; null for all others.
  vtkPolyData* WholeShell(const Options& options, vtkUnstructuredGrid* grid, bool hasTarget);
  /// `input`: with the whole boundary; `grid`: the mesh, or this process's piece of it; null for a
  /// surface. `target`: null for other displacements. With Whole, collective.
  void Displace(const Options& options, vtkPointSet* input, vtkUnstructuredGrid* grid,
    const Inputs& inputs, vtkPolyData* target, vtkPolyData* output, morph::Monitor& monitor);
  void DisplaceOnRanks(const Options& options, vtkPointSet* input, const Inputs& inputs,
    vtkPolyData* target, vtkPolyData* output, morph::Monitor& monitor);
  /// Finds what moves. Returns false where there is no boundary.
  bool FindMoving(const Options& options, vtkPointSet* input, const Inputs& inputs,
    vtkPolyData* target, Moves& moves, morph::Monitor& monitor);
  /// Finds where it moves. `field`: the displacements of DISPLACEMENT_FIELD, #moving x 3.
  void Prepare(const Options& options, vtkPointSet* input, const Inputs& inputs,
    morph::Points field, Moves& moves, morph::Monitor& monitor);
  void Choose(const Options& options, vtkPointSet* input, vtkSelection* selection);
  /// The positions of what moves, on the target. Chooses what moves, too.
  morph::Points Fitted(const Options& options, vtkPointSet* input, vtkSelection* selection,
    vtkPolyData* target, const std::vector<morph::Index>& sliding, morph::Monitor& monitor);
  /// The positions of what moves, by handles or by a lattice.
  morph::Points ByControlPoints(const Options& options, vtkPointSet* input, vtkSelection* selection,
    vtkDataObject* points, morph::Monitor& monitor);
  /// The lattice about `from`, what moves.
  static morph::LatticeMotion LatticeOf(const Options& options, const morph::Points& from);
  /// The displacements of what moves by DISPLACEMENT_FIELD; NaN for none. With Whole, collective.
  morph::Points ByField(const Options& options, vtkDataObject* field, morph::Monitor& monitor);
  std::vector<morph::Handle> ChosenHandles(
    const Options& options, vtkPointSet* input, vtkSelection* selection);
  void SelectOnRanks(vtkUnstructuredGrid* piece, vtkSelection* selection);
  /// Finds zones and the cells of layers. `grid`: null for a surface. Collective on ranks.
  void FindInner(const Options& options, vtkUnstructuredGrid* grid,
    const morph::filters::Zones::Options& zones, morph::BoundaryMover::Options& mover) const;
  void Write(const Options& options, vtkPointSet* input, bool isFitted, const Moves& moves,
    vtkPolyData* output, morph::Monitor& monitor);
  void WriteDistances(const morph::Surroundings::Result& result, vtkPolyData* output);
  /// Adds zones and layers inside to the output, points without cells.
  void AppendInner(vtkUnstructuredGrid* grid, vtkPolyData* output);
  void CountRoles(vtkUnstructuredGrid* grid, bool hasInner);
};
