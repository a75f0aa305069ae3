// SPDX-License-Identifier: BSD-3-Clause
#include "MpiTraffic.h"

#include <mpi.h>

namespace
{
benchmark::MpiTraffic traffic;

void count(int items, MPI_Datatype type, bool isCollective)
{
  int size = 0;
  PMPI_Type_size(type, &size);
  traffic.bytes += static_cast<double>(items) * size;
  (isCollective ? traffic.reductions : traffic.messages) += 1;
}
}

// The functions by which the library and hypre send. A program's own take the place of MPI's.
extern "C"
{
  __attribute__((visibility("default"))) int MPI_Send(
    const void* data, int items, MPI_Datatype type, int to, int tag, MPI_Comm communicator)
  {
    count(items, type, false);
    return PMPI_Send(data, items, type, to, tag, communicator);
  }

  __attribute__((visibility("default"))) int MPI_Isend(const void* data, int items,
    MPI_Datatype type, int to, int tag, MPI_Comm communicator, MPI_Request* request)
  {
    count(items, type, false);
    return PMPI_Isend(data, items, type, to, tag, communicator, request);
  }

  __attribute__((visibility("default"))) int MPI_Allreduce(const void* data, void* result,
    int items, MPI_Datatype type, MPI_Op operation, MPI_Comm communicator)
  {
    count(items, type, true);
    return PMPI_Allreduce(data, result, items, type, operation, communicator);
  }
}

namespace benchmark
{
MpiTraffic MpiTraffic::now()
{
  return traffic;
}
}
