// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/OwnCells.h"

#include "Mesh/SharedHigherOrderNodes.h"
#include "Mesh/Topology.h"
#include "Untangling/Smoothing.h"

#include <memory>

namespace morph::distributed
{
/// Smoothing on ranks: the stages of the serial method (MotionSmoothing.h) on the cells that each
/// rank owns. So the affine start, energies and the minimum are those of the whole mesh.
///
/// Counts: those of morph::Smoothing.
class Smoothing : public Morpher
{
public:
  /// Takes the options of the serial method.
  explicit Smoothing(const morph::Smoothing& serial) { this->takeEvaluateOptions(serial); }

  void takeEvaluateOptions(const Morpher& serial) override;

protected:
  void doPrepare(const Mesh& rest, Monitor& monitor) override;
  EvaluateReport displace(const Points& prescribed, Points& free, Monitor& monitor) const override;

private:
  SmoothingOptions options_;
  std::unique_ptr<OwnCells> own_;
  ConnectedComponents bodies_;       ///< of own_
  SharedHigherOrderNodes followers_; ///< of own_
};
}
