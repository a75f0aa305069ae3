// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace morph
{
/// The one exception type of the core. The message says what is wrong, where (node or cell ids) and
/// what to do about it.
class Error : public std::runtime_error
{
public:
  enum class Kind
  {
    InvalidInput,  ///< the caller's data cannot be used
    Singular,      ///< the data leave the system without a unique solution
    NoConvergence, ///< the iteration stopped above the tolerance
    Cancelled      ///< Monitor::cancelled() returned true
  };

  Error(Kind kind, const std::string& message)
    : std::runtime_error(message)
    , kind_(kind)
  {
  }
  explicit Error(const std::string& message)
    : Error(Kind::InvalidInput, message)
  {
  }

  Kind kind() const { return this->kind_; }

private:
  Kind kind_;
};

/// The matrix rows that have no positive diagonal: who assembled the matrix knows which nodes they
/// are.
class SingularRows : public Error
{
public:
  explicit SingularRows(const std::vector<std::int64_t>& rows);
  const std::vector<std::int64_t>& rows() const { return this->rows_; }

private:
  std::vector<std::int64_t> rows_;
};

/// "3, 7, 9" or "3, 7, 9, ... (120 in all)": the first few ids for a message.
std::string listIds(const std::vector<std::int64_t>& ids, std::size_t most = 10);
}
