// SPDX-License-Identifier: BSD-3-Clause
// Several threads with one prepared object; for the linear methods see TestLinearMorphers.cxx.
#include "InThreads.h"
#include "LinearMethods/FemWarp.h"
#include "Meshes.h"
#include "Motions.h"
#include "Untangling/InversionFree.h"
#include "Untangling/Smoothing.h"

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <memory>
#include <vector>

using namespace morph;

namespace
{
using Motion = std::function<motions::Row(const motions::Row& x, int thread)>;

motions::Row twisted(const motions::Row& x, int thread)
{
  return motions::twist(x, 6, 5, .7 * (thread + 1));
}

void expectSameBits(Morpher& method, const Motion& motion = twisted)
{
  Mesh mesh = meshes::hexes(6, 5, 5);
  meshes::jitterInterior(mesh, .2, meshes::seed());
  const NodePartition partition = motions::outerPartition(mesh);
  constexpr int Threads = 3;
  Monitor monitor;
  method.prepare(mesh, partition, monitor);
  Points target[Threads], expected[Threads];
  for (int t = 0; t < Threads; ++t)
  {
    target[t] =
      motions::targets(mesh, partition, [&](const motions::Row& x) { return motion(x, t); });
    method.evaluate(target[t], expected[t], monitor);
  }
  method.prepare(mesh, partition, monitor);
  std::atomic<int> different{ 0 };
  meshes::inThreads(Threads,
    [&](int t)
    {
      Monitor own;
      const Points moved = motions::moved(method, target[t], own);
      different += !motions::identical(moved, expected[t]);
    });
  EXPECT_EQ(different, 0);
}
}

TEST(Concurrency, InversionFreeGivesTheSameBits)
{
  InversionFree method;
  expectSameBits(method);
}

TEST(Concurrency, SmoothingGivesTheSameBits)
{
  Smoothing method;
  expectSameBits(method);
}

// Only affine motions ask for the residual of affine motions.
TEST(Concurrency, FemWarpGivesTheSameBitsForAffineMotions)
{
  FemWarp method;
  expectSameBits(
    method, [](const motions::Row& x, int thread) { return motions::affine((thread + 1) * x); });
}
