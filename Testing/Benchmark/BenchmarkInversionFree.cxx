// SPDX-License-Identifier: BSD-3-Clause
// The inversion-free morph on twisted cubes, and against a direct solver of FEMWARP's system.
#include "CommandLine.h"
#include "InversionFreeFigures.h"

int main(int argc, char** argv)
{
  return benchmark::commandLine(argc, argv, "benchmark-inversion-free",
    "Measures the inversion-free morph on twisted cubes of hexahedra, and prints figures\n"
    "beside their targets.\n",
    "", benchmark::measureInversionFreeFigures);
}
