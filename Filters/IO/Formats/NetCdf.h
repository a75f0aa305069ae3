// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <cstdint>
#include <string>
#include <vector>

namespace morph::io
{
/// A file of netCDF: classic, 64-bit offset, 64-bit data or netCDF-4. Each function throws Error
/// where the file is damaged.
class NetCdf
{
public:
  enum class Access
  {
    Read,
    Write ///< of values in place
  };
  /// `name`: of the file, for messages.
  NetCdf(const std::string& path, const std::string& name, Access access = Access::Read);
  ~NetCdf();
  NetCdf(const NetCdf&) = delete;
  NetCdf& operator=(const NetCdf&) = delete;

  /// The length of a dimension; 0 where there is none.
  Index dimension(const std::string& name) const;
  bool has(const std::string& variable) const;
  bool isSinglePrecision(const std::string& variable) const;
  /// The values of a variable, which must have `count` of them.
  std::vector<double> numbers(const std::string& variable, Index count) const;
  /// Of an array, the `count` values of its last dimension at these places in those before.
  std::vector<double> row(
    const std::string& variable, std::vector<std::size_t> place, Index count) const;
  std::vector<Index> integers(const std::string& variable, Index count) const;
  /// The rows of an array of characters: `count` of them. None where there is no such variable.
  std::vector<std::string> texts(const std::string& variable, Index count) const;
  /// The text of an attribute; empty where there is none.
  std::string attribute(const std::string& variable, const std::string& name) const;

  /// Replaces the values of a variable.
  void write(const std::string& variable, const std::vector<double>& values);
  /// Ends writing.
  void close();

private:
  int variable(const std::string& name, Index count) const;
  void check(int status, const std::string& what) const;

  std::string name_;
  std::string content_; ///< of a classic file that is read
  std::uintmax_t longest_ = 0;
  int file_ = -1;
  bool isOpen_ = false;
};
}
