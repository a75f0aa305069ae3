// SPDX-License-Identifier: BSD-3-Clause
#ifndef WholeNumber_h
#define WholeNumber_h

#include <pqPropertyWidget.h>

class QLineEdit;

/// A result that is a whole number, which cannot be edited: the widget of an information property
/// of ids (panel_widget="WholeNumber"). ParaView 5.11 has none for ids.
class WholeNumber : public pqPropertyWidget
{
  Q_OBJECT
  using Superclass = pqPropertyWidget;

public:
  WholeNumber(vtkSMProxy* filter, vtkSMProperty* number, QWidget* parent = nullptr);
  ~WholeNumber() override;

private Q_SLOTS:
  void showNumber();

private:
  QLineEdit* Number;
};

#endif
