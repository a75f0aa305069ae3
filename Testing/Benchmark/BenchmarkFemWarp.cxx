// SPDX-License-Identifier: BSD-3-Clause
// FEMWARP against direct solvers, the memory's bandwidth and the size of the mesh, in one run.
#include "Baselines.h"
#include "CommandLine.h"
#include "Figures.h"

int main(int argc, char** argv)
{
  return benchmark::commandLine(argc, argv, "benchmark-femwarp",
    "Measures FEMWARP on twisted bricks of hexahedra and prints figures beside their targets.\n"
    "Cold: prepare and evaluate of a fresh morpher at relative residual 1e-8. Warm: evaluate "
    "alone.\n",
    "BLAS: " + benchmark::blasDescription() + "\n", benchmark::measureFigures);
}
