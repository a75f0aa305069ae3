// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

#include <cstdint>
#include <string>
#include <vector>

namespace morph::io
{
struct CgnsNode
{
  double id = 0;
  std::string name, label;
};

/// The tree of nodes of a CGNS file in HDF5 or ADF (CGIO, "CGNS Input/Output"). Each function
/// throws Error where the file is damaged.
class CgnsTree
{
public:
  enum class Access
  {
    Read,
    Write ///< of values in place
  };
  /// `name`: of the file, for messages.
  CgnsTree(const std::string& path, const std::string& name, Access access = Access::Read);
  ~CgnsTree();
  CgnsTree(const CgnsTree&) = delete;
  CgnsTree& operator=(const CgnsTree&) = delete;

  std::vector<CgnsNode> roots() const; ///< the nodes at the top
  std::vector<CgnsNode> children(const CgnsNode& node) const;
  /// Of the label; with `name`, of that name too. An id of -1: there is none.
  CgnsNode child(
    const CgnsNode& node, const std::string& label, const std::string& name = "") const;
  /// The node at "/Base/Zone/...".
  CgnsNode at(const std::string& path) const;

  bool isLink(const CgnsNode& node) const;
  bool isSinglePrecision(const CgnsNode& node) const;
  std::vector<double> numbers(const CgnsNode& node) const;
  std::vector<Index> integers(const CgnsNode& node) const;
  std::string text(const CgnsNode& node) const; ///< empty where it holds none

  /// Replaces the values of a node, as many as it has.
  void write(const CgnsNode& node, const std::vector<double>& values);
  /// Ends writing.
  void close();

private:
  std::string type(const CgnsNode& node) const;
  std::size_t count(const CgnsNode& node, std::size_t bytes) const;
  template <typename Value>
  std::vector<Value> read(const CgnsNode& node, const char* type) const;
  std::vector<CgnsNode> childrenOf(double id) const;
  void check(int status) const;

  std::string name_;
  std::uintmax_t mostBytes_ = 0;
  int file_ = -1;
  bool isOpen_ = false;
};
}
