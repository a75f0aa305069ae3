// SPDX-License-Identifier: BSD-3-Clause
// LBWARP against FEMWARP, a direct solver and the size of the mesh, in one run.
#include "CommandLine.h"
#include "LbWarpFigures.h"

int main(int argc, char** argv)
{
  return benchmark::commandLine(argc, argv, "benchmark-lbwarp",
    "Measures LBWARP on twisted bricks of hexahedra, inner nodes jittered by 0.2 of an edge, and\n"
    "prints figures beside their targets.\n"
    "Cold: prepare and evaluate of a fresh morpher at relative residual 1e-10. Warm: evaluate "
    "alone.\n",
    "", benchmark::measureLbWarpFigures);
}
