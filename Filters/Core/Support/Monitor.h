// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <functional>
#include <string>

namespace morph
{
/// What a long computation tells its caller and asks of it. The default is serial, silent and never
/// cancels. progress(), cancelled() and warn() are only called from the thread that called the
/// library.
class Monitor
{
public:
  virtual ~Monitor();

  /// `fraction` in [0, 1] of the current prepare or evaluate.
  virtual void progress(double fraction);
  /// True to stop: the library throws Error of kind Cancelled soon after, leaving its inputs
  /// untouched.
  virtual bool cancelled();
  /// Something the user should know although a result was found.
  virtual void warn(const std::string& message);

  /// Calls body(first, last) on disjoint ranges that cover [0, n), perhaps from several threads at
  /// once. No range but the last is shorter than `grain`. How the ranges are cut must not show in a
  /// result.
  virtual void parallelFor(
    Index n, Index grain, const std::function<void(Index first, Index last)>& body);

  /// Throws Error of kind Cancelled if cancelled().
  void check();
};
}
