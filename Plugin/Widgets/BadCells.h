// SPDX-License-Identifier: BSD-3-Clause
#ifndef BadCells_h
#define BadCells_h

#include <pqView.h>

#include <QPointer>
#include <QToolButton>

class vtkSMProxy;

/// A link with the number of bad cells, the second output of a filter. A press shows them in place
/// of the mesh, in the middle of the view; another one shows the mesh again.
class BadCells : public QToolButton
{
  Q_OBJECT

public:
  BadCells(vtkSMProxy* filter, QWidget* parent);
  ~BadCells() override;

  /// Hidden where there are none.
  void setCount(int count);
  void setView(pqView* view);

private:
  void toggle();
  bool areShown() const;
  void showText();

  vtkSMProxy* Filter;
  QPointer<pqView> View;
  int Count = 0;
};

#endif
