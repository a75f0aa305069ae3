// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/Ranks.h"

#include "Support/Error.h"

#include <limits>
#include <new>
#include <string>

namespace morph::distributed
{
namespace
{
constexpr int Tag = 7361; // of all messages between two ranks

/// One that all ranks throw.
struct ErrorOfAll : Error
{
  using Error::Error;
};

template <typename Value>
void reduceAll(
  MPI_Comm communicator, Value* values, std::size_t size, MPI_Datatype type, MPI_Op operation)
{
  constexpr std::size_t Most = std::size_t(1) << 30; // MPI counts in int
  for (std::size_t first = 0; first < size; first += Most)
  {
    MPI_Allreduce(MPI_IN_PLACE, values + first, static_cast<int>(std::min(Most, size - first)),
      type, operation, communicator);
  }
}
}

Ranks::Ranks(MPI_Comm communicator)
  : communicator_(communicator)
{
  MPI_Comm_rank(communicator, &this->rank_);
  MPI_Comm_size(communicator, &this->count_);
}

double Ranks::meet(double value, const std::exception_ptr& failure) const
{
  double values[2] = { value, failure ? 1. : 0. };
  reduceAll(this->communicator_, values, 2, MPI_DOUBLE, MPI_SUM);
  if (values[1] == 0)
  {
    return values[0];
  }
  std::string message;
  Error::Kind kind = Error::Kind::InvalidInput;
  try
  {
    if (failure)
    {
      std::rethrow_exception(failure);
    }
  }
  catch (const Error& error)
  {
    kind = error.kind();
    message = error.what();
  }
  catch (const std::bad_alloc&)
  {
    message = "There is not enough memory on MPI rank " + std::to_string(this->rank_) + ".";
  }
  catch (const std::exception& error)
  {
    message = std::string("Unexpected failure: ") + error.what();
  }
  int first = failure ? this->rank_ : this->count_;
  reduceAll(this->communicator_, &first, 1, MPI_INT, MPI_MIN);
  int header[2] = { static_cast<int>(kind), static_cast<int>(message.size()) };
  MPI_Bcast(header, 2, MPI_INT, first, this->communicator_);
  message.resize(header[1]);
  MPI_Bcast(message.data(), header[1], MPI_CHAR, first, this->communicator_);
  throw ErrorOfAll(static_cast<Error::Kind>(header[0]), message);
}

void Ranks::vote() const
{
  if (this->depth_ > 0)
  {
    this->meet(0, nullptr);
  }
}

void Ranks::together(const std::function<void()>& work) const
{
  std::exception_ptr failure;
  ++this->depth_;
  try
  {
    work();
  }
  catch (const ErrorOfAll&)
  {
    --this->depth_;
    throw;
  }
  catch (...)
  {
    failure = std::current_exception();
  }
  --this->depth_;
  this->meet(0, failure);
}

void Ranks::reduce(double* values, std::size_t size, MPI_Op operation) const
{
  this->vote();
  reduceAll(this->communicator_, values, size, MPI_DOUBLE, operation);
}

void Ranks::reduce(Index* values, std::size_t size, MPI_Op operation) const
{
  this->vote();
  reduceAll(this->communicator_, values, size, MPI_INT64_T, operation);
}

double Ranks::sum(double value) const
{
  return this->meet(value, nullptr);
}

Index Ranks::sumBefore(Index value) const
{
  this->vote();
  Index before = 0;
  MPI_Exscan(&value, &before, 1, MPI_INT64_T, MPI_SUM, this->communicator_);
  return this->rank_ == 0 ? 0 : before;
}

void Ranks::requireMessageSize(std::size_t items) const
{
  const Index longest = this->maximum(static_cast<Index>(items));
  if (longest > std::numeric_limits<int>::max())
  {
    throw Error(
      "A message of " + std::to_string(longest) + " items is too long for MPI. Use more ranks.");
  }
}

std::vector<int> Ranks::exchangeSizes(const std::vector<int>& sent) const
{
  std::vector<int> received(this->count_);
  MPI_Alltoall(sent.data(), 1, MPI_INT, received.data(), 1, MPI_INT, this->communicator_);
  return received;
}

void Ranks::exchangeBytes(std::size_t itemSize, const std::vector<int>& sent,
  const std::vector<const void*>& from, const std::vector<int>& received,
  const std::vector<void*>& into) const
{
  MPI_Datatype item;
  MPI_Type_contiguous(static_cast<int>(itemSize), MPI_BYTE, &item);
  MPI_Type_commit(&item);
  std::vector<MPI_Request> requests;
  for (int r = 0; r < this->count_; ++r)
  {
    if (received[r] > 0)
    {
      MPI_Irecv(into[r], received[r], item, r, Tag, this->communicator_, &requests.emplace_back());
    }
  }
  for (int r = 0; r < this->count_; ++r)
  {
    if (sent[r] > 0)
    {
      MPI_Isend(from[r], sent[r], item, r, Tag, this->communicator_, &requests.emplace_back());
    }
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  MPI_Type_free(&item);
}

void Ranks::exchangeNeighbors(const std::vector<int>& targets,
  const std::vector<std::vector<double>>& from, const std::vector<int>& sources,
  std::vector<std::vector<double>>& into) const
{
  this->vote();
  std::vector<MPI_Request> requests(targets.size() + sources.size());
  MPI_Request* request = requests.data();
  for (std::size_t i = 0; i < sources.size(); ++i)
  {
    MPI_Irecv(into[i].data(), static_cast<int>(into[i].size()), MPI_DOUBLE, sources[i], Tag,
      this->communicator_, request++);
  }
  for (std::size_t i = 0; i < targets.size(); ++i)
  {
    MPI_Isend(from[i].data(), static_cast<int>(from[i].size()), MPI_DOUBLE, targets[i], Tag,
      this->communicator_, request++);
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}
}
