// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <functional>
#include <string>

namespace morph
{
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
  virtual void parallelFor(
    Index n, Index grain, const std::function<void(Index first, Index last)>& body);

  /// Throws Error of kind Cancelled if cancelled().
  void check();
};
}
