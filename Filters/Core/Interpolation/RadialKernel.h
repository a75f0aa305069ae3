// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"
#include "Support/Types.h"

namespace morph
{
/// A function of the distance r between two positions.
struct RadialKernel
{
  enum class Kind
  {
    Triharmonic, ///< r^3
    ThinPlate,   ///< r^2 log r
    WendlandC2   ///< (1 - q)^4 (4 q + 1) for q = r / radius below 1, else 0
  };

  Kind kind = Kind::Triharmonic;
  double radius = 1; ///< of WendlandC2, positive

  double operator()(double squaredDistance) const;
};

/// Sets row i of `sums` to the sum over j of kernel(|targets_i - sources_j|) strengths_j.
/// `targets`: #targets x 3; `sources`, `strengths`: #sources x 3; `sums`: becomes #targets x 3. The
/// kernel is symmetric, so exchanging targets and sources gives the product with the transpose.
/// Each sum adds the sources in their order: it depends neither on threads nor on other targets. No
/// matrix is stored.
///
/// Cost: one kernel a pair of target and source. For r^3 that is 17 operations, a square root among
/// them, on four or two pairs at once; memory traffic is negligible. The square root, which
/// processors do not pipeline fully, sets the limit.
void kernelSums(const RadialKernel& kernel, const Points& targets, const Points& sources,
  const Points& strengths, Points& sums, Monitor& monitor);
}
