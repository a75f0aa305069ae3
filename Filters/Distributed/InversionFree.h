// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/Method.h"
#include "Distributed/Patches.h"
#include "Distributed/SiteMethod.h"
#include "Distributed/SystemMethod.h"

#include "Untangling/InversionFree.h"

#include <memory>

namespace morph::distributed
{
/// The inversion-free morph on ranks: the better of FEMWARP's and the simplex-linear mesh, whose
/// inverted and worst cells morph::InversionFree::repair() mends in patches, each on one rank. It
/// does not minimise the energy of the whole mesh, and needs a valid undeformed mesh. A motion that
/// inverts cells in a large part of the mesh is left to one rank, with a warning; see PatchLimits.
///
/// Count: `Untangled` (1 or 0).
class InversionFree : public Method
{
public:
  /// Takes the options of the serial method. Throws Error for another start than FEMWARP, or other
  /// targets than Stretched.
  explicit InversionFree(const morph::InversionFree& serial);

  void takeEvaluateOptions(const Morpher& serial) override;
  void setReference(Points reference) override { this->reference_ = std::move(reference); }

protected:
  void doPrepare(Monitor& monitor) override;
  EvaluateReport displace(const Points& prescribed, Points& free, Monitor& monitor) const override;
  EvaluateReport displaceTranspose(
    const Points& free, Points& prescribed, Monitor& monitor) const override;

private:
  struct Quality
  {
    double minimum = 0; ///< over what free nodes can change; infinite without such a sample
    Index inverted = 0;
    std::vector<Index> worst; ///< this rank's cells near the minimum

    bool operator<(const Quality& other) const
    {
      return this->inverted > other.inverted ||
             (this->inverted == other.inverted && this->minimum < other.minimum);
    }
  };
  Quality measure(const Points& points, Monitor& monitor) const;
  /// Raises the minimum of a valid mesh as far as patches of the worst cells do.
  void raise(const Points& reference, Points& points, Monitor& monitor) const;

  bool raising_ = true;
  Points reference_;
  FemWarp femWarp_;
  std::unique_ptr<SiteMethod> simplexLinear_; ///< null where it cannot be prepared
};
}
