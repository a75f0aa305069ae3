// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/OwnCells.h"
#include "Distributed/SiteMethod.h"
#include "Distributed/SystemMethod.h"

#include "Untangling/InversionFree.h"
#include "Untangling/MeshImprovement.h"

#include <memory>
#include <vector>

namespace morph::distributed
{
/// The inversion-free morph on ranks. It starts from the better of FEMWARP's and the simplex-linear
/// mesh. Then it takes the stages of the serial method
/// (MeshImprovement.h) on the cells that each rank owns. So energies, the line search and the
/// minimum are those of the whole mesh. It needs a valid undeformed mesh. A folded boundary is
/// recognized by the outer faces of each rank alone.
///
/// Counts: those of morph::InversionFree.
class InversionFree : public Morpher
{
public:
  /// Takes the options of the serial method.
  explicit InversionFree(const morph::InversionFree& serial) { this->takeEvaluateOptions(serial); }

  void takeEvaluateOptions(const Morpher& serial) override;
  void setReference(Points reference) override { this->reference_ = std::move(reference); }

protected:
  void doPrepare(const Mesh& rest, Monitor& monitor) override;
  EvaluateReport displace(const Points& prescribed, Points& free, Monitor& monitor) const override;

private:
  MeshImprovement improvement(const std::vector<Index>& hopeless) const;
  /// Replaces `points` by the better of FEMWARP's mesh and the simplex-linear one.
  void findStart(const Points& target, const std::vector<Index>& hopeless, Points& points,
    EvaluateReport& report, Monitor& monitor) const;

  ImprovementOptions options_;
  Points reference_;
  FemWarp femWarp_;
  std::unique_ptr<SiteMethod> simplexLinear_; ///< null where it cannot be prepared
  std::unique_ptr<OwnCells> own_;
  double scale_ = 1;       ///< a power of two that makes edges about 1 long
  BoundaryFaces boundary_; ///< of own_: the outer faces of the whole mesh
  Classification geometry_;
};
}
