// SPDX-License-Identifier: BSD-3-Clause
#ifndef FirstColumns_h
#define FirstColumns_h

#include <QObject>
#include <QSet>
#include <QStringList>

class pqRepresentation;
class QHeaderView;

/// Puts columns of a table first where a spreadsheet shows it: ParaView orders them by the
/// alphabet. A filter asks for it by a hint, in the order that is wanted:
///
///     <FirstColumns port="2" names="Rank Method"/>
class FirstColumns : public QObject
{
  Q_OBJECT

public:
  FirstColumns() = default;
  ~FirstColumns() override = default;

  void startup();
  void shutdown() {}

private Q_SLOTS:
  void added(pqRepresentation* representation);
  void dataUpdated();

private:
  QSet<QObject*> Known; ///< tables that are looked after

  static void order(QHeaderView* header, const QStringList& names);
};

#endif
