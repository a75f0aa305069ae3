// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/WallLayers.h"
#include "BoundaryMover/InnerPieces.h"
#include "BoundaryMover/Surroundings.h"
#include "Morpher/Morpher.h"

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace morph
{
/// What a zone has of a mesh, or of a piece of it.
struct Zone
{
  std::string name;                 ///< for messages
  std::vector<std::uint8_t> isNode; ///< #nodes: the zone's, and those of its cells
  std::vector<std::uint8_t> isCell; ///< #cells: the zone's, or those whose nodes all are
};
/// Sets the nodes of a zone, and the cells that have no others; and the other way round.
///@{
void takeNodes(const Mesh& mesh, std::vector<std::uint8_t> isNode, Zone& zone);
void takeCells(const Mesh& mesh, std::vector<std::uint8_t> isCell, Zone& zone);
///@}

/// The nodes of a mesh that a boundary displacement prescribes beside those that it moves: zones,
/// and layers of cells on moving walls. A result does not depend on what is kept.
class InnerNodes
{
public:
  struct Options
  {
    /// Where rigid zones go; none: they follow their boundary.
    std::function<Eigen::RowVector3d(const Eigen::RowVector3d&)> rigid;
    Index keepLayers = 0;              ///< the most layers; 0: none
    std::string layersName;            ///< of isLayer, for messages
    std::vector<std::uint8_t> isLayer; ///< #cells that count; empty: all
  };

  /// Takes the zones. `pieces`: of a mesh on several processes, of whose piece the zones are then;
  /// else null. With it this function and place() are collective. Results have the nodes of
  /// `model`, and then those inside that this process owns and prescribes.
  void take(const BoundaryModel& model, const std::vector<Zone>& fixed,
    const std::vector<Zone>& rigid, const InnerPieces* pieces);
  /// Forgets the zones and layers.
  void clear();
  /// Takes the boundary nodes of zones with a known motion out of `choice`, or puts them in:
  /// fixed ones are held, and those with a transform move. So surfaces around them follow.
  /// `targets`: of choice.moving.
  void constrain(
    const BoundaryModel& model, const Options& options, Choice& choice, Points& targets) const;
  /// Sets the positions and roles of layers and zones in `result`, of all nodes. `choice`: as
  /// constrained.
  void place(const BoundaryModel& model, const Choice& choice, const Options& options,
    Surroundings::Result& result, Monitor& monitor);
  /// Moves the rest of the boundary again where place() has put outer nodes elsewhere than the
  /// first time: surfaces around layers and zones follow them, too. After place(), which made
  /// `result`. `targets`: of choice.moving. Returns whether it has: the warnings of the first time
  /// then count no more. Cost: nothing where no outer node was put elsewhere.
  bool spreadAround(const BoundaryModel& model, const Choice& choice, const Points& targets,
    const Surroundings::Options& options, Surroundings::Result& result, Monitor& monitor);
  /// The nodes of zones and layers inside, ascending, and the points of each: nodes of the mesh, or
  /// of this process's piece.
  ///@{
  static std::vector<Index> placedInside(
    const BoundaryModel& model, const Surroundings::Result& result);
  std::vector<Index> pointsOf(const BoundaryModel& model, const std::vector<Index>& nodes) const;
  ///@}
  /// The undeformed positions of all nodes of a result.
  Points rest(const BoundaryModel& model) const;

  /// The nodes that a morph prescribes: those of the boundary that are not free, and inner ones of
  /// zones and layers. Ascending.
  static std::vector<Index> prescribed(
    const BoundaryModel& model, const Surroundings::Result& result);
  /// The same on several MPI processes, but for `others`: nodes of the boundary, ascending.
  InnerPieces::Prescribed prescribedOnRanks(const BoundaryModel& model,
    const Surroundings::Result& result, const std::vector<Index>& others) const;

private:
  struct Rigid
  {
    std::vector<Index> nodes;          ///< ascending, in no zone before
    std::vector<Index> edge;           ///< those with a cell outside the zone; points on ranks
    InnerPieces::Flags isNode, isEdge; ///< the same of the piece's points, on ranks
  };
  /// The nodes here of those of the whole mesh that the piece's flags tell. Collective.
  std::vector<Index> nodesOf(const BoundaryModel& model, const InnerPieces::Flags& ofPiece);
  Eigen::RowVector3d restOf(const BoundaryModel& model, Index node) const;
  /// Adds points of the piece that this process owns to the nodes; returns their numbers.
  std::vector<Index> addPoints(const BoundaryModel& model, const std::vector<Index>& ofPiece);
  WallLayers layersOnRanks(
    const BoundaryModel& model, const Choice& choice, const Options& options);
  void keepLayers(const BoundaryModel& model, const Choice& choice, const Options& options,
    Surroundings::Result& result);
  void moveLayers(const Points& rest, const BoundaryModel& model, const Choice& choice,
    Surroundings::Result& result) const;
  /// Makes room for the points that were added, undeformed.
  void extend(const BoundaryModel& model, Surroundings::Result& result) const;
  void moveRigidly(
    const Rigid& zone, const BoundaryModel& model, Surroundings::Result& result, Monitor& monitor);
  struct Moved
  {
    Points from, to;
  };
  /// Where FEMWARP takes nodes of a zone, with those that are prescribed so far.
  Moved guess(const Rigid& zone, const BoundaryModel& model, const Surroundings::Result& result,
    Monitor& monitor);

  const InnerPieces* pieces_ = nullptr;
  std::vector<Index> pointOf_;      ///< on ranks: of the piece, of each node behind the model's
  std::map<Index, Index> numberOf_; ///< in pointOf_, of those points
  Surroundings around_;             ///< of what place() moves
  bool hasMovedOuter_ = false;      ///< place() has put outer nodes elsewhere
  std::vector<Index> fixedNodes_;
  std::vector<Rigid> rigidZones_;
  WallLayers layers_;
  /// What they were found for.
  ///@{
  std::int64_t layersVersion_ = -1;
  Index layersMost_ = 0;
  std::vector<std::uint8_t> layersWall_, layersCells_;
  ///@}
  std::unique_ptr<Morpher> method_; ///< FEMWARP, prepared, or null
  std::int64_t methodVersion_ = -1;
};
}
