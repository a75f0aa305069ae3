// SPDX-License-Identifier: BSD-3-Clause
// The linear methods, and what the filters do beside them, by the size of the mesh; and hypre's
// BoomerAMG on FEMWARP's system.
#include "CommandLine.h"
#include "ScaleFigures.h"

int main(int argc, char** argv)
{
  return benchmark::commandLine(argc, argv, "benchmark-scale",
    "Measures each stage on twisted cubes of hexahedra: seconds, parallel efficiency, and share;\n"
    "and FEMWARP's system by hypre's BoomerAMG with conjugate gradients.\n"
    "SIDES: cells a side, as in: benchmark-scale 50 100 200\n",
    "", benchmark::measureScaleFigures, "SIDES");
}
