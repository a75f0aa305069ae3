// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

/// Agreement between the processes of a parallel run, over VTK's global controller. Without a
/// controller, or with one process, each function returns at once. Otherwise every process has to
/// make the same calls in the same order.
namespace morph::filters::Ranks
{
/// Whether this build morphs meshes whose pieces are on several processes: the CMake option
/// MESHMORPHING_USE_MPI.
bool TakePieces();

/// The number of processes. Not collective.
int Processes();

/// Whether this is the process that tells the user what all of them know.
bool IsFirst();

/// The number of processes that say `yes`.
int Count(bool yes);

enum class Outcome
{
  Success, ///< on every process
  Report,  ///< a process failed, and this one is the first of them: it tells the user
  Failure  ///< a process failed; another one tells the user
};

/// All processes get Success or none does: if one returned a result and another did not, a filter
/// downstream that communicates would wait for ever.
Outcome Agree(bool succeeded);

/// Calls `work`, which must not communicate. If it throws on some processes, all of them throw
/// morph::Error with the message of the first of these.
void Together(const std::function<void()>& work);
}
