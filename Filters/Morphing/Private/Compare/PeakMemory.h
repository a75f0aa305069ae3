// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace morph::filters
{
/// The most memory that this process has held since the object was made, more than it held then. On
/// Linux; NaN elsewhere, and where the system does not let a process set its peak back.
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
