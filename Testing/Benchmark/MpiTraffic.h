// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace benchmark
{
/// What this rank has sent by MPI since the program started, hypre's messages included: counted by
/// MPI's profiling interface.
struct MpiTraffic
{
  double bytes = 0;
  double messages = 0;
  double reductions = 0; ///< collective calls

  static MpiTraffic now();
  MpiTraffic operator-(const MpiTraffic& earlier) const
  {
    return { this->bytes - earlier.bytes, this->messages - earlier.messages,
      this->reductions - earlier.reductions };
  }
};
}
