// SPDX-License-Identifier: BSD-3-Clause
#include "BadCells.h"

#include <pqUndoStack.h>
#include <vtkNew.h>
#include <vtkSMParaViewPipelineControllerWithRendering.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMRenderViewProxy.h>
#include <vtkSMRepresentationProxy.h>
#include <vtkSMSourceProxy.h>

#include <QFont>

namespace
{
enum Port
{
  Mesh,
  Bad,
  Surface,
  ControlPoints
};
}

BadCells::BadCells(vtkSMProxy* filter, QWidget* parent)
  : QToolButton(parent)
  , Filter(filter)
{
  this->setObjectName("BadCells");
  this->setAutoRaise(true);
  QFont link = this->font();
  link.setUnderline(true);
  this->setFont(link);
  this->setStyleSheet("color: " + this->palette().color(QPalette::Link).name());
  this->setCursor(Qt::PointingHandCursor);
  this->setToolTip(tr("Show the inverted and degenerate cells in place of the mesh, or the mesh "
                      "again"));
  QObject::connect(this, &QToolButton::clicked, this, &BadCells::toggle);
  this->hide();
}

BadCells::~BadCells() = default;

void BadCells::setCount(int count)
{
  this->Count = count;
  this->setVisible(count > 0);
  this->showText();
}

void BadCells::setView(pqView* view)
{
  this->View = view;
  this->showText();
}

bool BadCells::areShown() const
{
  auto* const view = this->View ? this->View->getViewProxy() : nullptr;
  auto* const source = vtkSMSourceProxy::SafeDownCast(this->Filter);
  const auto isShown = [&](int port)
  {
    vtkSMRepresentationProxy* const shown = view ? view->FindRepresentation(source, port) : nullptr;
    return shown && vtkSMPropertyHelper(shown, "Visibility").GetAsInt() != 0;
  };
  return isShown(Bad) && !isShown(Mesh) && !isShown(Surface) && !isShown(ControlPoints);
}

void BadCells::showText()
{
  this->setText(this->areShown()
                  ? tr("Show the mesh")
                  : tr(this->Count == 1 ? "%1 bad cell" : "%1 bad cells").arg(this->Count));
}

void BadCells::toggle()
{
  auto* const view =
    vtkSMRenderViewProxy::SafeDownCast(this->View ? this->View->getViewProxy() : nullptr);
  auto* const source = vtkSMSourceProxy::SafeDownCast(this->Filter);
  if (!view || !source)
  {
    return; // a chart has no place for cells
  }
  BEGIN_UNDO_SET(this->text());
  const bool back = this->areShown();
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  vtkSMProxy* const shown = controller->Show(source, back ? Mesh : Bad, view);
  for (const Port port : { back ? Bad : Mesh, Surface })
  {
    if (view->FindRepresentation(source, port))
    {
      controller->Hide(source, port, view);
    }
  }
  const bool hadPoints = view->FindRepresentation(source, ControlPoints) != nullptr;
  if (hadPoints && back)
  {
    controller->Show(source, ControlPoints, view);
  }
  else if (hadPoints)
  {
    controller->Hide(source, ControlPoints, view);
  }
  view->Update();
  back ? view->ResetCamera() : view->ZoomTo(shown);
  END_UNDO_SET();
  this->View->render();
  this->showText();
}
