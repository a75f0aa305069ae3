// SPDX-License-Identifier: BSD-3-Clause
#ifndef Fold_h
#define Fold_h

#include <pqPropertyWidgetDecorator.h>

#include <QString>

class Folds;
class vtkSMProperty;

/// Puts a group of properties below a title that opens and closes. A group begins closed, unless a
/// value of it is not the default; the title says in gray what the group holds. On the group:
///
///     <PropertyWidgetDecorator type="Fold" title="Steps"/>
///
/// A property's own hint says how the title names its value: <Told text="step"/> is "1 step" or "5
/// steps" of a number or a list of names, and "Fixed region" with text="region" of a choice. "%1"
/// stands for the value itself: <Told text="minimum %1"/>. Without a hint the title has the entry
/// of a choice, the label of a flag, and label and value of a number. Of results, which have no
/// default, it has those with a hint.
///
/// A result without a value is no row. All that ParaView's search field finds is shown.
class Fold : public pqPropertyWidgetDecorator
{
  Q_OBJECT
  using Superclass = pqPropertyWidgetDecorator;

public:
  Fold(vtkPVXMLElement* hint, pqPropertyWidget* widget);
  ~Fold() override;

  bool canShowWidget(bool showAdvanced) const override;

  /// Whether the row would be shown if its group were open.
  bool isOffered(bool withAdvanced) const;
  bool isDefault() const;
  /// The value in words; empty where the title does not name it.
  QString told() const;

private:
  Folds* Panel;
  QString Title;

  vtkSMProperty* given() const;
  bool hasResult() const;
};

#endif
