// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <thread>
#include <vector>

namespace meshes
{
/// Calls body(t) for each t in [0, n) at once: in this thread for t = 0, and each other in its own.
/// Calls them one after the other where a program has one thread only.
template <typename Body>
void inThreads(int n, const Body& body)
{
  std::vector<std::thread> threads;
  for (int t = 1; t < n; ++t)
  {
#if defined(__EMSCRIPTEN__) && !defined(__EMSCRIPTEN_PTHREADS__)
    body(t);
#else
    threads.emplace_back([&body, t] { body(t); });
#endif
  }
  if (n > 0)
  {
    body(0);
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
}
}
