// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/Method.h"

#include "Morpher/Morpher.h"

#include <memory>

namespace morph::distributed
{
/// The distributed form of a serial method, with its options: FEMWARP, LBWARP, weighted residual,
/// simplex-linear, simplex natural neighbor, radial basis or inversion-free. Null for the others,
/// which need one rank.
std::unique_ptr<Method> makeMethod(std::unique_ptr<Morpher> serial);
}
