// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Monitor.h"
#include "Support/Types.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace morph
{
class CellPieces;
class LinearSolver;
struct ConnectedComponents;
struct Mesh;

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
  /// Gives copies the row of the process on which it counts.
  void update(Points& rows) const;
  /// Adds copies to the row that counts, and sets them to zero.
  void collect(Points& rows) const;

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
  /// Whether this process speaks for all. Not collective.
  virtual bool isFirst() const { return true; }

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
  /// Returns the sum over the processes before this one.
  virtual Index sumBefore(Index /*value*/) const { return 0; }

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
  /// Returns the communicator of a part of the mesh, whose node i is `nodes`[i] here. No cell of it
  /// is a copy.
  virtual std::unique_ptr<Communicator> part(const std::vector<Index>& nodes) const;

  /// Of a whole mesh, whose cells a process has with copies of those around its nodes.
  ///@{
  /// Of this process's nodes and cells, by the same numbers on all: the bodies, and cellSigns().
  /// Null where one process finds them. Not collective.
  virtual const ConnectedComponents* bodies() const { return nullptr; }
  virtual const std::vector<std::int8_t>* orientation() const { return nullptr; }
  /// Whether a cell is a copy of one that another process has. Not collective.
  virtual bool isCopy(Index /*cell*/) const { return false; }
  /// Whether a node counts here: of those that have it one process does. Not collective.
  virtual bool owns(Index /*node*/) const { return true; }
  /// Gives copies of nodes the row of the process where the node counts. `rows`: #nodes x 3.
  virtual void update(Points& /*rows*/) const {}
  /// Returns the numbers in the whole mesh of these of all processes, ascending. `nodes`: each is
  /// in the list of one process. Of cells, copies are left out.
  ///@{
  virtual std::vector<Index> gatherNodes(const std::vector<Index>& nodes) const { return nodes; }
  virtual std::vector<Index> gatherCells(const std::vector<Index>& cells) const { return cells; }
  ///@}
  /// Returns the nodes here that any process names by their numbers in the whole mesh.
  virtual std::vector<Index> nodesOf(const std::vector<Index>& ids) const { return ids; }
  /// Returns the rows of these nodes of all processes, each once, in the order of the nodes'
  /// numbers in the whole mesh. `rows`: of all nodes here.
  virtual Points gather(const Points& rows, const std::vector<Index>& nodes) const;
  /// Gives copies of cells the values of those that they are copies of. `values`: of this process's
  /// own cells, which come first, or none.
  virtual void completeCells(std::vector<double>& /*values*/) const {}
  /// Joins the components that processes have of some nodes where these have a node in common.
  /// `ofNode`: #nodes, -1 for others; becomes numbers from 0 that are the same on all processes.
  /// Returns how many there are.
  virtual Index join(std::vector<Index>& ofNode) const;
  /// Numbers `nodes` of all processes, one process after the other. Returns the numbers of `others`
  /// here, which are in the list of another process.
  virtual std::vector<Index> numbersOf(
    const std::vector<Index>& nodes, const std::vector<Index>& others) const;
  /// Returns a solver of equations whose rows several processes have; null for one process, which
  /// has its own. Not collective.
  virtual std::shared_ptr<LinearSolver> makeSolver(bool isSymmetric) const;
  /// Returns the numbers of cells in the whole mesh, copies included. Not collective.
  virtual std::vector<Index> idsOfCells(const std::vector<Index>& cells) const { return cells; }
  /// Returns the cells here, ascending, that have these ascending numbers in the whole mesh and are
  /// no copies. Not collective.
  virtual std::vector<Index> cellsOf(const std::vector<Index>& ids) const { return ids; }
  /// Returns the lists of all processes, one after the other.
  virtual std::vector<double> gather(const std::vector<double>& values) const { return values; }
  /// Returns the pieces of cells that methods see, with so many layers of copies around those of
  /// each process; null for one process: see cutCells(). `mesh`: of this process, at any points.
  virtual std::shared_ptr<CellPieces> cut(const Mesh& mesh, int layers, Monitor& monitor) const;
  ///@}

  static const Communicator& alone();
};

/// Keeps back the warnings of all processes but the first: they are of the whole mesh.
class FirstSpeaks : public ProgressRange
{
public:
  FirstSpeaks(Monitor& whole, const Communicator& processes)
    : ProgressRange(whole, 0, 1)
    , speaks_(processes.isFirst())
  {
  }
  void warn(const std::string& message) override
  {
    if (this->speaks_)
    {
      ProgressRange::warn(message);
    }
  }

private:
  bool speaks_;
};
}
