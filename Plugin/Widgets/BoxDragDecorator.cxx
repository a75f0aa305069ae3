// SPDX-License-Identifier: BSD-3-Clause
#include "BoxDragDecorator.h"

#include "BoxAboutCenter.h"
#include "LiveDrag.h"

#include <pqInteractivePropertyWidget.h>
#include <pqPropertyWidget.h>
#include <pqView.h>
#include <vtkAbstractWidget.h>
#include <vtkBoxRepresentation.h>
#include <vtkCommand.h>
#include <vtkPVRenderView.h>
#include <vtkPVXMLElement.h>
#include <vtkProperty.h>
#include <vtkSMDoubleVectorProperty.h>
#include <vtkSMNewWidgetRepresentationProxy.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMPropertyIterator.h>
#include <vtkSMProxy.h>
#include <vtkSmartPointer.h>

#include <QCheckBox>
#include <QComboBox>
#include <QEvent>
#include <QLabel>
#include <QTimer>

#include <string>
#include <vector>

namespace
{
/// The properties that a widget in the view may change.
std::vector<std::string> numbersOf(vtkSMProxy* proxy)
{
  std::vector<std::string> names;
  const auto properties = vtk::TakeSmartPointer(proxy->NewPropertyIterator());
  for (properties->Begin(); !properties->IsAtEnd(); properties->Next())
  {
    auto* const property = vtkSMDoubleVectorProperty::SafeDownCast(properties->GetProperty());
    if (property && !property->GetInformationOnly())
    {
      names.emplace_back(properties->GetKey());
    }
  }
  return names;
}
}

BoxDragDecorator::BoxDragDecorator(vtkPVXMLElement* xml, pqPropertyWidget* parent)
  : Superclass(xml, parent)
  , Drag(new LiveDrag(parent))
{
  parent->installEventFilter(this);
  QObject::connect(parent, &pqPropertyWidget::viewChanged, this, &BoxDragDecorator::watchView);
}

BoxDragDecorator::~BoxDragDecorator() = default;

bool BoxDragDecorator::eventFilter(QObject* object, QEvent* event)
{
  const QEvent::Type type = event->type();
  if (!this->Asked && (type == QEvent::LayoutRequest || type == QEvent::Show))
  {
    this->Asked = true;
    QTimer::singleShot(0, this, [this] { this->find(); });
  }
  return this->Superclass::eventFilter(object, event);
}

void BoxDragDecorator::watchView(pqView* view)
{
  this->ModeEvents->Disconnect();
  vtkSMProperty* const mode = view ? view->getProxy()->GetProperty("InteractionMode") : nullptr;
  if (mode)
  {
    this->ModeEvents->Connect(mode, vtkCommand::ModifiedEvent, this, SLOT(yieldMouse()));
  }
}

void BoxDragDecorator::yieldMouse()
{
  const pqView* const view = this->parentWidget()->view();
  const int mode = vtkSMPropertyHelper(view->getProxy(), "InteractionMode").GetAsInt();
  const bool isTurned =
    mode == vtkPVRenderView::INTERACTION_MODE_3D || mode == vtkPVRenderView::INTERACTION_MODE_2D;
  for (auto* widget : this->parentWidget()->findChildren<pqInteractivePropertyWidget*>())
  {
    if (widget->isSelected() && widget->isWidgetVisible())
    {
      vtkSMPropertyHelper(widget->widgetProxy(), "Enabled").Set(isTurned ? 1 : 0);
      widget->widgetProxy()->UpdateVTKObjects();
    }
  }
}

void BoxDragDecorator::find()
{
  this->Asked = false;
  this->labelTransforms();
  this->shorten();
  for (auto* widget : this->parentWidget()->findChildren<pqInteractivePropertyWidget*>())
  {
    vtkAbstractWidget* const shown = widget->widgetProxy()->GetWidget();
    if (!shown || this->Known.contains(widget))
    {
      continue;
    }
    this->Known.insert(widget);
    this->color(shown->GetRepresentation());
    if (this->xml()->GetAttribute("list") &&
        vtkBoxRepresentation::SafeDownCast(shown->GetRepresentation()))
    {
      new BoxAboutCenter(widget, this->parentWidget()->proxy(), this->xml());
    }
    QObject::connect(
      widget, &QObject::destroyed, this, [this](QObject* gone) { this->Known.remove(gone); });
    QObject::connect(widget, &pqInteractivePropertyWidget::startInteraction, this,
      [this, widget] { this->Drag->begin(widget->proxy(), numbersOf(widget->proxy())); });
    // The signals of `widget` come before the panel has the new numbers. With this priority the
    // widget in the view calls after all of ParaView's own.
    const float last = -1;
    this->Events->Connect(shown, vtkCommand::InteractionEvent, this, SLOT(follow()), nullptr, last);
    this->Events->Connect(shown, vtkCommand::EndInteractionEvent, this, SLOT(end()), nullptr, last);
  }
}

void BoxDragDecorator::labelTransforms() const
{
  for (auto* list : this->parentWidget()->findChildren<QComboBox*>())
  {
    const int place = list->findText("RotateAroundOriginTransform");
    if (place >= 0)
    {
      list->setItemText(place, tr("Rotation about a point"));
    }
  }
}

void BoxDragDecorator::shorten() const
{
  for (const char* const name :
    { "enableTranslation", "enableRotation", "enableScaling", "enableMoveFaces" })
  {
    if (auto* const tick = this->parentWidget()->findChild<QCheckBox*>(name))
    {
      tick->hide();
    }
  }
  for (auto* const label : this->parentWidget()->findChildren<QLabel*>())
  {
    if (label->text().contains("Interactivity Controls"))
    {
      label->setWordWrap(true);
      label->setText(tr(
        "Drag a handle to stretch, a face to turn, the middle or with the middle button to move."));
    }
  }
}

void BoxDragDecorator::color(vtkWidgetRepresentation* shown) const
{
  auto* const box = vtkBoxRepresentation::SafeDownCast(shown);
  double color[3];
  if (box && this->xml()->GetVectorAttribute("color", 3, color) == 3)
  {
    box->GetOutlineProperty()->SetColor(color);
    box->GetHandleProperty()->SetColor(color);
  }
}

void BoxDragDecorator::follow()
{
  this->Drag->follow(false);
}

void BoxDragDecorator::end()
{
  this->Drag->end();
}
