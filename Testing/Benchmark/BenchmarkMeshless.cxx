// SPDX-License-Identifier: BSD-3-Clause
// The meshless methods against CGAL and the size of the mesh, in one run.
#include "CommandLine.h"
#include "MeshlessFigures.h"

int main(int argc, char** argv)
{
  return benchmark::commandLine(argc, argv, "benchmark-meshless",
    "Measures weighted residual, simplex-linear, simplex-natural neighbor and radial basis "
    "functions\n"
    "on twisted bricks of hexahedra and prints figures beside their targets.\n"
    "Cold: prepare and evaluate of a fresh morpher. Warm: evaluate alone.\n",
    "", benchmark::measureMeshlessFigures);
}
