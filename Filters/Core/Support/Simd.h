// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace morph
{
/// Four numbers side by side, for the same operations on four things at once: whole vector
/// registers with AVX, two of them without. Every operation is that of the single numbers, so
/// results do not depend on the processor's registers.
using SimdDouble4 = double __attribute__((vector_size(32)));
using SimdFloat4 = float __attribute__((vector_size(16)));
constexpr std::ptrdiff_t SimdWidth = 4;
}
