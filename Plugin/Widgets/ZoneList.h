// SPDX-License-Identifier: BSD-3-Clause
#ifndef ZoneList_h
#define ZoneList_h

#include <pqPropertyWidget.h>

#include <QString>

class pqArraySelectionWidget;

/// A list of zones to tick, with the size of each in two columns beside its name. It is the widget
/// of a list with a KeptArraySelectionDomain (panel_widget="ZoneList"), whose hint names the
/// property that has the sizes, three texts for each name, and the columns:
///
///     <ZoneList sizes="ZoneSizes" columns="Cells Nodes"/>
class ZoneList : public pqPropertyWidget
{
  Q_OBJECT
  using Superclass = pqPropertyWidget;

public:
  ZoneList(vtkSMProxy* filter, vtkSMProperty* list, QWidget* parent = nullptr);
  ~ZoneList() override;

protected:
  /// Shows a row's name and sizes, which may be cut off, as its tool tip.
  bool eventFilter(QObject* object, QEvent* event) override;

private Q_SLOTS:
  void showSizes();

private:
  pqArraySelectionWidget* List;
  vtkSMProperty* Sizes;
  QString Name; ///< of the list
};

#endif
