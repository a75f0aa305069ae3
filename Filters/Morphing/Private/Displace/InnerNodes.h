// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/WallLayers.h"
#include "BoundaryMover/Surroundings.h"
#include "Morpher/Morpher.h"
#include "Private/Displace/Zones.h"
#include "Private/Distributed/WholeSurface.h"
#include "Private/Distributed/WholeVolume.h"

#include <vtkSmartPointer.h>

#include <map>
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

  /// Finds the zones. `grid`: that `model` was made from. Throws as Zones::Find() does. `whole`: of
  /// a mesh on several MPI processes, of which `grid` is a piece; else null. Then this function and
  /// Place() are collective. Results have the nodes of `model`, and then those inside that this
  /// process owns and prescribes.
  void Find(vtkUnstructuredGrid* grid, const BoundaryModel& model, const MergedBlocks* blocks,
    const Options& options, const WholeSurface* whole = nullptr);
  /// Forgets the zones and layers.
  void Clear();
  /// Takes the boundary nodes of zones with a known motion out of `choice`, or puts them in:
  /// fixed ones are held, and those with a transform move. So surfaces around them follow.
  /// `targets`: of choice.moving.
  void Constrain(const BoundaryModel& model, const Options& options, Choice& choice,
    morph::Points& targets) const;
  /// Sets the positions and roles of layers and zones in `result`, of all nodes. `choice`: as
  /// constrained.
  void Place(vtkUnstructuredGrid* grid, const BoundaryModel& model, const Choice& choice,
    const Options& options, Surroundings::Result& result, morph::Monitor& monitor);
  /// Moves the rest of the boundary again where Place() has put outer nodes elsewhere than the
  /// first time: surfaces around layers and zones follow them, too. After Place(), which made
  /// `result`. `targets`: of choice.moving. Cost: nothing where no outer node was put elsewhere.
  void SpreadAround(const BoundaryModel& model, const Choice& choice, const morph::Points& targets,
    const Surroundings::Options& options, Surroundings::Result& result, morph::Monitor& monitor);
  /// Adds the inner nodes to the output, points without cells, with all arrays. `output`: the
  /// displaced boundary; `input`: the grid.
  void Append(vtkUnstructuredGrid* grid, const BoundaryModel& model,
    const Surroundings::Result& result, vtkPolyData* output) const;
  /// The undeformed positions of all nodes of a result.
  morph::Points Rest(const BoundaryModel& model) const;

  /// The nodes that a morph prescribes: those of the boundary that are not free, and inner ones of
  /// zones and layers. Ascending.
  static std::vector<morph::Index> Prescribed(
    const BoundaryModel& model, const Surroundings::Result& result);
  /// The same on several MPI processes, but for `others`: nodes of the boundary, ascending.
  WholeVolume::Prescribed PrescribedOnRanks(const BoundaryModel& model,
    const Surroundings::Result& result, const std::vector<morph::Index>& others) const;

private:
  struct Zone
  {
    std::vector<morph::Index> Nodes;   ///< ascending, in no zone before
    std::vector<morph::Index> Edge;    ///< those with a cell outside the zone; not on ranks
    WholeVolume::Flags IsNode, IsEdge; ///< the same of the piece's points, on ranks
  };
  void FindOnRanks(vtkUnstructuredGrid* grid, const BoundaryModel& model,
    const MergedBlocks* blocks, const Options& options);
  /// The nodes here of those of the whole mesh that the piece's flags tell. Collective.
  std::vector<morph::Index> NodesOf(const BoundaryModel& model, const WholeVolume::Flags& ofPiece);
  Eigen::RowVector3d RestOf(const BoundaryModel& model, morph::Index node) const;
  /// Adds points of the piece that this process owns to the nodes; returns their numbers.
  std::vector<morph::Index> AddPoints(
    const BoundaryModel& model, const std::vector<morph::Index>& ofPiece);
  morph::WallLayers LayersOnRanks(vtkUnstructuredGrid* grid, const BoundaryModel& model,
    const Choice& choice, const Options& options);
  void KeepLayers(vtkUnstructuredGrid* grid, const BoundaryModel& model, const Choice& choice,
    const Options& options, Surroundings::Result& result);
  void MoveLayers(const morph::Points& rest, const BoundaryModel& model, const Choice& choice,
    Surroundings::Result& result) const;
  /// Makes room for the points that were added, undeformed.
  void Extend(const BoundaryModel& model, Surroundings::Result& result) const;
  void MoveRigidly(const Zone& zone, const BoundaryModel& model, Surroundings::Result& result,
    morph::Monitor& monitor);
  /// Where FEMWARP takes nodes of a zone, with those that are prescribed so far.
  WholeVolume::Moved Guess(const Zone& zone, const BoundaryModel& model,
    const Surroundings::Result& result, morph::Monitor& monitor);

  const WholeSurface* Whole = nullptr;
  std::vector<morph::Index> PointOf; ///< on ranks: of the piece, of each node behind the model's
  std::map<morph::Index, morph::Index> NumberOf; ///< in PointOf, of those points
  Surroundings Around;                           ///< of what Place() moves
  bool HasMovedOuter = false;                    ///< Place() has put outer nodes elsewhere
  std::vector<morph::Index> FixedNodes;
  std::vector<Zone> RigidZones;
  morph::WallLayers Layers;
  std::vector<std::uint8_t> LayersWall; ///< that Layers was found for
  std::string LayersKey;
  std::unique_ptr<morph::Morpher> Method; ///< FEMWARP, prepared, or null
  vtkIdType MethodVersion = -1;
};
}
