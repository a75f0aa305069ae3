// SPDX-License-Identifier: BSD-3-Clause
#ifndef OnlySurface_h
#define OnlySurface_h

#include <pqPropertyWidgetDecorator.h>

/// Chooses the surface of a new filter that fits to one, if just one is open besides its own input:
///
///     <PropertyWidgetDecorator type="OnlySurface"/>
class OnlySurface : public pqPropertyWidgetDecorator
{
  Q_OBJECT
  using Superclass = pqPropertyWidgetDecorator;

public:
  OnlySurface(vtkPVXMLElement* hint, pqPropertyWidget* widget);
  ~OnlySurface() override;

private:
  void choose();
};

#endif
