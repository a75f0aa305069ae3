// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Boundary/Classification.h"
#include "Mesh/Mesh.h"
#include "Support/Monitor.h"

namespace morph
{
/// classify() of the outer faces alone, and then of the sheets that `options.sheets` numbers, whose
/// surfaces come last. So the others are what they are without sheets. Cost: as classify().
Classification classifyWithSheets(const Mesh& mesh, const BoundaryFaces& faces,
  const ClassificationOptions& options, Monitor& monitor);
}
