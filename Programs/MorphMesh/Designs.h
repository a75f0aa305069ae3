// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace morph_mesh
{
struct Arguments;

/// Writes a mesh for each row of a table of weights of shapes, and a table of their quality, into
/// a folder; continues a run that was stopped. Returns the exit status. Throws Failure and
/// UsageError.
int writeDesigns(const Arguments& arguments);
}
