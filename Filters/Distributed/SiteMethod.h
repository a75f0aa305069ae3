// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Morpher/Morpher.h"

#include <memory>
#include <vector>

namespace morph::distributed
{
/// A method that interpolates between the prescribed nodes and reads no cells. Each rank gathers
/// all prescribed nodes, and evaluates its own free nodes by the serial method, each body alone. So
/// memory and messages of each rank grow with the whole boundary: 32 bytes a prescribed node to
/// prepare, 24 a motion.
class SiteMethod : public LinearMorpher
{
public:
  /// `method`: one that has copyWithoutCells().
  explicit SiteMethod(std::unique_ptr<Morpher> method);

  /// Bytes that this rank received for its last preparation.
  std::size_t gatheredBytes() const { return this->gatheredBytes_; }

protected:
  void doPrepare(const Mesh& rest, Monitor& monitor) override;
  EvaluateReport displace(const Points& prescribed, Points& free, Monitor& monitor) const override;
  EvaluateReport displaceTranspose(
    const Points& free, Points& prescribed, Monitor& monitor) const override;

private:
  /// Gathers a row of each prescribed node that its owner has, in the order of the global ids.
  Points gather(const Points& rows) const;
  /// The body of each gathered node, and then of this rank's free nodes.
  std::vector<Index> gatherBodies() const;

  std::unique_ptr<Morpher> method_; ///< not prepared
  std::unique_ptr<Morpher> serial_; ///< prepared
  std::vector<Index> owned_;   ///< numbers in partition().prescribed of the nodes this rank owns
  std::vector<Index> place_;   ///< of each gathered node in the order of ids
  std::size_t firstPlace_ = 0; ///< of this rank's nodes in place_
  std::size_t gatheredBytes_ = 0;
};
}
