// SPDX-License-Identifier: BSD-3-Clause
#include "Aborts.h"

#include "Case.h"

#include <algorithm>
#include <iostream>
#include <random>
#include <string>
#include <vector>

namespace soak
{
namespace
{
using morph::Index;
using morph::Points;

/// Seconds from an abort until the filter was back, and the progress at which it noticed.
struct Late
{
  double seconds;
  double progress;
};

struct Outcome
{
  std::vector<Late> late;
  int finished = 0;  ///< before they were stopped
  int deformed = 0;  ///< outputs that are not the undeformed mesh
  int misnamed = 0;  ///< without the status Cancelled
  int differing = 0; ///< runs to the end with other bits than a fresh filter's
  int checked = 0;   ///< runs to the end after an abort
};

bool print(const Method& method, const AbortOptions& options, Index nodes, const double* cold,
  Outcome& outcome)
{
  std::vector<Late>& late = outcome.late;
  std::sort(
    late.begin(), late.end(), [](const Late& a, const Late& b) { return a.seconds > b.seconds; });
  const bool isRight = static_cast<int>(late.size()) == options.aborts &&
                       late.front().seconds <= options.seconds && outcome.deformed == 0 &&
                       outcome.misnamed == 0 && outcome.differing == 0 && outcome.checked > 0;
  std::cout << method.name << ": " << nodes << " nodes, whole runs of " << cold[0] << " and "
            << cold[1] << " s, " << late.size() << " aborts; back after";
  for (std::size_t i = 0; i < std::min<std::size_t>(5, late.size()); ++i)
  {
    std::cout << (i ? ", " : " ") << late[i].seconds << " s (at progress " << late[i].progress
              << ")";
  }
  std::cout << " at worst, median " << (late.empty() ? 0 : late[late.size() / 2].seconds)
            << " s; deformed " << outcome.deformed << ", not Cancelled " << outcome.misnamed
            << ", next runs " << outcome.checked << ", of them different " << outcome.differing
            << "; " << outcome.finished << " had finished" << (isRight ? "" : ": WRONG")
            << std::endl;
  return isRight;
}
}

bool stopsRight(const Method& method, const AbortOptions& options)
{
  Case world(options.cells, options.seed);
  std::mt19937 random(options.seed);
  const Points rest = grids::points(world.grid());
  const vtkSmartPointer<vtkPolyData> boundaries[2] = { world.boundary(), world.partOfBoundary() };

  // What each boundary gives in a fresh filter, and how long that takes, again where the method is
  // prepared already.
  Points expected[2];
  double cold[2], warm[2];
  for (int k = 0; k < 2; ++k)
  {
    const auto fresh = method.make(nullptr);
    const grids::Listener listener(fresh);
    fresh->SetInputData(world.grid());
    fresh->FixUnnamedBoundaryOff(); // held beside others that move, it would fold
    fresh->SetBoundaryData(boundaries[k]);
    const double start = Clock::now();
    fresh->Update();
    const double middle = Clock::now();
    fresh->Modified();
    fresh->Update();
    cold[k] = middle - start;
    warm[k] = Clock::now() - middle;
    expected[k] = grids::points(fresh->GetOutput());
    if (!listener.Errors.empty())
    {
      std::cout << method.name << ": " << listener.Errors[0] << std::endl;
      return false;
    }
  }

  Abort abort;
  const auto filter = method.make(&abort);
  const grids::Listener listener(filter);
  filter->SetInputData(world.grid());
  filter->FixUnnamedBoundaryOff();
  Outcome outcome;
  int before = 0;          // the boundary of the run before
  bool isPrepared = false; // that one came to its end
  while (static_cast<int>(outcome.late.size()) < options.aborts &&
         outcome.finished < 10 * options.aborts)
  {
    const bool isWarm = isPrepared && random() % 2 == 0;
    const int k = isWarm ? before : 1 - before;
    before = k;
    filter->SetBoundaryData(boundaries[k]);
    filter->Modified();
    const double whole = isWarm ? warm[k] : cold[k];
    abort.progress = -1;
    abort.at = Clock::now() + std::uniform_real_distribution<double>(0, whole)(random);
    abort.armed = true;
    filter->Update();
    const double late = Clock::now() - abort.at;
    abort.armed = false;
    isPrepared = abort.progress < 0;
    if (isPrepared)
    {
      ++outcome.finished;
      outcome.differing += !(grids::points(filter->GetOutput()) == expected[k]);
      continue;
    }
    outcome.late.push_back({ late, abort.progress });
    outcome.deformed += !(grids::points(filter->GetOutput()) == rest);
    outcome.misnamed += std::string(filter->GetMorphStatus()) != "Cancelled";
    if (outcome.late.size() % static_cast<std::size_t>(options.checkEvery) == 0)
    {
      filter->Modified();
      filter->Update();
      ++outcome.checked;
      outcome.differing += !(grids::points(filter->GetOutput()) == expected[k]);
      isPrepared = true;
    }
  }
  return print(method, options, rest.rows(), cold, outcome);
}
}
