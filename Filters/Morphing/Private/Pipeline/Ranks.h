// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

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

namespace morph::filters
{
/// The processes that have parts of one mesh: this one alone, or all. With one, each function
/// returns what it was given. Otherwise all processes make the same calls in the same order.
class RankGroup
{
public:
  explicit RankGroup(bool isOfAll)
    : IsShared(isOfAll)
  {
  }

  bool IsOfAll() const { return this->IsShared; }
  /// See Ranks::Together().
  void Together(const std::function<void()>& work) const;
  /// Whether this is the process that tells the user what all of them know.
  bool IsFirst() const;
  /// Whether any process says `yes`.
  bool Any(bool yes) const;
  /// Element-wise over the processes.
  ///@{
  void Sum(morph::Index* values, std::size_t size) const;
  void Sum(double* values, std::size_t size) const;
  ///@}
  double Minimum(double value) const;
  double Maximum(double value) const;
  /// The values of all processes, in their order.
  std::vector<double> Gather(const std::vector<double>& mine) const;
  /// Gives all processes the values, or the text, of the first with some.
  void Share(std::vector<double>& values) const;
  void Share(std::string& text) const;

private:
  bool IsShared;
};
}
