// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// What the processes of a parallel run must agree on, over VTK's global controller. Without one,
/// or with one process, each function returns at once. Otherwise every process has to make the same
/// calls in the same order.
namespace morph::filters::Ranks
{
/// How many processes say `yes`.
int Count(bool yes);

enum class Outcome
{
  Success, ///< on every process
  Report,  ///< a process failed, and this one is the first of those: it tells the user
  Failure  ///< a process failed; another one tells the user
};

/// All processes get Success or none does: if one returned a result and another did not, a filter
/// downstream that communicates would wait for ever.
Outcome Agree(bool succeeded);
}
