// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Untangling/SmoothMesh.h"

namespace morph::filters
{
/// How PostSmooth smooths: towards the undeformed shapes, and never to a worse mesh.
inline SmoothingOptions postSmoothing(int iterationLimit)
{
  SmoothingOptions options;
  options.target = SmoothingTarget::Initial;
  options.iterationLimit = iterationLimit;
  options.neverWorse = true;
  return options;
}
}
