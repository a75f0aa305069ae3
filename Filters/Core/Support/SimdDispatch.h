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

/// Body::run(i, arguments...) for i in [first, last), compiled for the widest registers this
/// processor has. Body::run is a static function that is inlined always, and so is all it calls;
/// without fused multiplication and addition it does the same operations everywhere, so results are
/// the same to the last bit.
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
