// SPDX-License-Identifier: BSD-3-Clause
// The inversion-free morph from a tangled start: Newton against L-BFGS, and against a direct solver
// of FEMWARP's system.
#include "CommandLine.h"
#include "InversionFreeFigures.h"

int main(int argc, char** argv)
{
  return benchmark::commandLine(argc, argv, "benchmark-inversion-free",
    "Measures the inversion-free morph on twisted cubes of hexahedra whose inner nodes start "
    "undeformed, and\n"
    "prints figures beside their targets. Both minimisers stop by the same criteria.\n",
    "", benchmark::measureInversionFreeFigures);
}
