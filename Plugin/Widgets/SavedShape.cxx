// SPDX-License-Identifier: BSD-3-Clause
#include "SavedShape.h"

#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqDataRepresentation.h>
#include <pqObjectBuilder.h>
#include <pqOutputPort.h>
#include <pqPipelineFilter.h>
#include <pqPropertiesPanel.h>
#include <pqPropertyWidget.h>
#include <pqServerManagerModel.h>
#include <pqUndoStack.h>
#include <pqView.h>
#include <vtkSMInputProperty.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMPropertyIterator.h>
#include <vtkSMProxy.h>
#include <vtkSMProxyListDomain.h>
#include <vtkSMProxyProperty.h>
#include <vtkSMSourceProxy.h>
#include <vtkSmartPointer.h>

#include <QList>
#include <QMap>
#include <QString>
#include <QTimer>

#include <string>

namespace
{
constexpr int Surface = 2; ///< the output of Morph Mesh that is a shape

pqPropertiesPanel* panelOf(QWidget* widget)
{
  while (widget && !qobject_cast<pqPropertiesPanel*>(widget))
  {
    widget = widget->parentWidget();
  }
  return qobject_cast<pqPropertiesPanel*>(widget);
}

/// Gives `to` the values of `from`. Of a property that is a proxy to choose, such as a transform,
/// `to` has its own, which gets the values.
void copyProperties(vtkSMProxy* from, vtkSMProxy* to)
{
  const auto properties = vtk::TakeSmartPointer(from->NewPropertyIterator());
  for (properties->Begin(); !properties->IsAtEnd(); properties->Next())
  {
    vtkSMProperty* const source = properties->GetProperty();
    vtkSMProperty* const target = to->GetProperty(properties->GetKey());
    if (!target || source->GetInformationOnly() != 0)
    {
      continue;
    }
    auto* const choices = target->FindDomain<vtkSMProxyListDomain>();
    if (choices && !vtkSMInputProperty::SafeDownCast(source))
    {
      vtkSMProxy* const chosen = vtkSMPropertyHelper(source).GetAsProxy();
      vtkSMProxy* const own =
        chosen ? choices->FindProxy(chosen->GetXMLGroup(), chosen->GetXMLName()) : nullptr;
      if (own)
      {
        copyProperties(chosen, own);
        vtkSMPropertyHelper(target).Set(own);
      }
    }
    else
    {
      target->Copy(source);
    }
  }
  to->UpdateVTKObjects();
}

/// The last one on this output.
pqPipelineSource* shapesOn(pqOutputPort* mesh)
{
  pqPipelineSource* found = nullptr;
  for (pqPipelineSource* const one : mesh->getConsumers())
  {
    const vtkSMPropertyHelper input(one->getProxy(), "Input", true);
    if (one->getProxy()->GetXMLName() == std::string("MorphShapes") &&
        input.GetAsProxy() == mesh->getSource()->getProxy())
    {
      found = one;
    }
  }
  return found;
}

void hide(pqPipelineSource* filter, pqView* view)
{
  for (int port = 0; view && port < filter->getNumberOfOutputPorts(); ++port)
  {
    pqDataRepresentation* const shown = filter->getRepresentation(port, view);
    if (shown)
    {
      shown->setVisible(false);
    }
  }
}

pqPipelineSource* copyOf(pqPipelineSource* filter, pqOutputPort* mesh)
{
  pqApplicationCore* const core = pqApplicationCore::instance();
  pqPipelineSource* const copy = core->getObjectBuilder()->createFilter(
    "filters", filter->getProxy()->GetXMLName(), mesh->getSource(), mesh->getPortNumber());
  copyProperties(filter->getProxy(), copy->getProxy());
  // A shape is the whole motion, at any time.
  vtkSMPropertyHelper(copy->getProxy(), "NumberOfSteps").Set(0);
  copy->getProxy()->UpdateVTKObjects();
  copy->setModifiedState(pqProxy::UNMODIFIED); // else Apply would show it
  int number = 1;
  while (core->getServerManagerModel()->findItem<pqPipelineSource*>(QString("Shape%1").arg(number)))
  {
    ++number;
  }
  copy->rename(QString("Shape%1").arg(number));
  return copy;
}
}

bool SavedShape::HasMotion(vtkSMProxy* filter)
{
  const std::string status = vtkSMPropertyHelper(filter, "MorphStatus").GetAsString();
  return status != "None" && status != "Failed" && status != "Cancelled";
}

void SavedShape::Save(pqPropertyWidget* widget)
{
  pqApplicationCore* const core = pqApplicationCore::instance();
  auto* const filter = core->getServerManagerModel()->findItem<pqPipelineFilter*>(widget->proxy());
  pqPropertiesPanel* const panel = panelOf(widget);
  pqOutputPort* const mesh = filter ? filter->getInput("Input", 0) : nullptr;
  if (!mesh || !panel)
  {
    return;
  }
  BEGIN_UNDO_SET("Save as Shape");
  if (filter->modifiedState() != pqProxy::UNMODIFIED)
  {
    panel->apply();
  }
  vtkSMSourceProxy::SafeDownCast(filter->getProxy())->UpdatePipeline(); // where no view shows it
  if (!HasMotion(filter->getProxy()))
  {
    END_UNDO_SET();
    return;
  }
  pqPipelineSource* const copy = copyOf(filter, mesh);
  pqPipelineSource* shapes = shapesOn(mesh);
  if (shapes)
  {
    vtkSMPropertyHelper(shapes->getProxy(), "Shapes")
      .Add(copy->getProxy(), static_cast<unsigned int>(Surface));
    shapes->getProxy()->UpdateVTKObjects();
    shapes->setModifiedState(pqProxy::MODIFIED);
  }
  else
  {
    QMap<QString, QList<pqOutputPort*>> inputs;
    inputs["Input"] = { mesh };
    inputs["Shapes"] = { copy->getOutputPort(Surface) };
    shapes =
      core->getObjectBuilder()->createFilter("filters", "MorphShapes", inputs, filter->getServer());
  }
  hide(filter, widget->view()); // it would cover the blended mesh
  END_UNDO_SET();
  pqActiveObjects::instance().setActiveSource(shapes);
  QTimer::singleShot(0, panel, [panel] { panel->apply(); });
}
