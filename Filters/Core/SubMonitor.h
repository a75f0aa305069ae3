// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Monitor.h"

namespace morph
{
/// A part of a longer computation: its progress from 0 to 1 is the whole's from `first` to `last`.
class SubMonitor : public Monitor
{
public:
  SubMonitor(Monitor& whole, double first, double last)
    : whole_(whole)
    , first_(first)
    , last_(last)
  {
  }

  void progress(double fraction) override
  {
    this->whole_.progress(this->first_ + fraction * (this->last_ - this->first_));
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
  double first_, last_;
};
}
