// SPDX-License-Identifier: BSD-3-Clause
#include "Memory.h"

#include "Case.h"

#include <algorithm>
#include <iostream>
#include <string>

namespace soak
{
namespace
{
constexpr double Growth = 1.01;

Process largest(const Process& a, const Process& b)
{
  return { std::max(a.resident, b.resident), std::max(a.heap, b.heap),
    std::max(a.handles, b.handles), std::max(a.threads, b.threads) };
}

double percent(std::size_t before, std::size_t after)
{
  return before > 0 ? 100 * (static_cast<double>(after) / static_cast<double>(before) - 1) : 0;
}

bool isFlat(std::size_t before, std::size_t after)
{
  return static_cast<double>(after) <= Growth * static_cast<double>(before);
}
}

bool staysFlat(const Method& method, const MemoryOptions& options)
{
  Case world(options.cells, options.seed);
  const auto filter = method.make(nullptr);
  grids::Listener listener(filter);
  filter->SetInputData(world.grid());
  filter->FixUnnamedBoundaryOff();
  Process start, end;
  const int first = options.morphs / 2; // long enough for the largest arrays to have come up
  std::string firstError;
  int failures = 0;
  for (int k = 0; k < options.morphs; ++k)
  {
    filter->SetBoundaryData(k % 5 == 4 ? world.partOfBoundary() : world.boundary());
    filter->Update();
    failures += !listener.Errors.empty() ||
                filter->GetOutput()->GetNumberOfPoints() != world.grid()->GetNumberOfPoints();
    if (firstError.empty() && !listener.Errors.empty())
    {
      firstError = listener.Errors[0];
    }
    listener.Warnings.clear(); // they are not the filter's memory
    listener.Errors.clear();
    Process now;
    measure(now);
    (k < first ? start : end) = largest(k < first ? start : end, now);
  }
  const bool isRight = isFlat(start.resident, end.resident) && isFlat(start.heap, end.heap) &&
                       end.handles <= start.handles && end.threads <= start.threads &&
                       failures == 0;
  std::cout << method.name << ": " << options.morphs << " morphs of "
            << world.grid()->GetNumberOfPoints() << " nodes, the first " << first
            << " against the others: resident " << static_cast<double>(start.resident) / 1e6
            << " MB, " << percent(start.resident, end.resident) << " %; heap "
            << static_cast<double>(start.heap) / 1e6 << " MB, " << percent(start.heap, end.heap)
            << " %; handles " << start.handles << ", " << end.handles << "; threads "
            << start.threads << ", " << end.threads << "; without a result " << failures
            << (isRight ? "" : ": NOT FLAT") << std::endl;
  if (!firstError.empty())
  {
    std::cout << "The first error: " << firstError << std::endl;
  }
  return isRight;
}
}
