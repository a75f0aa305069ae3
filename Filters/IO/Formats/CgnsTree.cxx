// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/CgnsTree.h"

#include "Support/Error.h"

#include <cgns_io.h>
#include <cgnslib.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>

namespace morph::io
{
namespace
{
// Up to CGNS 3.4 the functions that name a type of data take HDF5 alone.
#if CGNS_VERSION <= 3400
int readAll(int file, double id, const char*, void* data)
{
  return cgio_read_all_data(file, id, data);
}
int writeAll(int file, double id, const char*, const void* data)
{
  return cgio_write_all_data(file, id, data);
}
#else
int readAll(int file, double id, const char* type, void* data)
{
  return cgio_read_all_data_type(file, id, type, data);
}
int writeAll(int file, double id, const char* type, const void* data)
{
  return cgio_write_all_data_type(file, id, type, data);
}
#endif
}

CgnsTree::CgnsTree(const std::string& path, const std::string& name, Access access)
  : name_(name)
{
  std::error_code error;
  // A damaged file may ask for any memory; none that is packed holds a thousand times its size.
  this->mostBytes_ = 1100 * (std::filesystem::file_size(path, error) + 1000);
  this->check(cgio_open_file(path.c_str(),
    access == Access::Read ? CGIO_MODE_READ : CGIO_MODE_MODIFY, CGIO_FILE_NONE, &this->file_));
  this->isOpen_ = true;
}

CgnsTree::~CgnsTree()
{
  if (this->isOpen_)
  {
    cgio_close_file(this->file_);
  }
}

void CgnsTree::check(int status) const
{
  if (status != 0)
  {
    std::array<char, CGIO_MAX_ERROR_LENGTH + 1> message = {};
    cgio_error_message(message.data());
    throw Error("Cannot read or write " + this->name_ + ": " + message.data() + " (CGNS).");
  }
}

std::vector<CgnsNode> CgnsTree::childrenOf(double id) const
{
  int count = 0, found = 0;
  this->check(cgio_number_children(this->file_, id, &count));
  if (count < 0 || static_cast<std::uintmax_t>(count) > this->mostBytes_)
  {
    throw Error("Cannot read " + this->name_ + ": a number of nodes is out of range.");
  }
  std::vector<double> ids(static_cast<std::size_t>(count));
  if (count > 0)
  {
    this->check(cgio_children_ids(this->file_, id, 1, count, &found, ids.data()));
    ids.resize(static_cast<std::size_t>(std::clamp(found, 0, count)));
  }
  std::vector<CgnsNode> result;
  for (const double one : ids)
  {
    std::array<char, CGIO_MAX_NAME_LENGTH + 1> name = {};
    std::array<char, CGIO_MAX_LABEL_LENGTH + 1> label = {};
    this->check(cgio_get_name(this->file_, one, name.data()));
    this->check(cgio_get_label(this->file_, one, label.data()));
    result.push_back({ one, name.data(), label.data() });
  }
  return result;
}

std::vector<CgnsNode> CgnsTree::roots() const
{
  double root = 0;
  this->check(cgio_get_root_id(this->file_, &root));
  return this->childrenOf(root);
}

std::vector<CgnsNode> CgnsTree::children(const CgnsNode& node) const
{
  return this->childrenOf(node.id);
}

CgnsNode CgnsTree::child(
  const CgnsNode& node, const std::string& label, const std::string& name) const
{
  for (const CgnsNode& one : this->children(node))
  {
    if (one.label == label && (name.empty() || one.name == name))
    {
      return one;
    }
  }
  return { -1, "", "" };
}

CgnsNode CgnsTree::at(const std::string& path) const
{
  double root = 0;
  CgnsNode node;
  this->check(cgio_get_root_id(this->file_, &root));
  this->check(cgio_get_node_id(this->file_, root, path.c_str(), &node.id));
  return node;
}

bool CgnsTree::isLink(const CgnsNode& node) const
{
  int length = 0;
  this->check(cgio_is_link(this->file_, node.id, &length));
  return length > 0;
}

std::string CgnsTree::type(const CgnsNode& node) const
{
  std::array<char, CGIO_MAX_DATATYPE_LENGTH + 1> type = {};
  this->check(cgio_get_data_type(this->file_, node.id, type.data()));
  return type.data();
}

bool CgnsTree::isSinglePrecision(const CgnsNode& node) const
{
  return this->type(node) == "R4";
}

std::size_t CgnsTree::count(const CgnsNode& node, std::size_t bytes) const
{
  int dimensions = 0;
  std::array<cgsize_t, CGIO_MAX_DIMENSIONS> lengths = {};
  this->check(cgio_get_dimensions(this->file_, node.id, &dimensions, lengths.data()));
  std::uintmax_t count = dimensions > 0 ? 1 : 0;
  for (int i = 0; i < std::min(dimensions, CGIO_MAX_DIMENSIONS); ++i)
  {
    const cgsize_t length = lengths[static_cast<std::size_t>(i)];
    if (length < 0 ||
        (length > 0 && count > this->mostBytes_ / bytes / static_cast<std::uintmax_t>(length)))
    {
      throw Error(
        "Cannot read " + this->name_ + ": the size of its node " + node.name + " is out of range.");
    }
    count *= static_cast<std::uintmax_t>(length);
  }
  return static_cast<std::size_t>(count);
}

template <typename Value>
std::vector<Value> CgnsTree::read(const CgnsNode& node, const char* type) const
{
  std::vector<Value> values(this->count(node, sizeof(Value)));
  if (!values.empty())
  {
    this->check(readAll(this->file_, node.id, type, values.data()));
  }
  return values;
}

std::vector<double> CgnsTree::numbers(const CgnsNode& node) const
{
  const std::string type = this->type(node);
  if (type == "R8")
  {
    return this->read<double>(node, "R8");
  }
  if (type != "R4")
  {
    throw Error("Cannot read " + this->name_ + ": its node " + node.name + " holds no numbers.");
  }
  const auto values = this->read<float>(node, "R4");
  return { values.begin(), values.end() };
}

std::vector<Index> CgnsTree::integers(const CgnsNode& node) const
{
  const std::string type = this->type(node);
  if (type == "I8")
  {
    return this->read<Index>(node, "I8");
  }
  if (type != "I4")
  {
    throw Error(
      "Cannot read " + this->name_ + ": its node " + node.name + " holds no whole numbers.");
  }
  const auto values = this->read<std::int32_t>(node, "I4");
  return { values.begin(), values.end() };
}

std::string CgnsTree::text(const CgnsNode& node) const
{
  if (node.id < 0 || this->type(node) != "C1")
  {
    return "";
  }
  const auto values = this->read<char>(node, "C1");
  std::string result(values.begin(), values.end());
  result.resize(std::min(result.find('\0'), result.size()));
  result.resize(result.find_last_not_of(' ') + 1);
  return result;
}

void CgnsTree::write(const CgnsNode& node, const std::vector<double>& values)
{
  if (this->count(node, 4) != values.size())
  {
    throw Error("Cannot write " + this->name_ + ": its node does not have " +
                std::to_string(values.size()) + " values.");
  }
  if (this->isSinglePrecision(node))
  {
    const std::vector<float> single(values.begin(), values.end());
    this->check(writeAll(this->file_, node.id, "R4", single.data()));
    return;
  }
  this->check(writeAll(this->file_, node.id, "R8", values.data()));
}

void CgnsTree::close()
{
  this->isOpen_ = false;
  this->check(cgio_close_file(this->file_));
}
}
