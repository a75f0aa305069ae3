// SPDX-License-Identifier: BSD-3-Clause
#ifndef BoxDragDecorator_h
#define BoxDragDecorator_h

#include <pqPropertyWidgetDecorator.h>

#include <vtkEventQtSlotConnect.h>
#include <vtkNew.h>

#include <QSet>

class LiveDrag;
class QEvent;
class pqView;
class vtkWidgetRepresentation;

/// Looks after the box, sphere or plane in the view that belongs to a property of the panel, a
/// transform or a region. The filter follows while it is dragged (LiveDrag). Its outline has the
/// color of the attribute `color`, so that two boxes at one place can be told apart. In XML:
/// <PropertyWidgetDecorator type="BoxDrag" color="1 0.6 0"/>. With the attributes of BoxAboutCenter
/// the box of a transform turns and scales about the center of what moves.
class BoxDragDecorator : public pqPropertyWidgetDecorator
{
  Q_OBJECT
  using Superclass = pqPropertyWidgetDecorator;

public:
  BoxDragDecorator(vtkPVXMLElement* xml, pqPropertyWidget* parent);
  ~BoxDragDecorator() override;

  bool eventFilter(QObject* object, QEvent* event) override;

private Q_SLOTS:
  void watchView(pqView* view);
  /// While a selection is made in the view, its mouse is that of the selection.
  void yieldMouse();
  void follow();
  void end();

private:
  LiveDrag* Drag;
  vtkNew<vtkEventQtSlotConnect> Events;
  vtkNew<vtkEventQtSlotConnect> ModeEvents; ///< of the view's way of interaction
  QSet<QObject*> Known;                     ///< interactive widgets that are connected
  bool Asked = false;                       ///< for find(), from the event loop

  /// Finds interactive widgets that the panel has made since: another kind of region or transform
  /// has another one.
  void find();
  /// ParaView has no label for one of its transforms, and would show its name.
  void labelTransforms() const;
  /// A text says which drag does what, in place of ticks that forbid it.
  void shorten() const;
  void color(vtkWidgetRepresentation* shown) const;
};

#endif
