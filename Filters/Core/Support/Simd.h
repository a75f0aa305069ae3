// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace morph
{
/// Vectors of four numbers: one AVX register, or two SSE registers. Each operation acts on the four
/// numbers separately, so results do not depend on the processor.
using SimdDouble4 = double __attribute__((vector_size(32)));
using SimdFloat4 = float __attribute__((vector_size(16)));
constexpr std::ptrdiff_t SimdWidth = 4;
}
