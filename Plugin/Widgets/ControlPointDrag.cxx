// SPDX-License-Identifier: BSD-3-Clause
#include "ControlPointDrag.h"

#include "LiveDrag.h"

#include <pqCoreUtilities.h>
#include <pqPropertyWidget.h>
#include <pqView.h>
#include <vtkCommand.h>
#include <vtkHandleWidget.h>
#include <vtkPVXMLElement.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkSMProperty.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMRenderViewProxy.h>
#include <vtkSMUncheckedPropertyHelper.h>
#include <vtkSphereHandleRepresentation.h>

#include <QEvent>
#include <QTimer>

#include <algorithm>
#include <cmath>

namespace
{
constexpr std::size_t Most = 1000;
constexpr double Pixels = 12; ///< of a sphere
constexpr int OfHandle = 7, OfLattice = 6;

std::vector<double> valuesOf(const vtkSMPropertyHelper& helper)
{
  std::vector<double> values;
  for (unsigned int i = 0; i < helper.GetNumberOfElements(); ++i)
  {
    values.push_back(helper.GetAsDouble(i));
  }
  return values;
}
}

ControlPointDrag::ControlPointDrag(vtkPVXMLElement* hint, pqPropertyWidget* widget)
  : Superclass(hint, widget)
  , Drag(new LiveDrag(widget))
{
  widget->installEventFilter(this);
  QObject::connect(widget, &pqPropertyWidget::viewChanged, this, &ControlPointDrag::showLater);
  pqCoreUtilities::connect(
    widget->property(), vtkCommand::UncheckedPropertyModifiedEvent, this, SLOT(showLater()));
  if (this->isLattice())
  {
    pqCoreUtilities::connect(widget->proxy()->GetProperty(hint->GetAttribute("points")),
      vtkCommand::ModifiedEvent, this, SLOT(showLater()));
  }
}

ControlPointDrag::~ControlPointDrag()
{
  this->hidePoints();
}

bool ControlPointDrag::eventFilter(QObject* object, QEvent* event)
{
  if (event->type() == QEvent::Show || event->type() == QEvent::Hide)
  {
    this->showLater();
  }
  return this->Superclass::eventFilter(object, event);
}

bool ControlPointDrag::isLattice() const
{
  return this->xml()->GetAttribute("points") != nullptr;
}

std::array<int, 3> ControlPointDrag::size() const
{
  const vtkSMPropertyHelper helper(
    this->parentWidget()->proxy(), this->xml()->GetAttribute("size"));
  return { helper.GetAsInt(0), helper.GetAsInt(1), helper.GetAsInt(2) };
}

std::vector<ControlPointDrag::Point> ControlPointDrag::points() const
{
  const std::vector<double> listed =
    valuesOf(vtkSMUncheckedPropertyHelper(this->parentWidget()->property()));
  std::vector<Point> points;
  if (!this->isLattice())
  {
    for (std::size_t i = 0; i + OfHandle <= listed.size(); i += OfHandle)
    {
      const double* const v = &listed[i];
      points.push_back({ { v[0], v[1], v[2] }, { v[3], v[4], v[5] } });
    }
    return points;
  }
  const std::vector<double> rest = valuesOf(
    vtkSMPropertyHelper(this->parentWidget()->proxy(), this->xml()->GetAttribute("points")));
  for (std::size_t i = 0; i + 3 <= rest.size(); i += 3)
  {
    points.push_back({ { rest[i], rest[i + 1], rest[i + 2] }, {} });
  }
  const std::array<int, 3> size = this->size();
  if (static_cast<std::size_t>(size[0]) * size[1] * size[2] != points.size())
  {
    return {}; // another size has been typed since the execution
  }
  for (std::size_t i = 0; i + OfLattice <= listed.size(); i += OfLattice)
  {
    const double* const v = &listed[i];
    const double id = (v[2] * size[1] + v[1]) * size[0] + v[0];
    if (id >= 0 && id < static_cast<double>(points.size()))
    {
      for (int d = 0; d < 3; ++d)
      {
        points[static_cast<std::size_t>(id)].Displacement[d] += v[3 + d];
      }
    }
  }
  return points;
}

void ControlPointDrag::showLater()
{
  if (!this->IsDue && !this->IsDragged)
  {
    this->IsDue = true;
    QTimer::singleShot(0, this, [this] { this->showPoints(); });
  }
}

void ControlPointDrag::hidePoints()
{
  this->Events->Disconnect();
  for (vtkHandleWidget* const widget : this->Widgets)
  {
    widget->Off();
    widget->SetInteractor(nullptr);
  }
  const bool isChanged = !this->Widgets.empty();
  this->Widgets.clear();
  if (isChanged && this->View)
  {
    this->View->render();
  }
}

void ControlPointDrag::showPoints()
{
  this->IsDue = false;
  if (this->IsDragged)
  {
    return;
  }
  pqView* const view = this->parentWidget()->view();
  auto* const camera = vtkSMRenderViewProxy::SafeDownCast(view ? view->getViewProxy() : nullptr);
  const std::vector<Point> points =
    camera && this->parentWidget()->isVisible() ? this->points() : std::vector<Point>();
  if (points.empty() || points.size() > Most || this->View != view ||
      points.size() != this->Widgets.size())
  {
    this->hidePoints();
  }
  if (points.empty() || points.size() > Most)
  {
    return;
  }
  this->View = view;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (i == this->Widgets.size())
    {
      vtkNew<vtkSphereHandleRepresentation> sphere;
      sphere->SetHandleSize(Pixels);
      sphere->GetProperty()->SetColor(1, 0.6, 0.1); // as the box
      auto widget = vtkSmartPointer<vtkHandleWidget>::New();
      widget->SetRepresentation(sphere);
      widget->SetInteractor(camera->GetInteractor());
      widget->SetDefaultRenderer(camera->GetRenderer());
      widget->SetCurrentRenderer(camera->GetRenderer());
      sphere->SetRenderer(camera->GetRenderer());
      sphere->PlaceWidget(camera->GetRenderer()->ComputeVisiblePropBounds());
      this->Widgets.push_back(widget);
      if (i == 0)
      {
        const float first = 1;
        this->Events->Connect(camera->GetInteractor(), vtkCommand::LeftButtonPressEvent, this,
          SLOT(pick()), nullptr, first);
      }
      this->Events->Connect(
        widget, vtkCommand::StartInteractionEvent, this, SLOT(begin(vtkObject*)));
      this->Events->Connect(widget, vtkCommand::InteractionEvent, this, SLOT(follow(vtkObject*)));
      this->Events->Connect(widget, vtkCommand::EndInteractionEvent, this, SLOT(end()));
    }
    Triple place = points[i].Rest;
    for (int d = 0; d < 3; ++d)
    {
      place[d] += points[i].Displacement[d];
    }
    auto* const shown =
      vtkHandleRepresentation::SafeDownCast(this->Widgets[i]->GetRepresentation());
    shown->SetWorldPosition(place.data());
    this->Widgets[i]->On();
  }
  view->render();
}

void ControlPointDrag::pick()
{
  if (this->Widgets.empty())
  {
    return;
  }
  const int* const mouse = this->Widgets.front()->GetInteractor()->GetEventPosition();
  vtkRenderer* const renderer = this->Widgets.front()->GetCurrentRenderer();
  vtkHandleWidget* nearest = nullptr;
  double depth = 2;
  for (vtkHandleWidget* const widget : this->Widgets)
  {
    widget->ProcessEventsOn();
    double place[3];
    vtkHandleRepresentation::SafeDownCast(widget->GetRepresentation())->GetWorldPosition(place);
    renderer->SetWorldPoint(place[0], place[1], place[2], 1);
    renderer->WorldToDisplay();
    const double* const shown = renderer->GetDisplayPoint();
    if (std::hypot(shown[0] - mouse[0], shown[1] - mouse[1]) <= Pixels && shown[2] < depth)
    {
      depth = shown[2];
      nearest = widget;
    }
  }
  for (vtkHandleWidget* const widget : this->Widgets)
  {
    widget->SetProcessEvents(!nearest || widget == nearest ? 1 : 0);
  }
}

void ControlPointDrag::begin(vtkObject*)
{
  this->IsDragged = true;
  vtkSMProxy* const filter = this->parentWidget()->proxy();
  this->Drag->begin(filter, { filter->GetPropertyName(this->parentWidget()->property()) });
}

void ControlPointDrag::follow(vtkObject* dragged)
{
  const auto found = std::find(this->Widgets.begin(), this->Widgets.end(), dragged);
  const std::vector<Point> points = this->points();
  const auto i = static_cast<std::size_t>(found - this->Widgets.begin());
  if (found == this->Widgets.end() || i >= points.size())
  {
    return;
  }
  Triple to;
  vtkHandleRepresentation::SafeDownCast((*found)->GetRepresentation())->GetWorldPosition(to.data());
  for (int d = 0; d < 3; ++d)
  {
    to[d] -= points[i].Rest[d];
  }
  this->write(static_cast<int>(i), to);
  this->Drag->follow(false);
}

void ControlPointDrag::end()
{
  this->IsDragged = false;
  if (this->Drag->isRunning())
  {
    this->Drag->end();
  }
  else
  {
    Q_EMIT this->parentWidget()->changeAvailable();
    Q_EMIT this->parentWidget()->changeFinished();
  }
}

void ControlPointDrag::write(int point, const Triple& displacement)
{
  vtkSMUncheckedPropertyHelper list(this->parentWidget()->property());
  std::vector<double> values = valuesOf(list);
  if (!this->isLattice())
  {
    std::copy(displacement.begin(), displacement.end(), values.begin() + point * OfHandle + 3);
  }
  else
  {
    const std::array<int, 3> size = this->size();
    const std::array<double, 3> place = { static_cast<double>(point % size[0]),
      static_cast<double>(point / size[0] % size[1]),
      static_cast<double>(point / size[0] / size[1]) };
    // One row takes the place of all that the point had.
    for (std::size_t i = values.size() / OfLattice; i-- > 0;)
    {
      const auto row = values.begin() + static_cast<std::ptrdiff_t>(i * OfLattice);
      if (std::equal(place.begin(), place.end(), row))
      {
        values.erase(row, row + OfLattice);
      }
    }
    values.insert(values.end(), place.begin(), place.end());
    values.insert(values.end(), displacement.begin(), displacement.end());
  }
  list.Set(values.data(), static_cast<unsigned int>(values.size()));
}
