// SPDX-License-Identifier: BSD-3-Clause
#include "Formats/NetCdf.h"

#include "Files/ReadFile.h"
#include "Support/Error.h"

#include <netcdf.h>
#include <netcdf_mem.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>

namespace morph::io
{
namespace
{
/// Whether the last value of each variable of a classic file can be read.
bool isWhole(int file)
{
  int variables = 0;
  bool isRead = nc_inq_nvars(file, &variables) == NC_NOERR;
  for (int id = 0; id < variables && isRead; ++id)
  {
    int dimensions = 0;
    isRead = nc_inq_varndims(file, id, &dimensions) == NC_NOERR;
    std::vector<int> dimension(static_cast<std::size_t>(dimensions) + 1);
    isRead = isRead && nc_inq_vardimid(file, id, dimension.data()) == NC_NOERR;
    std::vector<std::size_t> last(dimension.size());
    bool isEmpty = false;
    for (std::size_t i = 0; i + 1 < last.size() && isRead; ++i)
    {
      isRead = nc_inq_dimlen(file, dimension[i], &last[i]) == NC_NOERR;
      isEmpty = isEmpty || last[i] == 0;
      --last[i];
    }
    std::array<char, sizeof(double)> value; // of the longest type
    isRead = isRead && (isEmpty || nc_get_var1(file, id, last.data(), value.data()) == NC_NOERR);
  }
  return isRead;
}
}

NetCdf::NetCdf(const std::string& path, const std::string& name, Access access)
  : name_(name)
{
  std::error_code error;
  // A damaged file may ask for any memory; none that is packed holds a thousand times its size.
  this->longest_ = 1100 * (std::filesystem::file_size(path, error) + 1000);
  if (access == Access::Write || readHead(path, 3) != "CDF")
  {
    const int mode = access == Access::Write ? NC_WRITE : NC_NOWRITE;
    this->check(nc_open(path.c_str(), mode, &this->file_), "it");
    this->isOpen_ = true;
    return;
  }
  // Behind the end of a classic file netCDF reads zeros. Behind that of its content it fails.
  this->content_ = readFile(path);
  this->isOpen_ = nc_open_mem(path.c_str(), NC_NOWRITE, this->content_.size(),
                    this->content_.data(), &this->file_) == NC_NOERR;
  if (!this->isOpen_ || !isWhole(this->file_))
  {
    if (this->isOpen_)
    {
      nc_close(this->file_);
    }
    throw Error("Cannot read " + this->name_ + ": it is damaged, or ends too soon.");
  }
}

NetCdf::~NetCdf()
{
  if (this->isOpen_)
  {
    nc_close(this->file_);
  }
}

void NetCdf::check(int status, const std::string& what) const
{
  if (status != NC_NOERR)
  {
    throw Error("Cannot read or write " + this->name_ + ": " + what + ": " + nc_strerror(status) +
                " (netCDF).");
  }
}

Index NetCdf::dimension(const std::string& name) const
{
  int id = 0;
  std::size_t length = 0;
  if (nc_inq_dimid(this->file_, name.c_str(), &id) != NC_NOERR)
  {
    return 0;
  }
  this->check(nc_inq_dimlen(this->file_, id, &length), name);
  if (length > this->longest_)
  {
    throw Error("Cannot read " + this->name_ + ": its dimension " + name + " is out of range.");
  }
  return static_cast<Index>(length);
}

bool NetCdf::has(const std::string& variable) const
{
  int id = 0;
  return nc_inq_varid(this->file_, variable.c_str(), &id) == NC_NOERR;
}

bool NetCdf::isSinglePrecision(const std::string& variable) const
{
  int id = 0;
  nc_type type = NC_DOUBLE;
  this->check(nc_inq_varid(this->file_, variable.c_str(), &id), variable);
  this->check(nc_inq_vartype(this->file_, id, &type), variable);
  return type == NC_FLOAT;
}

int NetCdf::variable(const std::string& name, Index count) const
{
  int id = 0, dimensions = 0;
  this->check(nc_inq_varid(this->file_, name.c_str(), &id), name);
  this->check(nc_inq_varndims(this->file_, id, &dimensions), name);
  std::vector<int> dimension(static_cast<std::size_t>(dimensions) + 1);
  this->check(nc_inq_vardimid(this->file_, id, dimension.data()), name);
  std::size_t values = 1;
  bool fits = true;
  for (int i = 0; i < dimensions && fits; ++i)
  {
    std::size_t length = 0;
    this->check(nc_inq_dimlen(this->file_, dimension[static_cast<std::size_t>(i)], &length), name);
    fits = length == 0 || values <= static_cast<std::size_t>(count) / length;
    values *= length;
  }
  if (!fits || values != static_cast<std::size_t>(count))
  {
    throw Error("Cannot read " + this->name_ + ": its variable " + name + " does not have " +
                std::to_string(count) + " values.");
  }
  return id;
}

std::vector<double> NetCdf::numbers(const std::string& variable, Index count) const
{
  const int id = this->variable(variable, count);
  std::vector<double> result(static_cast<std::size_t>(count));
  this->check(nc_get_var_double(this->file_, id, result.data()), variable);
  return result;
}

std::vector<double> NetCdf::row(
  const std::string& variable, std::vector<std::size_t> place, Index count) const
{
  int id = 0, dimensions = 0;
  this->check(nc_inq_varid(this->file_, variable.c_str(), &id), variable);
  this->check(nc_inq_varndims(this->file_, id, &dimensions), variable);
  if (static_cast<std::size_t>(dimensions) != place.size() + 1)
  {
    throw Error("Cannot read " + this->name_ + ": its variable " + variable + " does not have " +
                std::to_string(place.size() + 1) + " dimensions.");
  }
  std::vector<std::size_t> counts(place.size(), 1);
  counts.push_back(static_cast<std::size_t>(count));
  place.push_back(0);
  std::vector<double> result(static_cast<std::size_t>(count));
  this->check(
    nc_get_vara_double(this->file_, id, place.data(), counts.data(), result.data()), variable);
  return result;
}

std::vector<Index> NetCdf::integers(const std::string& variable, Index count) const
{
  const int id = this->variable(variable, count);
  std::vector<long long> values(static_cast<std::size_t>(count));
  this->check(nc_get_var_longlong(this->file_, id, values.data()), variable);
  return { values.begin(), values.end() };
}

std::vector<std::string> NetCdf::texts(const std::string& variable, Index count) const
{
  std::vector<std::string> result;
  int id = 0, dimensions = 0;
  nc_type type = NC_CHAR;
  if (nc_inq_varid(this->file_, variable.c_str(), &id) != NC_NOERR)
  {
    return result;
  }
  this->check(nc_inq_varndims(this->file_, id, &dimensions), variable);
  this->check(nc_inq_vartype(this->file_, id, &type), variable);
  std::array<int, 2> dimension = { 0, 0 };
  std::array<std::size_t, 2> length = { 0, 0 };
  const bool isTable = dimensions == 2 && type == NC_CHAR;
  if (isTable)
  {
    this->check(nc_inq_vardimid(this->file_, id, dimension.data()), variable);
    this->check(nc_inq_dimlen(this->file_, dimension[0], &length[0]), variable);
    this->check(nc_inq_dimlen(this->file_, dimension[1], &length[1]), variable);
  }
  if (!isTable || length[0] != static_cast<std::size_t>(count) || length[1] > 65536)
  {
    throw Error("Cannot read " + this->name_ + ": its variable " + variable + " is no list of " +
                std::to_string(count) + " names.");
  }
  std::vector<char> text(length[0] * length[1] + 1);
  this->check(nc_get_var_text(this->file_, id, text.data()), variable);
  for (std::size_t i = 0; i < length[0]; ++i)
  {
    std::string one(text.data() + i * length[1], length[1]);
    one.resize(std::min(one.find('\0'), one.size()));
    one.resize(one.find_last_not_of(' ') + 1);
    result.push_back(one);
  }
  return result;
}

std::string NetCdf::attribute(const std::string& variable, const std::string& name) const
{
  int id = 0;
  std::size_t length = 0;
  nc_type type = NC_CHAR;
  if (nc_inq_varid(this->file_, variable.c_str(), &id) != NC_NOERR ||
      nc_inq_att(this->file_, id, name.c_str(), &type, &length) != NC_NOERR || type != NC_CHAR ||
      length > 65536)
  {
    return "";
  }
  std::string text(length, '\0');
  this->check(nc_get_att_text(this->file_, id, name.c_str(), text.data()), variable);
  text.resize(std::min(text.find('\0'), text.size()));
  return text;
}

void NetCdf::write(const std::string& variable, const std::vector<double>& values)
{
  const int id = this->variable(variable, static_cast<Index>(values.size()));
  this->check(nc_put_var_double(this->file_, id, values.data()), variable);
}

void NetCdf::close()
{
  this->isOpen_ = false;
  this->check(nc_close(this->file_), "it");
}
}
