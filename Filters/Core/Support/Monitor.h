// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace morph
{
/// Measures the time since it was made.
class Stopwatch
{
public:
  double seconds() const
  {
    return std::chrono::duration<double>(Clock::now() - this->start_).count();
  }

private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// The caller's interface to a long computation: progress, cancelling, warnings and threads. The
/// default is serial, silent and never cancels. progress(), cancelled() and warn() are only called
/// from the thread that called the library.
class Monitor
{
public:
  virtual ~Monitor();

  /// Reports the finished `fraction`, in [0, 1], of the current prepare or evaluate.
  virtual void progress(double fraction);
  /// Returns true to stop: the library soon throws Error of kind Cancelled. Its inputs stay
  /// untouched.
  virtual bool cancelled();
  /// Reports something that the user should know although a result was found.
  virtual void warn(const std::string& message);

  /// Calls body(first, last) on disjoint ranges that cover [0, n), perhaps in several threads.
  /// Every range but the last has at least `grain` elements. Results must not depend on the ranges.
  void parallelFor(Index n, Index grain, const std::function<void(Index first, Index last)>& body);
  /// The most threads that share a loop.
  virtual int threads() const { return 1; }

  /// Throws Error of kind Cancelled if cancelled().
  void check();

protected:
  /// parallelFor() for n > 0 elements by more than one thread.
  virtual void share(
    Index n, Index grain, const std::function<void(Index first, Index last)>& body);
};

/// Maps the progress of a part, 0 to 1, to the range `first` to `last` of the whole. Reported
/// progress never decreases.
class ProgressRange : public Monitor
{
public:
  ProgressRange(Monitor& whole, double first, double last)
    : whole_(whole)
    , first_(first)
    , last_(last)
  {
  }

  void progress(double fraction) override
  {
    if (fraction > this->told_)
    {
      this->told_ = std::min(fraction, 1.);
      this->whole_.progress(this->first_ + this->told_ * (this->last_ - this->first_));
    }
  }
  bool cancelled() override { return this->whole_.cancelled(); }
  void warn(const std::string& message) override { this->whole_.warn(message); }
  int threads() const override { return this->whole_.threads(); }

protected:
  void share(
    Index n, Index grain, const std::function<void(Index first, Index last)>& body) override
  {
    this->whole_.parallelFor(n, grain, body);
  }

private:
  Monitor& whole_;
  double first_, last_, told_ = 0;
};

/// Keeps warnings until they are taken: of code that says them again, or has other numbers of nodes
/// and cells.
class QuietRange : public ProgressRange
{
public:
  using ProgressRange::ProgressRange;
  void warn(const std::string& message) override { this->warnings_.push_back(message); }
  std::vector<std::string> take() { return std::exchange(this->warnings_, {}); }

private:
  std::vector<std::string> warnings_;
};
}
