// SPDX-License-Identifier: BSD-3-Clause
#ifndef Beside_h
#define Beside_h

#include <pqPropertyWidgetDecorator.h>

/// Puts a property without a label, as a tick, into the row of another one, on its right:
///
///     <PropertyWidgetDecorator type="Beside" property="Displacement"/>
class Beside : public pqPropertyWidgetDecorator
{
  Q_OBJECT
  using Superclass = pqPropertyWidgetDecorator;

public:
  Beside(vtkPVXMLElement* hint, pqPropertyWidget* widget);
  ~Beside() override;
};

#endif
