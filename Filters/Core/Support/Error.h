// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace morph
{
/// The one exception type of the core. Its message names the fault, the node or cell ids, and a
/// remedy.
class Error : public std::runtime_error
{
public:
  enum class Kind
  {
    InvalidInput,  ///< the caller's data cannot be used
    Singular,      ///< the data do not determine a unique solution
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

/// A matrix has rows without a positive diagonal. The caller that assembled it knows their nodes.
class SingularRows : public Error
{
public:
  explicit SingularRows(const std::vector<std::int64_t>& rows);
  const std::vector<std::int64_t>& rows() const { return this->rows_; }

private:
  std::vector<std::int64_t> rows_;
};

/// Throws Error, which names `what`, unless an array has as many rows as are expected.
void requireRows(const char* what, std::int64_t rows, std::int64_t expected);

/// Formats the first `most` ids for a message: "3, 7, 9" or "3, 7, 9, ... (120 in all)".
std::string listIds(const std::vector<std::int64_t>& ids, std::size_t most = 10);
}
