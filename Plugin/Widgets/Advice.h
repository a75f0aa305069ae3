// SPDX-License-Identifier: BSD-3-Clause
#ifndef Advice_h
#define Advice_h

#include <pqPropertyWidget.h>

class QLabel;

/// What a filter says to do next, as a text in several lines; no text where it is "None". It is the
/// widget of an information property that holds one text (panel_widget="Advice").
class Advice : public pqPropertyWidget
{
  Q_OBJECT
  using Superclass = pqPropertyWidget;

public:
  Advice(vtkSMProxy* filter, vtkSMProperty* text, QWidget* parent = nullptr);
  ~Advice() override;

private Q_SLOTS:
  void showText();

private:
  QLabel* Text;
};

#endif
