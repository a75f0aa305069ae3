// SPDX-License-Identifier: BSD-3-Clause
#ifndef CopiedSelection_h
#define CopiedSelection_h

#include <pqPropertyWidgetDecorator.h>

/// Hides the box with the copied selection while nothing is copied: ParaView shows it empty. For an
/// input property that takes a selection:
///
///     <PropertyWidgetDecorator type="CopiedSelection"/>
class CopiedSelection : public pqPropertyWidgetDecorator
{
  Q_OBJECT
  using Superclass = pqPropertyWidgetDecorator;

public:
  CopiedSelection(vtkPVXMLElement* hint, pqPropertyWidget* widget);
  ~CopiedSelection() override;
};

#endif
