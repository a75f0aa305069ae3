// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

namespace morph
{
namespace detail
{
#if defined(__x86_64__)
template <typename Body, typename... Arguments>
__attribute__((target("avx2"))) void runWithAvx2(Arguments&... arguments)
{
  Body::run(arguments...);
}
#endif

/// Runs Body for each i.
template <typename Body>
struct Loop
{
  template <typename... Arguments>
  static inline __attribute__((always_inline)) void run(
    Index first, Index last, Arguments&... arguments)
  {
    for (Index i = first; i < last; ++i)
    {
      Body::run(i, arguments...);
    }
  }
};
}

/// Calls Body::run(arguments...), compiled for this processor's widest registers. Body::run is a
/// static function; it and all that it calls must be always inlined. Without fused multiply-add
/// every version does the same operations, so results agree bit for bit.
template <typename Body, typename... Arguments>
void dispatched(Arguments&... arguments)
{
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2"))
  {
    detail::runWithAvx2<Body>(arguments...);
    return;
  }
#endif
  Body::run(arguments...);
}

/// Calls Body::run(i, arguments...) for i in [first, last), as dispatched().
template <typename Body, typename... Arguments>
void dispatchedFor(Index first, Index last, Arguments&... arguments)
{
  dispatched<detail::Loop<Body>>(first, last, arguments...);
}
}
