// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "TwistedBrick.h"

namespace benchmark
{
/// The problem in a .vtu that Data/generate.py writes: all nodes of the outer boundary are
/// prescribed, and move by the point array FinalDisplacement, from S_0 to S_F. Throws
/// std::runtime_error or morph::Error where the file cannot be used.
Problem readProblem(const std::string& file);
}
