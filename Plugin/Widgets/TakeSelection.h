// SPDX-License-Identifier: BSD-3-Clause
#ifndef TakeSelection_h
#define TakeSelection_h

#include <pqPropertyWidgetDecorator.h>

/// Gives a new filter the selection that its input has in the view, as if *Copy Active Selection*
/// were pressed, and the filter's property Moving the entry `moving`. For an input property that
/// takes a selection:
///
///     <PropertyWidgetDecorator type="TakeSelection" moving="Selection"/>
class TakeSelection : public pqPropertyWidgetDecorator
{
  Q_OBJECT
  using Superclass = pqPropertyWidgetDecorator;

public:
  TakeSelection(vtkPVXMLElement* hint, pqPropertyWidget* widget);
  ~TakeSelection() override;

private:
  void take();
};

#endif
