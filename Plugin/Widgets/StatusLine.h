// SPDX-License-Identifier: BSD-3-Clause
#ifndef StatusLine_h
#define StatusLine_h

#include <pqPropertyWidget.h>

class QLabel;

/// How the last execution ended, on a ground of its color: green where the mesh is valid, orange
/// where it has made a part of the motion, red where it is not valid or there is none. Below it the
/// inverted cells before and after, and the seconds. Before anything moves it has the advice what
/// to do instead.
///
/// It is the widget of the property with the advice (panel_widget="StatusLine"). The filter's
/// results of vtkMorphAlgorithm have their usual names.
class StatusLine : public pqPropertyWidget
{
  Q_OBJECT
  using Superclass = pqPropertyWidget;

public:
  StatusLine(vtkSMProxy* filter, vtkSMProperty* advice, QWidget* parent = nullptr);
  ~StatusLine() override;

private Q_SLOTS:
  void showLater();

private:
  double number(const char* result) const;
  QString text(const char* result) const;
  void showStatus();

  QLabel* Status;
  QLabel* Details;
  QLabel* Text;
  bool IsDue = false; ///< showStatus()
};

#endif
