// SPDX-License-Identifier: BSD-3-Clause
// What vtkBoundaryDisplacement keeps from one execution to the next, and the steps of one.
#pragma once

#include "vtkBoundaryDisplacement.h"

#include "BoundaryMover/BoundaryMover.h"
#include "Private/Blocks/Blocks.h"
#include "Private/Data/Unchanged.h"
#include "Private/Displace/BoundaryFields.h"
#include "Private/Displace/Chosen.h"
#include "Private/Displace/ControlPoints.h"
#include "Private/Displace/FittedTarget.h"
#include "Private/Displace/InputBoundary.h"
#include "Private/Displace/Motion.h"
#include "Private/Displace/Pick.h"
#include "Private/Displace/Selection.h"
#include "Private/Displace/SharedProperties.h"
#include "Private/Displace/Zones.h"
#include "Private/Distributed/WholeSurface.h"
#include "Private/Pipeline/Monitor.h"

#include <vtkDataArraySelection.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>

#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

struct vtkBoundaryDisplacement::vtkInternals : vtkDisplacementAlgorithm::vtkShared
{
  vtkNew<vtkDataArraySelection> SurfaceList;
  vtkNew<vtkStringArray> SurfaceSizes;
  vtkNew<vtkDoubleArray> SurfaceBounds;
  vtkNew<vtkDataArraySelection> ZoneList;
  vtkNew<vtkStringArray> ZoneSizes;
  vtkIdType ListedVersion = -1; ///< of Model

  morph::filters::Blocks Blocks;
  const morph::filters::MergedBlocks* OuterBlocks = nullptr; ///< of a filter around this one
  morph::filters::Unchanged Checked;                         ///< the input, where it is a grid
  morph::filters::BlockSelection Selected, ZoneSelected;
  morph::filters::InputBoundary Model;
  std::vector<std::string> Warnings; ///< of the geometry, not reported yet
  vtkIdType ChosenVersion = -1;      ///< of Model, that Choice is of
  morph::filters::Chosen::Options ChosenBy;
  morph::Choice Choice;
  morph::BoundaryMover Mover;
  morph::filters::BoundaryFields Fields;
  morph::filters::FittedTarget Fit;
  morph::filters::Picker Picker;
  /// The boundary of a mesh on several MPI processes, of which Model is then; else null.
  std::unique_ptr<morph::filters::WholeSurface> Whole;
  std::vector<std::uint8_t> IsSelected; ///< #nodes of Whole, of MOVING_SELECTION
  vtkNew<vtkPolyData> WholeOutput;      ///< of which the output has a part

  /// Forgets the names of patches and zones.
  void ClearList()
  {
    this->SurfaceList->RemoveAllArrays();
    this->SurfaceSizes->Initialize();
    this->SurfaceBounds->Initialize();
    this->SurfaceBounds->SetNumberOfComponents(6);
    this->ZoneList->RemoveAllArrays();
    this->ZoneSizes->Initialize();
    this->ListedVersion = -1;
  }
  /// Finds the boundary and its geometry, and the names of patches and zones.
  void Classify(
    const vtkBoundaryDisplacement* filter, vtkPointSet* input, morph::filters::Monitor& monitor);
  /// Lists the zones of a mesh, or of this process's piece of it.
  void ListZones(vtkUnstructuredGrid* grid, const morph::Mesh& mesh);
  /// What the optional ports hold; each may be null.
  struct Extras
  {
    vtkSelection* Selection;      ///< of what moves
    vtkPolyData* Target;          ///< of DISPLACEMENT_TARGET
    vtkSelection* Zone;           ///< of a zone
    vtkDataObject* ControlPoints; ///< of DISPLACEMENT_HANDLES and DISPLACEMENT_LATTICE
  };
  /// `input`: with the whole boundary; `grid`: the mesh, or this process's piece of it; null for a
  /// surface. With Whole, collective.
  void Displace(vtkBoundaryDisplacement* filter, vtkPointSet* input, vtkUnstructuredGrid* grid,
    const Extras& extras, vtkPolyData* output, morph::filters::Monitor& monitor);

  /// Displace() for a mesh on several MPI processes: each gets the part of the displaced boundary
  /// that its cells have. Collective.
  void DisplaceOnRanks(vtkBoundaryDisplacement* filter, vtkPointSet* input, const Extras& extras,
    vtkPolyData* output, morph::filters::Monitor& monitor);

private:
  /// What moves, and how the rest of the boundary does.
  struct Moves
  {
    morph::Points Given, Targets;
    morph::filters::Motion::Options Motion;
    morph::Choice Choice;
    morph::Surroundings::Options Rest;
  };
  /// Finds what moves. Returns false where there is no boundary.
  bool Prepare(vtkBoundaryDisplacement* filter, vtkPointSet* input, const Extras& extras,
    Moves& moves, morph::filters::Monitor& monitor);
  void Write(vtkBoundaryDisplacement* filter, vtkPointSet* input, const Extras& extras,
    const Moves& moves, const morph::BoundaryMover::Options& options, vtkPolyData* output,
    morph::filters::Monitor& monitor);
  /// Adds zones and layers inside to the output, points without cells.
  void AppendInner(vtkUnstructuredGrid* grid, vtkPolyData* output);
  void Count(vtkBoundaryDisplacement* filter, bool hasInner) const;
  void SelectOnRanks(vtkUnstructuredGrid* piece, vtkSelection* selection);
  morph::filters::Zones::Options ZoneOptions(
    const vtkBoundaryDisplacement* filter, vtkSelection* zone);
  /// Finds zones and the cells of layers. `grid`: null for a surface. Collective on ranks.
  void FindInner(const vtkBoundaryDisplacement* filter, vtkUnstructuredGrid* grid,
    const morph::filters::Zones::Options& zones, morph::BoundaryMover::Options& options);
  /// The positions of what moves, on the target. Chooses what moves, too.
  morph::Points Fitted(vtkBoundaryDisplacement* filter, vtkPointSet* input, vtkSelection* selection,
    vtkPolyData* target, const std::vector<morph::Index>& sliding,
    morph::filters::Monitor& monitor);
  /// The positions of what moves, by handles or by a lattice.
  morph::Points ByControlPoints(const vtkBoundaryDisplacement* filter, vtkPointSet* input,
    vtkSelection* selection, vtkDataObject* points, morph::filters::Monitor& monitor);
  std::vector<morph::Handle> SelectedHandles(
    const vtkBoundaryDisplacement* filter, vtkPointSet* input, vtkSelection* selection);
  void WriteDistances(const morph::Surroundings::Result& result, vtkPolyData* output);
};
