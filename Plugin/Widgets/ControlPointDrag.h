// SPDX-License-Identifier: BSD-3-Clause
#ifndef ControlPointDrag_h
#define ControlPointDrag_h

#include <pqPropertyWidgetDecorator.h>

#include <vtkEventQtSlotConnect.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <QPointer>

#include <array>
#include <vector>

class LiveDrag;
class QEvent;
class pqView;
class vtkHandleWidget;
class vtkObject;

/// Shows the points of a list of displacements as spheres in the view, where they are taken, and
/// lets the mouse drag them: the list then has the displacement. With LiveDrag the mesh follows. On
/// a list of handles, seven numbers each with the place first:
///
///     <PropertyWidgetDecorator type="ControlPointDrag"/>
///
/// On one of a lattice, i, j, k and the displacement; `points` names the property with all
/// undeformed control points, which the filter has after an execution, and `size` their numbers:
///
///     <PropertyWidgetDecorator type="ControlPointDrag" points="LatticePoints" size="LatticeSize"/>
///
/// Of more than 1000 points none is shown.
class ControlPointDrag : public pqPropertyWidgetDecorator
{
  Q_OBJECT
  using Superclass = pqPropertyWidgetDecorator;

public:
  ControlPointDrag(vtkPVXMLElement* hint, pqPropertyWidget* widget);
  ~ControlPointDrag() override;

  bool eventFilter(QObject* object, QEvent* event) override;

private Q_SLOTS:
  void showLater();
  /// Of several points at one place of the screen, lets the mouse have the nearest.
  void pick();
  void begin(vtkObject* widget);
  void follow(vtkObject* widget);
  void end();

private:
  using Triple = std::array<double, 3>;
  struct Point
  {
    Triple Rest, Displacement;
  };

  LiveDrag* Drag;
  vtkNew<vtkEventQtSlotConnect> Events;
  std::vector<vtkSmartPointer<vtkHandleWidget>> Widgets;
  QPointer<pqView> View; ///< that shows them, or null
  bool IsDue = false;    ///< showPoints()
  bool IsDragged = false;

  bool isLattice() const;
  std::array<int, 3> size() const;
  std::vector<Point> points() const;
  void showPoints();
  void hidePoints();
  /// Writes a displacement into the list in the panel.
  void write(int point, const Triple& displacement);
};

#endif
