// SPDX-License-Identifier: BSD-3-Clause
#include "Support/Error.h"

#include <algorithm>

namespace morph
{
SingularRows::SingularRows(const std::vector<std::int64_t>& rows)
  : Error(Kind::Singular, "The matrix has no positive diagonal in rows " + listIds(rows) + ".")
  , rows_(rows)
{
}

void requireRows(const char* what, std::int64_t rows, std::int64_t expected)
{
  if (rows != expected)
  {
    throw Error(std::string(what) + " has " + std::to_string(rows) + " rows where " +
                std::to_string(expected) + " are expected.");
  }
}

std::string listIds(const std::vector<std::int64_t>& ids, std::size_t most)
{
  std::string text;
  for (std::size_t i = 0; i < std::min(most, ids.size()); ++i)
  {
    text += (i ? ", " : "") + std::to_string(ids[i]);
  }
  if (ids.size() > most)
  {
    text += ", ... (" + std::to_string(ids.size()) + " in all)";
  }
  return text;
}
}
