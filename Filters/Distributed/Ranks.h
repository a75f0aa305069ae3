// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <mpi.h>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <functional>
#include <type_traits>
#include <vector>

namespace morph::distributed
{
/// Lists one after the other.
template <typename List>
List joined(const std::vector<List>& lists)
{
  List all;
  for (const List& list : lists)
  {
    all.insert(all.end(), list.begin(), list.end());
  }
  return all;
}

/// The MPI ranks of a computation. Every function but rank() and count() is collective: all ranks
/// call it, in the same order.
class Ranks
{
public:
  /// `communicator` has to outlive this object.
  explicit Ranks(MPI_Comm communicator);

  int rank() const { return this->rank_; }
  int count() const { return this->count_; }
  MPI_Comm communicator() const { return this->communicator_; }

  /// Calls `work`. If it throws on some ranks, all ranks throw Error with the message of the first
  /// of these: the others at their next communication by this object, which may be in `work`. So no
  /// rank waits for one that has given up. Calls may be nested.
  void together(const std::function<void()>& work) const;

  /// Over the ranks, element-wise; all get the result. Values are double or Index.
  ///@{
  template <typename Value>
  void sum(Value* values, std::size_t size) const
  {
    this->reduce(values, size, MPI_SUM);
  }
  template <typename Value>
  void maximum(Value* values, std::size_t size) const
  {
    this->reduce(values, size, MPI_MAX);
  }
  template <typename Value>
  Value sum(Value value) const
  {
    this->reduce(&value, 1, MPI_SUM);
    return value;
  }
  double sum(double value) const;
  template <typename Value>
  Value minimum(Value value) const
  {
    this->reduce(&value, 1, MPI_MIN);
    return value;
  }
  template <typename Value>
  Value maximum(Value value) const
  {
    this->reduce(&value, 1, MPI_MAX);
    return value;
  }
  ///@}
  /// Returns the sum over the ranks before this one.
  Index sumBefore(Index value) const;

  /// Sends `to[r]` to each rank r, and returns what each rank sent here. Items are trivially
  /// copyable, or lists or texts of such. Throws Error on all ranks where a list has more than
  /// 2^31 - 1 items.
  template <typename Item>
  std::vector<std::vector<Item>> exchange(const std::vector<std::vector<Item>>& to) const
  {
    std::vector<std::vector<Item>> result(this->count_);
    if constexpr (std::is_trivially_copyable_v<Item>)
    {
      std::vector<int> sent(this->count_), received;
      std::vector<const void*> from(this->count_);
      std::size_t longest = 0;
      for (int r = 0; r < this->count_; ++r)
      {
        longest = std::max(longest, to[r].size());
        sent[r] = static_cast<int>(to[r].size());
      }
      this->requireMessageSize(longest);
      received = this->exchangeSizes(sent);
      std::vector<void*> into(this->count_);
      for (int r = 0; r < this->count_; ++r)
      {
        result[r].resize(received[r]);
        from[r] = to[r].data();
        into[r] = result[r].data();
      }
      this->exchangeBytes(sizeof(Item), sent, from, received, into);
    }
    else
    {
      std::vector<std::vector<std::size_t>> sizes(this->count_);
      std::vector<std::vector<typename Item::value_type>> values(this->count_);
      for (int r = 0; r < this->count_; ++r)
      {
        for (const Item& list : to[r])
        {
          sizes[r].push_back(list.size());
          values[r].insert(values[r].end(), list.begin(), list.end());
        }
      }
      sizes = this->exchange(sizes);
      values = this->exchange(values);
      for (int r = 0; r < this->count_; ++r)
      {
        auto at = values[r].begin();
        for (const std::size_t size : sizes[r])
        {
          result[r].emplace_back(at, at + static_cast<std::ptrdiff_t>(size));
          at += static_cast<std::ptrdiff_t>(size);
        }
      }
    }
    return result;
  }

  /// Sends each item to the rank that `rankOf` gives it, and returns for each what that rank
  /// answers. `answersTo`: makes a list of answers for each rank of the list of its items.
  template <typename Answer, typename Item, typename RankOf, typename AnswersTo>
  std::vector<Answer> ask(
    const std::vector<Item>& items, const RankOf& rankOf, const AnswersTo& answersTo) const
  {
    std::vector<std::vector<Item>> to(this->count_);
    for (const Item& item : items)
    {
      to[rankOf(item)].push_back(item);
    }
    const std::vector<std::vector<Answer>> answers = this->exchange(answersTo(this->exchange(to)));
    std::vector<std::size_t> next(this->count_, 0);
    std::vector<Answer> result;
    for (const Item& item : items)
    {
      const int rank = rankOf(item);
      result.push_back(answers[rank][next[rank]++]);
    }
    return result;
  }

  /// Returns the items of all ranks, rank by rank.
  template <typename Item>
  std::vector<Item> gather(const std::vector<Item>& mine) const
  {
    return joined(this->exchange(std::vector<std::vector<Item>>(this->count_, mine)));
  }

  /// gather(), ascending.
  template <typename Item>
  std::vector<Item> gatherSorted(const std::vector<Item>& mine) const
  {
    std::vector<Item> all = this->gather(mine);
    std::sort(all.begin(), all.end());
    return all;
  }

  /// Point-to-point messages: fills `into`, one buffer a rank of `sources`, from the ranks that
  /// name this one in `targets` with buffers of the same size.
  void exchangeNeighbors(const std::vector<int>& targets,
    const std::vector<std::vector<double>>& from, const std::vector<int>& sources,
    std::vector<std::vector<double>>& into) const;

private:
  /// Sums `value` over the ranks. Throws Error on all of them if one gives a failure.
  double meet(double value, const std::exception_ptr& failure) const;
  /// Called before a communication: throws if another rank has failed in together() meanwhile.
  void vote() const;
  void reduce(double* values, std::size_t size, MPI_Op operation) const;
  void reduce(Index* values, std::size_t size, MPI_Op operation) const;
  void requireMessageSize(std::size_t items) const;
  std::vector<int> exchangeSizes(const std::vector<int>& sent) const;
  void exchangeBytes(std::size_t itemSize, const std::vector<int>& sent,
    const std::vector<const void*>& from, const std::vector<int>& received,
    const std::vector<void*>& into) const;

  MPI_Comm communicator_;
  int rank_ = 0;
  int count_ = 1;
  mutable int depth_ = 0; ///< of calls of together()
};
}
