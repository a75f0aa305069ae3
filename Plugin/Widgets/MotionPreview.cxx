// SPDX-License-Identifier: BSD-3-Clause
#include "MotionPreview.h"

#include <vtkSMProperty.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMPropertyIterator.h>
#include <vtkSMProxy.h>
#include <vtkSMSessionProxyManager.h>
#include <vtkSMUncheckedPropertyHelper.h>
#include <vtkSMVectorProperty.h>

namespace
{
/// Of a motion that the server can show.
constexpr const char* Names[] = { "Displacement", "Vector", "Distance", "Translation", "Rotation",
  "Scale", "AutoCenter", "Center", "TransformAboutCenter", "RadiusChange", "Dimension",
  "DimensionSide", "ScaleFactor" };

/// A filter of no pipeline, which is never executed.
vtkSmartPointer<vtkSMProxy> motionFor(vtkSMProxy* filter)
{
  return vtk::TakeSmartPointer(
    filter->GetSessionProxyManager()->NewProxy("filters", "BoundaryDisplacement"));
}

/// Returns whether the panel has other values than are applied.
bool takePanelValues(vtkSMProperty* from, vtkSMProperty* to)
{
  if (!from || !vtkSMVectorProperty::SafeDownCast(to))
  {
    return false;
  }
  const vtkSMUncheckedPropertyHelper typed(from);
  const vtkSMPropertyHelper applied(from);
  vtkSMPropertyHelper taken(to);
  taken.SetNumberOfElements(typed.GetNumberOfElements());
  bool differs = typed.GetNumberOfElements() != applied.GetNumberOfElements();
  for (unsigned int i = 0; i < typed.GetNumberOfElements(); ++i)
  {
    taken.Set(i, typed.GetAsDouble(i));
    differs = differs || typed.GetAsDouble(i) != applied.GetAsDouble(i);
  }
  return differs;
}
}

MotionPreview::MotionPreview(vtkSMProxy* filter)
  : Filter(filter)
  , Motion(motionFor(filter))
  , Ghost(filter, this->Motion)
{
}

MotionPreview::~MotionPreview() = default;

bool MotionPreview::takeValues()
{
  bool differs = false;
  for (const char* const name : Names)
  {
    differs |= takePanelValues(this->Filter->GetProperty(name), this->Motion->GetProperty(name));
  }
  const vtkSMUncheckedPropertyHelper given(this->Filter, "Transform");
  vtkSMProxy* const typed = given.GetNumberOfElements() > 0 ? given.GetAsProxy() : nullptr;
  vtkSmartPointer<vtkSMProxy> transform;
  if (typed)
  {
    differs |= typed != vtkSMPropertyHelper(this->Filter, "Transform").GetAsProxy();
    transform = vtk::TakeSmartPointer(
      this->Filter->GetSessionProxyManager()->NewProxy(typed->GetXMLGroup(), typed->GetXMLName()));
    const auto properties = vtk::TakeSmartPointer(typed->NewPropertyIterator());
    for (properties->Begin(); !properties->IsAtEnd(); properties->Next())
    {
      if (properties->GetProperty()->GetInformationOnly() == 0)
      {
        differs |=
          takePanelValues(properties->GetProperty(), transform->GetProperty(properties->GetKey()));
      }
    }
    transform->UpdateVTKObjects();
    vtkSMPropertyHelper(this->Motion, "Transform").Set(transform);
  }
  this->Motion->UpdateVTKObjects();
  return differs;
}

void MotionPreview::show(pqView* view, const QStringList& names)
{
  this->Ghost.show(view, names);
}

void MotionPreview::hide()
{
  this->Ghost.hide();
}
