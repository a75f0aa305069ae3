// SPDX-License-Identifier: BSD-3-Clause
#include "BoxAboutCenter.h"

#include <pqCoreUtilities.h>
#include <pqInteractivePropertyWidget.h>
#include <pqSMAdaptor.h>
#include <vtkBoundingBox.h>
#include <vtkCommand.h>
#include <vtkNew.h>
#include <vtkPVXMLElement.h>
#include <vtkSMNewWidgetRepresentationProxy.h>
#include <vtkSMProperty.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMUncheckedPropertyHelper.h>
#include <vtkTransform.h>

#include <QLineEdit>
#include <QMetaObject>
#include <QTimer>
#include <QVariant>

#include <algorithm>

namespace
{
/// Where the transform brings a point, without its translation.
std::array<double, 3> turned(const std::array<double, 3>& rotation,
  const std::array<double, 3>& scale, const std::array<double, 3>& point)
{
  vtkNew<vtkTransform> transform;
  transform->RotateZ(rotation[2]);
  transform->RotateX(rotation[0]);
  transform->RotateY(rotation[1]);
  transform->Scale(scale.data());
  std::array<double, 3> result{};
  transform->TransformPoint(point.data(), result.data());
  return result;
}
}

BoxAboutCenter::BoxAboutCenter(
  pqInteractivePropertyWidget* box, vtkSMProxy* filter, vtkPVXMLElement* hint)
  : QObject(box)
  , Box(box)
  , Filter(filter)
  , List(this->named(hint, "list"))
  , Sizes(this->named(hint, "sizes"))
  , Bounds(this->named(hint, "bounds"))
  , Moving(filter->GetProperty("Moving"))
{
  hint->GetScalarAttribute("moving", &this->MovingList);
  hint->GetScalarAttribute("region", &this->MovingRegion);
  for (vtkSMProperty* property : { this->List, this->Moving })
  {
    if (property)
    {
      for (const auto event : { vtkCommand::ModifiedEvent,
             vtkCommand::UncheckedPropertyModifiedEvent, vtkCommand::DomainModifiedEvent })
      {
        pqCoreUtilities::connect(property, static_cast<int>(event), this, SLOT(placeLater()));
      }
    }
  }
  if (vtkSMProperty* const about = filter->GetProperty("TransformAboutCenter"))
  {
    for (const auto event :
      { vtkCommand::ModifiedEvent, vtkCommand::UncheckedPropertyModifiedEvent })
    {
      pqCoreUtilities::connect(about, static_cast<int>(event), this, SLOT(hideWhereAboutCenter()));
    }
    QObject::connect(
      box, SIGNAL(widgetVisibilityToggled(bool)), this, SLOT(hideWhereAboutCenter()));
    this->hideWhereAboutCenter();
  }
  for (const char* name : { "rotateX", "rotateY", "rotateZ", "scaleX", "scaleY", "scaleZ" })
  {
    if (auto* const field = box->findChild<QLineEdit*>(name))
    {
      QObject::connect(field, SIGNAL(textChangedAndEditingFinished()), this, SLOT(keepCenter()));
    }
  }
  for (const char* name : { "translateX", "translateY", "translateZ" })
  {
    if (auto* const field = box->findChild<QLineEdit*>(name))
    {
      QObject::connect(field, &QLineEdit::textChanged, this,
        [this] { QTimer::singleShot(0, this, [this] { this->Before = this->read(); }); });
    }
  }
  QObject::connect(box, &pqInteractivePropertyWidget::endInteraction, this,
    [this] { QTimer::singleShot(0, this, [this] { this->Before = this->read(); }); });
  // ParaView places it around the whole input each time that the panel shows the filter.
  pqCoreUtilities::connect(box->widgetProxy()->GetProperty("PlaceWidget"),
    vtkCommand::ModifiedEvent, this, SLOT(placeLater()));
  this->Before = this->read();
  this->placeLater();
}

BoxAboutCenter::~BoxAboutCenter() = default;

vtkSMProperty* BoxAboutCenter::named(vtkPVXMLElement* hint, const char* role) const
{
  const char* const name = hint->GetAttribute(role);
  return name ? this->Filter->GetProperty(name) : nullptr;
}

BoxAboutCenter::Numbers BoxAboutCenter::read() const
{
  const auto values = [this](const char* name)
  {
    Triple triple{};
    vtkSMPropertyHelper(this->Box->widgetProxy(), name).Get(triple.data(), 3);
    return triple;
  };
  return { values("Position"), values("Rotation"), values("Scale") };
}

BoxAboutCenter::Triple BoxAboutCenter::center() const
{
  Triple center = this->Middle;
  vtkSMProperty* const given = this->Filter->GetProperty("Center");
  if (given && vtkSMUncheckedPropertyHelper(this->Filter, "AutoCenter").GetAsInt() == 0)
  {
    vtkSMUncheckedPropertyHelper(given).Get(center.data(), 3);
  }
  return center;
}

bool BoxAboutCenter::isAboutCenter() const
{
  return this->Filter->GetProperty("TransformAboutCenter") &&
         vtkSMUncheckedPropertyHelper(this->Filter, "TransformAboutCenter").GetAsInt() != 0;
}

void BoxAboutCenter::hideWhereAboutCenter()
{
  if (this->isAboutCenter() && this->Box->isWidgetVisible())
  {
    this->Box->setWidgetVisible(false);
  }
}

vtkBoundingBox BoxAboutCenter::ticked() const
{
  vtkBoundingBox box;
  if (!this->List || !this->Sizes || !this->Bounds || !this->Moving ||
      vtkSMUncheckedPropertyHelper(this->Moving).GetAsInt() != this->MovingList)
  {
    return box;
  }
  const QList<QList<QVariant>> ticks =
    pqSMAdaptor::getSelectionProperty(this->List, pqSMAdaptor::UNCHECKED);
  this->Filter->UpdatePropertyInformation(this->Bounds);
  this->Filter->UpdatePropertyInformation(this->Sizes);
  const vtkSMPropertyHelper names(this->Sizes), numbers(this->Bounds);
  for (const QList<QVariant>& tick : ticks)
  {
    for (unsigned int i = 0;
         tick.size() == 2 && tick[1].toInt() != 0 && 3 * i < names.GetNumberOfElements() &&
         6 * i + 5 < numbers.GetNumberOfElements();
         ++i)
    {
      if (tick[0].toString() == names.GetAsString(3 * i))
      {
        double six[6];
        for (unsigned int k = 0; k < 6; ++k)
        {
          six[k] = numbers.GetAsDouble(6 * i + k);
        }
        box.AddBounds(six);
      }
    }
  }
  return box;
}

void BoxAboutCenter::placeLater()
{
  if (!this->IsPlacing)
  {
    QTimer::singleShot(0, this, SLOT(place()));
  }
}

bool BoxAboutCenter::isOfNothing(const vtkBoundingBox& box) const
{
  return this->List && this->Moving && !box.IsValid() &&
         vtkSMUncheckedPropertyHelper(this->Moving).GetAsInt() == this->MovingList;
}

void BoxAboutCenter::place()
{
  this->IsPlacing = true;
  const vtkBoundingBox box = this->ticked();
  if (this->isOfNothing(box) != this->IsOfNothing)
  {
    this->IsOfNothing = !this->IsOfNothing;
    this->Box->setWidgetVisible(!this->IsOfNothing && !this->isAboutCenter());
  }
  vtkSMProxy* const shown = this->Box->widgetProxy();
  if (box.IsValid())
  {
    // A flat box has no faces to drag.
    const double least = 0.1 * box.GetDiagonalLength();
    double six[6];
    box.GetBounds(six);
    for (int axis = 0; axis < 3; ++axis)
    {
      const double missing = std::max(0., least - (six[2 * axis + 1] - six[2 * axis])) / 2;
      six[2 * axis] -= missing;
      six[2 * axis + 1] += missing;
    }
    vtkSMPropertyHelper(shown, "PlaceWidget").Set(six, 6);
    shown->UpdateVTKObjects();
  }
  else
  {
    QMetaObject::invokeMethod(this->Box, "placeWidget"); // around the input
    if (this->Moving && vtkSMUncheckedPropertyHelper(this->Moving).GetAsInt() == this->MovingRegion)
    {
      // The box of the region is around the input, too.
      double six[6];
      vtkSMPropertyHelper(shown, "PlaceWidget").Get(six, 6);
      vtkBoundingBox larger(six);
      larger.Inflate(0.05 * larger.GetDiagonalLength());
      larger.GetBounds(six);
      vtkSMPropertyHelper(shown, "PlaceWidget").Set(six, 6);
      shown->UpdateVTKObjects();
    }
  }
  double six[6];
  vtkSMPropertyHelper(shown, "PlaceWidget").Get(six, 6);
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    this->Middle[axis] = (six[2 * axis] + six[2 * axis + 1]) / 2;
  }
  this->IsPlacing = false;
  QMetaObject::invokeMethod(this->Box, "render");
}

void BoxAboutCenter::keepCenter()
{
  const Numbers now = this->read();
  if (!this->isAboutCenter() && now.Position == this->Before.Position &&
      (now.Rotation != this->Before.Rotation || now.Scale != this->Before.Scale))
  {
    const Triple before = turned(this->Before.Rotation, this->Before.Scale, this->center());
    const Triple after = turned(now.Rotation, now.Scale, this->center());
    Triple position = now.Position;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      position[axis] += before[axis] - after[axis];
    }
    vtkSMPropertyHelper(this->Box->widgetProxy(), "Position").Set(position.data(), 3);
    this->Box->widgetProxy()->UpdateVTKObjects();
  }
  this->Before = this->read();
}
