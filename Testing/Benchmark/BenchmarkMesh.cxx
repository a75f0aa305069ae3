// SPDX-License-Identifier: BSD-3-Clause
// FEMWARP and LBWARP against the paper's direct solver on a mesh from a file, in one run.
#include "CommandLine.h"
#include "MeshFigures.h"

int main(int argc, char** argv)
{
  return benchmark::commandLine(argc, argv, "benchmark-mesh",
    "Measures FEMWARP and LBWARP on meshes as Data/generate.py writes them, from S_0 to S_F, and "
    "KLU\n"
    "on the same systems.\n"
    "Cold: prepare and evaluate of a fresh morpher at relative residual 1e-10, for KLU analysis,\n"
    "factorisation and solution. Warm: evaluate alone.\n",
    "", benchmark::measureMeshFigures, "FILE.vtu...");
}
