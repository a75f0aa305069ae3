// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace morph::filters
{
/// The largest increase of this process's memory since the object was made. Linux only: NaN
/// elsewhere, and where the system does not let a process reset its peak.
class PeakMemory
{
public:
  PeakMemory();
  /// Of 10^6 bytes.
  double Megabytes() const;

private:
  double Start;
};
}
