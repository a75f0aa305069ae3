// SPDX-License-Identifier: BSD-3-Clause
// A test must not leave early on one rank: EXPECT_..., not ASSERT_..., before the last collective
// call.
#include <gtest/gtest.h>

#include <mpi.h>

int main(int argc, char** argv)
{
  MPI_Init(&argc, &argv);
  testing::InitGoogleTest(&argc, argv);
  int failed = RUN_ALL_TESTS();
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  MPI_Finalize();
  return failed;
}
