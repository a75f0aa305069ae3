// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Morpher/Morpher.h"

#include <memory>
#include <utility>
#include <vector>

namespace morph
{
/// A method that reads no cells, applied to each body alone: the free nodes of a body follow its
/// own prescribed nodes, and no motion crosses the gap to another body.
class BodyByBody : public LinearMorpher
{
public:
  /// `method`: one that has copyWithoutCells(), not prepared. `bodyOfNode`: see bodyOfNodes(); of
  /// the mesh that is prepared, if it has cells, none is needed.
  explicit BodyByBody(std::unique_ptr<Morpher> method, std::vector<Index> bodyOfNode = {});
  void requireMesh(const Mesh& rest) const override { this->method_->requireMesh(rest); }

protected:
  /// Throws Error of kind Singular where a body has free nodes and no prescribed one.
  void doPrepare(const Mesh& rest, Monitor& monitor) override;
  void warnOf(const Points& prescribed, Monitor& monitor) const override;
  EvaluateReport displace(const Points& prescribed, Points& free, Monitor& monitor) const override;
  EvaluateReport displaceTranspose(
    const Points& free, Points& prescribed, Monitor& monitor) const override;

private:
  struct Body
  {
    std::unique_ptr<LinearMorpher> method;
    std::vector<Index> prescribed, free; ///< places in the lists of the partition
  };
  /// Calls act(body, part of `monitor`) for each body with free nodes, and joins the reports.
  template <typename Act>
  EvaluateReport forEach(Monitor& monitor, const Act& act) const;

  std::unique_ptr<Morpher> method_; ///< of whose kind there is one a body
  std::vector<Index> bodyOfNode_;
  std::vector<Body> bodies_; ///< those with free nodes
};

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
