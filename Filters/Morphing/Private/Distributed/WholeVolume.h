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
  const morph::Mesh& mesh() const override;
  const morph::HangingNodes& hanging() const override;
  bool needsPieces() const override;
  const std::shared_ptr<const morph::Communicator>& processes() const override;
  morph::Index nodeOf(morph::Index node) const override;
  void together(const std::function<void()>& work) const override;
  Flags nodeFlags(const Flags& ofPiece) const override;
  Flags anyFlags(const Flags& ofPiece) const override;
  std::vector<morph::Index> ownInner(const Flags& ofPiece) const override;
  Columns findLayers(const Flags& isWall, morph::Index most, const Flags& isLayer) const override;

private:
  const WholeSurface& Surface;
};
}
