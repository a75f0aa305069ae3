// SPDX-License-Identifier: BSD-3-Clause
#ifndef FirstColumns_h
#define FirstColumns_h

#include "HintedResults.h"

#include <QSet>
#include <QStringList>

class QHeaderView;

/// Puts columns of a table first where a spreadsheet shows it: ParaView orders them by the
/// alphabet. A filter asks for it by a hint, in the order that is wanted:
///
///     <FirstColumns port="2" names="Rank Method"/>
class FirstColumns : public HintedResults
{
  Q_OBJECT

public:
  FirstColumns()
    : HintedResults("FirstColumns")
  {
  }
  ~FirstColumns() override = default;

protected:
  void updated(pqDataRepresentation* shown, vtkPVXMLElement* hint) override;

private:
  QSet<QObject*> Known; ///< tables that are looked after

  static void order(QHeaderView* header, const QStringList& names);
};

#endif
