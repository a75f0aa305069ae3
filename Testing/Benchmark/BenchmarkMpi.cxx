// SPDX-License-Identifier: BSD-3-Clause
// FEMWARP on MPI ranks against one rank of the same code and the serial method, in one run.
#include "CommandLine.h"
#include "MpiFigures.h"

#include <mpi.h>

#include <cstdio>
#include <cstring>
#include <vector>

int main(int argc, char** argv)
{
  MPI_Init(&argc, &argv);
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  std::vector<char*> arguments(argv, argv + argc);
  if (rank > 0)
  {
    // The first rank prints and writes for all.
    for (std::size_t i = 1; i + 1 < arguments.size(); ++i)
    {
      if (std::strcmp(arguments[i], "--csv") == 0)
      {
        arguments.erase(arguments.begin() + static_cast<std::ptrdiff_t>(i),
          arguments.begin() + static_cast<std::ptrdiff_t>(i) + 2);
        break;
      }
    }
    std::FILE* out = std::freopen("/dev/null", "w", stdout);
    std::FILE* error = std::freopen("/dev/null", "w", stderr);
    if (!out || !error)
    {
      MPI_Abort(MPI_COMM_WORLD, 3);
    }
  }
  arguments.push_back(nullptr);
  const int status = benchmark::commandLine(static_cast<int>(arguments.size()) - 1,
    arguments.data(), "benchmark-mpi",
    "Run it by mpiexec -n 2. Measures FEMWARP on a twisted cube whose cells are on MPI ranks.\n"
    "Cold: ghosts, prepare and evaluate. Warm: evaluate alone. Relative residual 1e-8.\n",
    "", benchmark::measureMpi);
  MPI_Finalize();
  return status;
}
