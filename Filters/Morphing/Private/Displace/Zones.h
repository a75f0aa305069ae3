// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMover/InnerNodes.h"
#include "Private/Data/NamedSets.h"
#include "Private/Pipeline/NameSet.h"
#include "Support/Communicator.h"

#include <cstdint>
#include <string>
#include <vector>

class vtkExtractSelection;
class vtkImplicitFunction;
class vtkSelection;
class vtkUnstructuredGrid;

namespace morph::filters
{
struct MergedBlocks;
}

/// Parts of a mesh, inner nodes too, whose motion is prescribed.
namespace morph::filters::Zones
{
/// vtkBoundaryDisplacement::ZoneType
enum Kind
{
  None,
  Fixed,
  Rigid,
  Soft
};

struct Options
{
  NameSet::Names Fixed, Rigid, Soft; ///< point arrays, cell arrays or blocks
  vtkImplicitFunction* Region = nullptr;
  int RegionKind = None;
  vtkSelection* Selection = nullptr;
  vtkExtractSelection* Extractor = nullptr;
  int SelectionKind = None;
  /// Whether another process may have what the grid has not: a selection, arrays, the zone itself.
  bool IsPart = false;

  /// Whether a node is prescribed by some zone.
  bool Any() const
  {
    const auto prescribes = [](int kind) { return kind == Zones::Fixed || kind == Zones::Rigid; };
    return !this->Fixed.empty() || !this->Rigid.empty() || prescribes(this->RegionKind) ||
           prescribes(this->SelectionKind);
  }
};

struct Part : morph::Zone
{
  bool ByNodes = false; ///< whether the zone has nodes of its own, not cells
  bool IsKnown = true;  ///< whether this process has an array or a block of the name
};

/// What can be named, for users to choose from: the sets that the field data SurfaceNames lists,
/// with volume cells or nodes, the blocks, and other arrays of two values, one of them 0. Each
/// once, in this order. `processes`: those that have the other pieces of the mesh. Collective.
/// Cost: a pass over each.
std::vector<ListedZone> List(vtkUnstructuredGrid* grid, const morph::Mesh& mesh,
  const MergedBlocks* blocks, const morph::Communicator& processes = morph::Communicator::alone());

/// Finds the zones of that kind, in the order of their names, then those of region and selection.
/// An array marks by values other than 0. `mesh`: of `grid`; `blocks`: that it was merged from, or
/// null. Throws morph::Error for a name that is neither array nor block, a region or selection that
/// is not given, and a zone without a node. Cost: a pass over the mesh for each.
std::vector<Part> Find(Kind kind, vtkUnstructuredGrid* grid, const morph::Mesh& mesh,
  const MergedBlocks* blocks, const Options& options);
/// The same of a mesh on several MPI processes, of which `grid` is a piece, merged from this
/// process's `blocks`. Flags are of its points and cells. Collective.
std::vector<Part> FindOnRanks(Kind kind, vtkUnstructuredGrid* grid,
  const morph::InnerPieces& volume, const MergedBlocks* blocks, Options options);
}
