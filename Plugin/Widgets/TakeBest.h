// SPDX-License-Identifier: BSD-3-Clause
#ifndef TakeBest_h
#define TakeBest_h

#include <pqPropertyWidgetDecorator.h>

class QEvent;
class QPushButton;
class pqPipelineSource;

/// Adds a button to the name of the best method that a comparison found: it gives that method to
/// the filter from which the compared boundary comes, as the output Surface of Morph Mesh, and
/// applies it. There is none where that filter has no property Method. In XML, on the result:
/// <PropertyWidgetDecorator type="TakeBest"/>.
class TakeBest : public pqPropertyWidgetDecorator
{
  Q_OBJECT
  using Superclass = pqPropertyWidgetDecorator;

public:
  TakeBest(vtkPVXMLElement* hint, pqPropertyWidget* widget);
  ~TakeBest() override;

  /// ParaView disables the widgets of results; this one has a button.
  bool eventFilter(QObject* object, QEvent* event) override;

private Q_SLOTS:
  void showButton();
  void take();

private:
  QPushButton* Button;

  /// That the boundary comes from, if it has a method; else null.
  pqPipelineSource* filter() const;
};

#endif
