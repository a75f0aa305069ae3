// SPDX-License-Identifier: BSD-3-Clause
#ifndef SeriesColors_h
#define SeriesColors_h

#include <QObject>
#include <QSet>

class pqRepresentation;

/// Gives each line of a chart a color of its own where it is first shown: ParaView has seven, and
/// begins again. A filter asks for it by a hint:
///
///     <SeriesColors port="1"/>
class SeriesColors : public QObject
{
  Q_OBJECT

public:
  SeriesColors() = default;
  ~SeriesColors() override = default;

  void startup();
  void shutdown() {}

private Q_SLOTS:
  void added(pqRepresentation* representation);
  void dataUpdated();

private:
  QSet<QObject*> Known; ///< charts that have their colors
};

#endif
