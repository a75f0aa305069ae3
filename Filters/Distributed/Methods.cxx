// SPDX-License-Identifier: BSD-3-Clause
#include "Distributed/Methods.h"

#include "Distributed/InversionFree.h"
#include "Distributed/SiteMethod.h"
#include "Distributed/Smoothing.h"
#include "Distributed/SystemMethod.h"
#include "LinearMethods/FemWarp.h"
#include "LinearMethods/LogBarrierWarp.h"

#include <utility>

namespace morph::distributed
{
std::unique_ptr<Method> makeMethod(std::unique_ptr<Morpher> serial)
{
  if (const auto* warp = dynamic_cast<const morph::FemWarp*>(serial.get()))
  {
    auto method = std::make_unique<FemWarp>();
    method->setStiffness(warp->stiffness());
    method->takeEvaluateOptions(*serial);
    return method;
  }
  if (const auto* warp = dynamic_cast<const morph::LogBarrierWarp*>(serial.get()))
  {
    auto method = std::make_unique<LogBarrierWarp>(
      warp->outsideHull() == morph::LogBarrierWarp::OutsideHull::Relax);
    method->takeEvaluateOptions(*serial);
    return method;
  }
  if (serial->copyWithoutCells())
  {
    return std::make_unique<SiteMethod>(std::move(serial));
  }
  if (const auto* inversionFree = dynamic_cast<const morph::InversionFree*>(serial.get()))
  {
    return std::make_unique<InversionFree>(*inversionFree);
  }
  if (const auto* smoothing = dynamic_cast<const morph::Smoothing*>(serial.get()))
  {
    return std::make_unique<Smoothing>(*smoothing);
  }
  return nullptr;
}
}
