// SPDX-License-Identifier: BSD-3-Clause
#ifndef StretchedColumns_h
#define StretchedColumns_h

#include <pqPropertyWidgetDecorator.h>

/// Fits all columns of a property's table into the panel: ParaView leaves the last ones behind a
/// scroll bar. A number that is cut off is the cell's tool tip. Tab in the last cell goes to the
/// first one; ParaView's would copy the last row, though only one row may be at a place. With a
/// label above:
///
///     <PropertyWidgetDecorator type="StretchedColumns"/>
///     <PropertyWidgetDecorator type="PanelLabel" text="Handles"/>
class StretchedColumns : public pqPropertyWidgetDecorator
{
  Q_OBJECT
  using Superclass = pqPropertyWidgetDecorator;

public:
  StretchedColumns(vtkPVXMLElement* hint, pqPropertyWidget* widget);
  ~StretchedColumns() override;

protected:
  bool eventFilter(QObject* object, QEvent* event) override;
};

#endif
