// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace morph
{
/// Vectors of four numbers: one AVX register, or two SSE registers. Each operation acts on the four
/// numbers separately, so results do not depend on the processor.
using SimdDouble4 = double __attribute__((vector_size(32)));
using SimdInteger4 = std::int64_t __attribute__((vector_size(32)));
using SimdFloat4 = float __attribute__((vector_size(16)));
constexpr std::ptrdiff_t SimdWidth = 4;
}
