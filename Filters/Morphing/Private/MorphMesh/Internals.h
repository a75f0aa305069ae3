// SPDX-License-Identifier: BSD-3-Clause
// The filters inside vtkMorphMesh, and what is kept from one execution to the next.
#pragma once

#include "vtkMorphMesh.h"

#include "Private/Blocks/Blocks.h"
#include "Private/Data/Results.h"
#include "Private/Displace/Pick.h"
#include "Private/Displace/Selection.h"
#include "Private/Displace/SharedProperties.h"
#include "Private/Pipeline/Time.h"
#include "Private/Project/TargetDistance.h"
#include "Support/Monitor.h"
#include "vtkBoundaryDisplacement.h"
#include "vtkMorphAlgorithm.h"

#include <vtkNew.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <string>
#include <vector>

class vtkDataArray;
class vtkPolyData;

class vtkMorphMesh::vtkInternals : public vtkDisplacementAlgorithm::vtkShared
{
public:
  vtkNew<vtkBoundaryDisplacement> Displacement;
  vtkSmartPointer<vtkMorphAlgorithm> Morph; ///< of the method, or null
  int MorphMethod = -1;                     ///< that Morph is of
  vtkMTimeType MorphTime = 0;               ///< of Morph, as this class has left it
  morph::filters::Results Results{ morph::filters::ResultTables::vtkMorphMesh() };
  morph::filters::Time Time;
  morph::filters::Picker Picker;
  morph::filters::Blocks Blocks;
  bool IsDistributed = false; ///< several MPI processes have pieces of the mesh

  explicit vtkInternals(vtkMorphMesh* filter)
    : Filter(filter)
  {
  }

  /// Gives the filters inside the mesh, unless they have it.
  void TakeGrid(vtkUnstructuredGrid* grid);
  /// Give the filter inside the target or the control points, copies for its pipeline; null for
  /// none.
  void TakeTarget(vtkDataObject* target);
  void TakeControlPoints(vtkDataObject* points);
  /// Keeps the selection of a zone, as one of the grid; null for none.
  void TakeZone(vtkSelection* selection);
  /// Lists the surfaces of the mesh, if it is one.
  void List(vtkDataObject* input);
  /// The selection as one of the grid, where it is of blocks.
  vtkSelection* OfGrid(vtkSelection* selection);
  /// A selection in composite data as one of the grid; empty where `shown` is none, or nothing is
  /// selected. Throws as Selection::Translate() does.
  morph::filters::Selection::OnGrid OfBlocks(vtkDataObject* shown, vtkSelection* selection) const;
  /// See vtkMorphMesh::CopySurfaces().
  void CopySurfaces(vtkDataArraySelection* names, vtkPolyData* output);
  /// Returns an error that comes with a result, or nothing.
  std::string Run(vtkSelection* selection, vtkInformation* asked, vtkUnstructuredGrid* output,
    vtkUnstructuredGrid* badCells, vtkPolyData* surface, morph::Monitor& monitor);
  /// Makes the outputs the undeformed mesh, where that can be read, without a result.
  void WriteUndeformed(
    vtkDataObject* input, const char* status, vtkUnstructuredGrid* output, vtkPolyData* surface);

private:
  vtkMorphMesh* Filter;
  vtkNew<vtkUnstructuredGrid> Rest;
  const vtkUnstructuredGrid* Input = nullptr; ///< that Rest was made from; compared, never used
  vtkMTimeType InputTime = 0;
  /// Data of an optional port, as a copy, which is the same object while they stay the same.
  struct CopiedData
  {
    vtkSmartPointer<vtkDataObject> Copy;
    const vtkDataObject* Given = nullptr; ///< compared, never used
    vtkMTimeType Time = 0;

    vtkDataObject* Update(vtkDataObject* given);
  };
  CopiedData Target, ControlPoints;
  morph::filters::BlockSelection Selected;
  morph::filters::BlockSelection ZoneSelected;
  vtkSmartPointer<vtkSelection> Zone;        ///< of ZoneSelectionType, or null
  std::vector<std::string> BoundaryWarnings; ///< of the boundary that is kept
  bool NeedsHandles = false;                 ///< DISPLACEMENT_HANDLES has none

  void ConfigureDisplacement(vtkSelection* selection);
  /// Whether DISPLACEMENT_HANDLES has handles. Collective.
  bool HasHandles(bool anySelection) const;
  /// What to do where nothing moves.
  std::string Advice() const;
  /// `soft`: SoftCells().
  void ConfigureMorph(vtkDataArray* soft, morph::Monitor& monitor);
  /// The factors of soft zones, one a cell; null where there are none. Throws morph::Error.
  /// Collective.
  vtkSmartPointer<vtkDataArray> SoftCells();
  void Displace(morph::Monitor& monitor);
  std::string Morphed(vtkInformation* asked, vtkUnstructuredGrid* output,
    vtkUnstructuredGrid* badCells, vtkPolyData* surface, morph::Monitor& monitor);
  void TakeResults();
  /// The boundary with the ids of this process's mesh.
  vtkSmartPointer<vtkPolyData> BoundaryOfGrid() const;
  /// Adds the distances from the target, as they are on `output`.
  void WriteDistances(vtkUnstructuredGrid* output);
  /// Makes the summary that of all MPI processes. `nodes`: those with distances on `output`.
  void SummarizeOnRanks(const std::vector<morph::Index>& nodes, vtkUnstructuredGrid* output,
    morph::filters::TargetDistance::Summary& distance) const;
};
