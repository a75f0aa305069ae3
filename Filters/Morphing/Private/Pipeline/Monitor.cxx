// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Pipeline/Monitor.h"

#include "Private/Data/Version.h"

#include <vtkSMPTools.h>

#include <algorithm>
#include <exception>
#include <mutex>
#include <string>

namespace morph::filters
{
namespace
{
/// The backend to compute with: the user's choice, unless it has no threads.
std::string backend()
{
  const std::string own = vtkSMPTools::GetBackend();
  return own == "Sequential" ? "STDThread" : own;
}

/// The backend never starts more threads than this.
int mostThreads()
{
  int threads = 1;
  vtkSMPTools::LocalScope(vtkSMPTools::Config{ 0, backend(), false },
    [&threads] { threads = vtkSMPTools::GetEstimatedNumberOfThreads(); });
  return std::max(threads, 1);
}
}

bool Monitor::IsSequential()
{
  return std::string(vtkSMPTools::GetBackend()) == "Sequential";
}

Monitor::Monitor(vtkAlgorithm* algorithm, int threads)
  : Algorithm(algorithm)
  , Threads(threads > 0 ? std::min(threads, mostThreads()) : mostThreads())
{
}

void Monitor::SetRange(double first, double last)
{
  this->First = first;
  this->Last = last;
}

void Monitor::progress(double fraction)
{
  if (!this->Algorithm)
  {
    return;
  }
  const double value =
    this->First + (this->Last - this->First) * std::min(std::max(fraction, 0.0), 1.0);
  // Only steps that a user can see, and never backwards.
  if (value >= this->Reported + 0.005)
  {
    this->Reported = value;
    this->Algorithm->UpdateProgress(value);
  }
}

bool Monitor::cancelled()
{
  return this->Algorithm && Version::AbortRequested(this->Algorithm);
}

void Monitor::warn(const std::string& message)
{
  if (this->Told.insert(message).second)
  {
    this->Warnings.push_back(message);
  }
}

std::vector<std::string> Monitor::TakeWarnings()
{
  std::vector<std::string> taken;
  taken.swap(this->Warnings);
  this->Told.clear();
  return taken;
}

void Monitor::TellWarnings()
{
  for (const std::string& warning : this->TakeWarnings())
  {
    vtkWarningWithObjectMacro(this->Algorithm, << warning);
  }
}

morph::Index Monitor::RangeLength(morph::Index n, morph::Index grain) const
{
  const morph::Index ranges = morph::Index{ 4 } * this->Threads;
  return std::max<morph::Index>({ grain, (n + ranges - 1) / ranges, 1 });
}

void Monitor::share(morph::Index n, morph::Index grain,
  const std::function<void(morph::Index first, morph::Index last)>& body)
{
  if (n <= grain)
  {
    body(0, n);
    return;
  }
  const morph::Index length = this->RangeLength(n, grain);

  std::mutex mutex;
  std::exception_ptr thrown;
  vtkSMPTools::LocalScope(vtkSMPTools::Config{ this->Threads, backend(), false },
    [&]
    {
      // In whole pieces: some backends split ranges below the grain that they are given.
      vtkSMPTools::For(0, (n + length - 1) / length, 1,
        [&](vtkIdType first, vtkIdType last)
        {
          try
          {
            body(first * length, std::min<morph::Index>(n, last * length));
          }
          catch (...)
          {
            const std::lock_guard<std::mutex> lock(mutex);
            if (!thrown)
            {
              thrown = std::current_exception();
            }
          }
        });
    });
  if (thrown)
  {
    std::rethrow_exception(thrown);
  }
}
}
