// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMover/InnerPieces.h"
#include "Private/Distributed/WholeSurface.h"

#include <vector>

namespace morph::filters
{
/// Of the mesh whose boundary a WholeSurface is: the nodes are those of its Boundary().
class WholeVolume : public morph::InnerPieces
{
public:
  /// Holds `surface` by reference, after its Take().
  explicit WholeVolume(const WholeSurface& surface);

  const morph::Mesh& piece() const override;
  void together(const std::function<void()>& work) const override;
  bool anywhere(bool here) const override;
  Flags nodeFlags(const Flags& ofPiece) const override;
  Flags anyFlags(const Flags& ofPiece) const override;
  std::vector<morph::Index> ownInner(const Flags& ofPiece) const override;
  Columns findLayers(const Flags& isWall, morph::Index most, const Flags& isLayer) const override;
  Moved warp(const Prescribed& given, const Flags& ofPiece, morph::Monitor& monitor) const override;
  std::vector<morph::NodeSliding::Round> slide(const Prescribed& given,
    const std::vector<morph::Index>& sliding, const morph::NodeSliding::Surfaces& surfaces,
    const morph::NodeSliding::Limits& limits, morph::Points& places,
    morph::Monitor& monitor) const override;

private:
  /// The nodes of the distributed mesh that are prescribed, and the places of all. Collective.
  std::vector<morph::Index> Place(const Prescribed& given, morph::Points& places) const;

  const WholeSurface& Surface;
};
}
