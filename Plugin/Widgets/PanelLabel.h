// SPDX-License-Identifier: BSD-3-Clause
#ifndef PanelLabel_h
#define PanelLabel_h

#include <pqPropertyWidgetDecorator.h>

#include <QString>

/// Gives a property a label in the panel that is not its name: a hint
///
///     <PropertyWidgetDecorator type="PanelLabel" text="Target Angle (degrees)"/>
///
/// The label attribute of XML would do the same, but scripts would have to follow: Python calls a
/// property by that.
class PanelLabel : public pqPropertyWidgetDecorator
{
  Q_OBJECT
  typedef pqPropertyWidgetDecorator Superclass;

public:
  PanelLabel(vtkPVXMLElement* hint, pqPropertyWidget* widget);
  ~PanelLabel() override;

  bool eventFilter(QObject* object, QEvent* event) override;

private:
  QString Text;
};

#endif
