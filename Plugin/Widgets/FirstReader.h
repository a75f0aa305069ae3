// SPDX-License-Identifier: BSD-3-Clause
#ifndef FirstReader_h
#define FirstReader_h

#include <QObject>

/// Takes Solver File Reader where ParaView asks for a reader: it is in the list only if the file's
/// content is that of a solver. ParaView would select the first by the alphabet. For a file of
/// Abaqus that is AVS UCD, which shows an empty mesh.
class FirstReader : public QObject
{
  Q_OBJECT

public:
  FirstReader() = default;
  ~FirstReader() override = default;

  void startup();
  void shutdown() {}
  bool eventFilter(QObject* watched, QEvent* event) override;
};

#endif
