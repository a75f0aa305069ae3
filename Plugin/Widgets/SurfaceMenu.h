// SPDX-License-Identifier: BSD-3-Clause
#ifndef SurfaceMenu_h
#define SurfaceMenu_h

#include <pqContextMenuInterface.h>

#include <QObject>

/// Adds the roles of the surface under the mouse to the menu that a press of the right button opens
/// in a view, while the panel shows the table of surfaces of a filter (SurfaceTable.h).
class SurfaceMenu
  : public QObject
  , public pqContextMenuInterface
{
  Q_OBJECT
  Q_INTERFACES(pqContextMenuInterface)

public:
  SurfaceMenu() = default;
  ~SurfaceMenu() override = default;

  void startup();
  void shutdown();

  using pqContextMenuInterface::contextMenu;
  bool contextMenu(QMenu* menu, pqView* view, const QPoint& place, pqRepresentation* shown,
    const QStringList& blocks) const override;
  /// Before ParaView's own entries.
  int priority() const override { return 1; }
};

#endif
