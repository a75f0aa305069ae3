// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Support/Types.h"

namespace morph
{
namespace detail
{
template <typename Body, typename... Arguments>
void loopPortably(Index first, Index last, Arguments&... arguments)
{
  for (Index i = first; i < last; ++i)
  {
    Body::run(i, arguments...);
  }
}

#if defined(__x86_64__)
template <typename Body, typename... Arguments>
__attribute__((target("avx2"))) void loopWithAvx2(Index first, Index last, Arguments&... arguments)
{
  for (Index i = first; i < last; ++i)
  {
    Body::run(i, arguments...);
  }
}
#endif
}

/// Calls Body::run(i, arguments...) for i in [first, last), compiled for this processor's widest
/// registers. Body::run is a static function; it and all that it calls must be always inlined.
/// Without fused multiply-add every version does the same operations, so results agree bit for bit.
template <typename Body, typename... Arguments>
void dispatchedFor(Index first, Index last, Arguments&... arguments)
{
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2"))
  {
    detail::loopWithAvx2<Body>(first, last, arguments...);
    return;
  }
#endif
  detail::loopPortably<Body>(first, last, arguments...);
}
}
