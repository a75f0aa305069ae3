// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/WallLayers.h"
#include "Morpher/Morpher.h"
#include "Private/Displace/Surroundings.h"
#include "Private/Displace/Zones.h"

#include <vtkSmartPointer.h>

#include <memory>
#include <vector>

class vtkAbstractTransform;
class vtkUnstructuredGrid;

namespace morph::filters
{
/// The nodes of a mesh that a boundary displacement prescribes beside those that it moves: zones,
/// and layers of cells on moving walls. A result does not depend on what is kept.
class InnerNodes
{
public:
  struct Options
  {
    Zones::Options Zones;
    vtkAbstractTransform* RigidTransform = nullptr; ///< null: the motion of their boundary
    double ScaleFactor = 1;                         ///< of the transform
    morph::Index KeepLayers = 0;                    ///< the most layers; 0: none
    std::string LayersArray; ///< cell array: only cells where it is not 0; empty: all

    bool Any() const { return this->Zones.Any() || this->KeepLayers > 0; }
  };

  /// Finds the zones. `grid`: that `model` was made from. Throws as Zones::Find() does.
  void Find(vtkUnstructuredGrid* grid, const BoundaryModel& model, const MergedBlocks* blocks,
    const Options& options);
  /// Takes the boundary nodes of zones with a known motion out of `choice`, or puts them in:
  /// frozen ones are held, and those with a transform move. So surfaces around them follow.
  /// `targets`: of choice.Moving.
  void Constrain(const BoundaryModel& model, const Options& options, Choice::Result& choice,
    morph::Points& targets) const;
  /// Sets the positions and roles of layers and zones in `result`, of all nodes. `choice`: as
  /// constrained.
  void Place(vtkUnstructuredGrid* grid, const BoundaryModel& model, const Choice::Result& choice,
    const Options& options, Surroundings::Result& result, morph::Monitor& monitor);
  /// Moves the rest of the boundary again where Place() has put outer nodes elsewhere than the
  /// first time: surfaces around layers and zones follow them, too. After Place(), which made
  /// `result`. `targets`: of choice.Moving. Cost: nothing where no outer node was put elsewhere.
  void SpreadAround(const BoundaryModel& model, const Choice::Result& choice,
    const morph::Points& targets, const Surroundings::Options& options,
    Surroundings::Result& result, morph::Monitor& monitor);
  /// Adds the inner nodes to the output, points without cells, with all arrays. `output`: the
  /// displaced boundary; `input`: the grid.
  static void Append(vtkUnstructuredGrid* grid, const BoundaryModel& model,
    const Surroundings::Result& result, vtkPolyData* output);

  /// The nodes that a morph prescribes: those of the boundary that are not free, and inner ones of
  /// zones and layers. Ascending.
  static std::vector<morph::Index> Prescribed(
    const BoundaryModel& model, const Surroundings::Result& result);

private:
  struct Zone
  {
    std::vector<morph::Index> Nodes; ///< ascending, in no zone before
    std::vector<morph::Index> Edge;  ///< those with a cell outside the zone
  };
  void KeepLayers(vtkUnstructuredGrid* grid, const BoundaryModel& model,
    const Choice::Result& choice, const Options& options, Surroundings::Result& result);
  void MoveRigidly(const Zone& zone, const BoundaryModel& model, Surroundings::Result& result,
    morph::Monitor& monitor);
  /// Where FEMWARP takes the nodes, with those that are prescribed so far.
  morph::Points Guess(
    const BoundaryModel& model, const Surroundings::Result& result, morph::Monitor& monitor);

  Surroundings Around;        ///< of what Place() moves
  bool HasMovedOuter = false; ///< Place() has put outer nodes elsewhere
  std::vector<morph::Index> FrozenNodes;
  std::vector<Zone> RigidZones;
  morph::WallLayers Layers;
  std::vector<std::uint8_t> LayersWall; ///< that Layers was found for
  std::string LayersKey;
  std::unique_ptr<morph::Morpher> Method; ///< FEMWARP, prepared, or null
  vtkIdType MethodVersion = -1;
};
}
