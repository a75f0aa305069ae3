// SPDX-License-Identifier: BSD-3-Clause
#include "Support/Parallel.h"

#include "Meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

using namespace morph;

TEST(Parallel, EachNumberIsCalledOnceWhateverTheThreads)
{
  for (const Index n : { 0, 1, 4095, 4096, 4097, 30000 })
  {
    for (const int threads : { 1, 2, 5 })
    {
      meshes::ThreadedMonitor monitor(threads);
      std::vector<int> calls(n, 0), callsByTen(n, 0);
      parallel(n, monitor, [&](Index i) { ++calls[i]; });
      parallel(n, 10, monitor, [&](Index i) { ++callsByTen[i]; });
      EXPECT_EQ(calls, std::vector<int>(n, 1)) << n << ", " << threads << " threads";
      EXPECT_EQ(callsByTen, calls) << n << ", " << threads << " threads";
    }
  }
}

TEST(Parallel, AThreadTakesAtLeastTheGrain)
{
  constexpr Index N = 100;
  meshes::ThreadedMonitor monitor(4);
  std::vector<std::thread::id> thread(N);
  const auto note = [&](Index i) { thread[i] = std::this_thread::get_id(); };
  parallel(N, monitor, note); // too few for a second thread
  EXPECT_EQ(std::count(thread.begin(), thread.end(), std::this_thread::get_id()), N);
  parallel(N, 25, monitor, note);
  for (Index i = 0; i < N; ++i)
  {
    EXPECT_EQ(thread[i], thread[i / 25 * 25]) << i;
    EXPECT_EQ(thread[i] == thread[0], i < 25) << i;
  }
}
