// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceMenu.h"

#include "SurfaceTable.h"

#include <pqApplicationCore.h>
#include <pqInterfaceTracker.h>

void SurfaceMenu::startup()
{
  pqApplicationCore::instance()->interfaceTracker()->addInterface(this);
}

void SurfaceMenu::shutdown()
{
  if (pqApplicationCore* const core = pqApplicationCore::instance())
  {
    core->interfaceTracker()->removeInterface(this);
  }
}

bool SurfaceMenu::contextMenu(
  QMenu* menu, pqView* view, const QPoint& place, pqRepresentation*, const QStringList&) const
{
  SurfaceTable::OfferRoles(menu, view, place);
  return false; // ParaView's own entries follow
}
