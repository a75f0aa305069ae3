// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace morph
{
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
  void parallelFor(
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
