// SPDX-License-Identifier: BSD-3-Clause
#ifndef KnownResult_h
#define KnownResult_h

#include <pqPropertyWidgetDecorator.h>

/// Hides the row of a result that the filter does not have: one that is at its default, which is no
/// possible value.
///
///     <PropertyWidgetDecorator type="KnownResult"/>
class KnownResult : public pqPropertyWidgetDecorator
{
  Q_OBJECT
  using Superclass = pqPropertyWidgetDecorator;

public:
  KnownResult(vtkPVXMLElement* hint, pqPropertyWidget* widget);
  ~KnownResult() override;

  bool canShowWidget(bool showAdvanced) const override;
};

#endif
