// SPDX-License-Identifier: BSD-3-Clause
#include "RootRate.h"

#include "Timing.h"

#include "Support/Simd.h"

#include <algorithm>
#include <vector>

namespace benchmark
{
namespace
{
constexpr int Chains = 4; // independent registers: more than a root's latency takes
constexpr int Length = 10000;
constexpr morph::Index Blocks = 2000;

struct Roots
{
  static MORPH_SIMD_INLINE void run(morph::Index block, std::vector<double>& last)
  {
    morph::SimdDouble4 x[Chains];
    for (int c = 0; c < Chains; ++c)
    {
      x[c] = morph::SimdDouble4{ 1, 2, 3, 4 } + (last[block] + c);
    }
    for (int i = 0; i < Length; ++i)
    {
      for (int c = 0; c < Chains; ++c)
      {
        x[c] = morph::squareRoot(x[c] + 1.);
      }
    }
    last[block] = x[0][0] + x[1][1] + x[2][2] + x[3][3];
  }
};
}

double measureRootRate(morph::Monitor& monitor)
{
  std::vector<double> last(Blocks, 1), seconds;
  for (int i = 0; i < 5; ++i)
  {
    const Stopwatch watch;
    monitor.parallelFor(Blocks, 1,
      [&](morph::Index first, morph::Index end) { morph::dispatchedFor<Roots>(first, end, last); });
    seconds.push_back(watch.seconds());
  }
  const double roots = static_cast<double>(Blocks) * Length * Chains * morph::SimdWidth;
  return roots / *std::min_element(seconds.begin(), seconds.end());
}
}
