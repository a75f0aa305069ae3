// SPDX-License-Identifier: BSD-3-Clause
#include "Support/Monitor.h"

#include "Support/Error.h"

namespace morph
{
Monitor::~Monitor() = default;

void Monitor::progress(double)
{
}

bool Monitor::cancelled()
{
  return false;
}

void Monitor::warn(const std::string&)
{
}

void Monitor::parallelFor(
  Index n, Index grain, const std::function<void(Index first, Index last)>& body)
{
  if (n > 0)
  {
    this->threads() > 1 ? this->share(n, grain, body) : body(0, n);
  }
}

void Monitor::share(Index n, Index, const std::function<void(Index first, Index last)>& body)
{
  body(0, n);
}

void Monitor::check()
{
  if (this->cancelled())
  {
    throw Error(Error::Kind::Cancelled, "Cancelled; the mesh stays as it was.");
  }
}
}
