// SPDX-License-Identifier: BSD-3-Clause
#ifndef NarrowPanel_h
#define NarrowPanel_h

#include <pqPropertyWidgetDecorator.h>

/// Lets a filter's panel be as narrow as ParaView's dock. By default a list of choices is as wide
/// as its longest entry, and all of the panel then needs a scroll bar. On one property of a filter:
///
///     <PropertyWidgetDecorator type="NarrowPanel"/>
class NarrowPanel : public pqPropertyWidgetDecorator
{
  Q_OBJECT
  using Superclass = pqPropertyWidgetDecorator;

public:
  NarrowPanel(vtkPVXMLElement* hint, pqPropertyWidget* widget);
  ~NarrowPanel() override;

  bool eventFilter(QObject* object, QEvent* event) override;

private:
  bool Asked = false; ///< for narrow(), from the event loop

  /// Finds the lists; the panel makes some of them later.
  void narrow();
};

#endif
