// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceHighlight.h"

#include <pqView.h>
#include <vtkClientServerStream.h>
#include <vtkNew.h>
#include <vtkSMParaViewPipelineController.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMSession.h>
#include <vtkSMSessionProxyManager.h>
#include <vtkSMSourceProxy.h>

namespace
{
/// The view's property for what belongs to no pipeline, as its 3D widgets.
constexpr const char* Hidden = "HiddenRepresentations";
}

SurfaceHighlight::SurfaceHighlight(vtkSMProxy* filter, vtkSMProxy* motion)
  : Filter(filter)
  , Motion(motion)
{
}

SurfaceHighlight::~SurfaceHighlight()
{
  this->hide();
}

vtkSmartPointer<vtkSMSourceProxy> SurfaceHighlight::SourceOf(vtkSMProxy* filter)
{
  auto source = vtkSmartPointer<vtkSMSourceProxy>::Take(vtkSMSourceProxy::SafeDownCast(
    filter->GetSessionProxyManager()->NewProxy("internal_filters", "MorphListedSurfaces")));
  source->UpdateVTKObjects();
  // As a property, the filter would be a producer of the source, and be marked as up to date with
  // it, without an execution.
  vtkClientServerStream stream;
  stream << vtkClientServerStream::Invoke << VTKOBJECT(source.Get()) << "SetFilter"
         << VTKOBJECT(filter) << vtkClientServerStream::End;
  filter->GetSession()->ExecuteStream(source->GetLocation(), stream);
  return source;
}

void SurfaceHighlight::create()
{
  vtkSMSessionProxyManager* proxies = this->Filter->GetSessionProxyManager();
  this->Source = SourceOf(this->Filter);
  this->Representation = vtkSmartPointer<vtkSMProxy>::Take(
    proxies->NewProxy("representations", "GeometryRepresentation"));
  if (this->Motion)
  {
    vtkClientServerStream stream;
    stream << vtkClientServerStream::Invoke << VTKOBJECT(this->Source.Get()) << "SetMotion"
           << VTKOBJECT(this->Motion.Get()) << vtkClientServerStream::End;
    this->Filter->GetSession()->ExecuteStream(this->Source->GetLocation(), stream);
  }
  vtkNew<vtkSMParaViewPipelineController> controller;
  controller->PreInitializeProxy(this->Representation);
  vtkSMPropertyHelper(this->Representation, "Input").Set(this->Source);
  controller->PostInitializeProxy(this->Representation);
  const double orange[] = { 1, 0.55, 0 }, green[] = { 0.2, 0.85, 0.6 };
  const double* const color = this->Motion ? green : orange;
  vtkSMPropertyHelper(this->Representation, "Representation")
    .Set(this->Motion ? "Surface" : "Wireframe");
  vtkSMPropertyHelper(this->Representation, "Opacity").Set(this->Motion ? 0.5 : 1.0);
  vtkSMPropertyHelper(this->Representation, "AmbientColor").Set(color, 3);
  vtkSMPropertyHelper(this->Representation, "DiffuseColor").Set(color, 3);
  vtkSMPropertyHelper(this->Representation, "LineWidth").Set(2.0);
  vtkSMPropertyHelper(this->Representation, "Pickable").Set(0);
  this->Representation->UpdateVTKObjects();
}

void SurfaceHighlight::show(pqView* view, const QStringList& names)
{
  if (!view->getProxy()->GetProperty(Hidden))
  {
    this->hide();
    return;
  }
  if (!this->Source)
  {
    this->create();
  }
  vtkSMPropertyHelper list(this->Source, "Surfaces");
  list.SetNumberOfElements(static_cast<unsigned int>(names.size()));
  for (int i = 0; i < names.size(); ++i)
  {
    list.Set(static_cast<unsigned int>(i), names[i].toUtf8().data());
  }
  this->Source->UpdateVTKObjects();
  this->Source->MarkModified(this->Source); // the filter may have moved the surfaces
  if (this->View != view)
  {
    this->hide();
    this->View = view;
    vtkSMPropertyHelper(view->getProxy(), Hidden).Add(this->Representation);
    view->getProxy()->UpdateVTKObjects();
  }
  view->render();
}

void SurfaceHighlight::hide()
{
  if (this->View)
  {
    vtkSMPropertyHelper(this->View->getProxy(), Hidden).Remove(this->Representation);
    this->View->getProxy()->UpdateVTKObjects();
    this->View->render();
    this->View = nullptr;
  }
}
