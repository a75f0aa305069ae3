// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Morpher/Morpher.h"

#include <memory>
#include <utility>
#include <vector>

namespace morph
{
/// A method that interpolates between the prescribed nodes and reads no cells, on several
/// processes. Each gathers all prescribed nodes, and evaluates its own free nodes by the method,
/// each body alone. So memory and messages of each process grow with the whole boundary: 32 bytes a
/// prescribed node and motion.
class SiteMethod : public LinearMorpher
{
public:
  /// `method`: one that has copyWithoutCells().
  explicit SiteMethod(std::unique_ptr<Morpher> method);
  int layers() const override { return 1; }
  void requireMesh(const Mesh& rest) const override { this->method_->requireMesh(rest); }

protected:
  void doPrepare(const Mesh& rest, Monitor& monitor) override;
  EvaluateReport displace(const Points& prescribed, Points& free, Monitor& monitor) const override;
  EvaluateReport displaceTranspose(
    const Points& free, Points& prescribed, Monitor& monitor) const override;

private:
  std::unique_ptr<Morpher> method_; ///< not prepared
  std::unique_ptr<Morpher> serial_; ///< prepared for the sites and this process's free nodes
  /// Of each prescribed node that counts here, its number and that of its site.
  std::vector<std::pair<Index, Index>> sites_;
};

/// The form that a method, not prepared, takes on several processes: its own, or a SiteMethod. Null
/// for a method that needs one process.
std::unique_ptr<Morpher> onProcesses(std::unique_ptr<Morpher> method);
}
