// SPDX-License-Identifier: BSD-3-Clause
#ifndef SaveCoordinates_h
#define SaveCoordinates_h

#include <QActionGroup>

class QAction;

/// File > Save Coordinates Into: writes a copy of a solver's own file with the coordinates of the
/// active data. It asks for the original and for the copy. Save Data cannot serve where ParaView
/// has a writer of its own for the extension, as for Exodus II and CGNS.
class SaveCoordinates : public QActionGroup
{
  Q_OBJECT

public:
  explicit SaveCoordinates(QObject* parent);

private:
  void save();
  void enable();

  QAction* const action_;
};

#endif
