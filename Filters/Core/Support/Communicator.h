// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"
#include "Support/Types.h"

#include <functional>
#include <memory>
#include <vector>

namespace morph
{
/// Rows of values of some nodes, of which other processes may have copies; see Communicator. This
/// class is that of one process. Every function is collective.
class CopiedRows
{
public:
  virtual ~CopiedRows();
  /// Gives each copy of a row the sum of all its copies, to the same bits. `rows`: #rows x 3.
  virtual void add(Points& rows) const;
  /// Returns the sum of the products of all entries, in which the copies of a row count once.
  virtual double dot(const Points& a, const Points& b, Monitor& monitor) const;
  /// Returns the rows that count on another process, ascending. Not collective.
  virtual const std::vector<Index>& countedElsewhere() const;

  static const CopiedRows& alone();
};

/// What processes with parts of one mesh tell one another, so that code of one mesh runs on all of
/// them. Each cell is on one process. A node is on every process whose cells use it, and all its
/// copies have the same position. This class is that of one process, which has the whole mesh.
///
/// Every function is collective: all processes call it, in the same order. So what decides which
/// function is called next has to be the same on all of them.
class Communicator
{
public:
  virtual ~Communicator();

  /// Calls `work`. If it throws on one process, all throw its Error, the others at their next
  /// communication. Calls may be nested.
  virtual void together(const std::function<void()>& work) const;
  /// Returns the numbers of nodes in the whole mesh, for messages. Not collective.
  virtual std::vector<Index> idsOf(const std::vector<Index>& nodes) const;

  /// Over all processes; all get the same bits.
  ///@{
  virtual double sum(double value) const;
  virtual double minimum(double value) const;
  /// Each of `count` values.
  virtual void sum(double* values, int count) const;
  virtual void maximum(double* values, int count) const;
  /// For values below 2^53.
  Index sum(Index value) const { return static_cast<Index>(this->sum(static_cast<double>(value))); }
  double maximum(double value) const { return -this->minimum(-value); }
  bool all(bool value) const { return this->sum(Index(!value)) == 0; }
  ///@}

  /// Adds the nodes of this process of which another process has a copy in its `nodes`. The order
  /// changes where there are some.
  virtual void spread(std::vector<Index>& nodes) const;
  /// Returns what is needed to sum rows of all nodes, or of these, each of which is in the list
  /// once.
  ///@{
  virtual std::unique_ptr<CopiedRows> rows() const;
  std::unique_ptr<CopiedRows> rows(const std::vector<Index>& nodes) const
  {
    return this->part(nodes)->rows();
  }
  ///@}
  /// Returns the communicator of a part of the mesh, whose node i is `nodes`[i] here.
  virtual std::unique_ptr<Communicator> part(const std::vector<Index>& nodes) const;

  static const Communicator& alone();
};
}
