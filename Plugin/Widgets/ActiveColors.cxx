// SPDX-License-Identifier: BSD-3-Clause
#include "ActiveColors.h"

#include "SurfaceColors.h"

#include <pqDataRepresentation.h>
#include <pqOutputPort.h>
#include <pqPipelineSource.h>
#include <pqView.h>
#include <vtkDataObject.h>
#include <vtkDataSetAttributes.h>
#include <vtkNew.h>
#include <vtkPVArrayInformation.h>
#include <vtkPVDataInformation.h>
#include <vtkPVDataSetAttributesInformation.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMTransferFunctionManager.h>
#include <vtkSMTransferFunctionProxy.h>
#include <vtkSMViewProxy.h>
#include <vtkSmartPointer.h>

#include <string>

namespace
{
/// Shows the legend of `table` in a view in place of that of `before`, unless that one was hidden.
void showLegend(vtkSMProxy* before, vtkSMProxy* table, const char* title, vtkSMProxy* view)
{
  if (before && !vtkSMTransferFunctionProxy::IsScalarBarVisible(before, view))
  {
    return;
  }
  vtkNew<vtkSMTransferFunctionManager> colors;
  if (before && before != table)
  {
    colors->HideScalarBarIfNotNeeded(before, view);
  }
  if (vtkSMProxy* const legend = colors->GetScalarBarRepresentation(table, view))
  {
    vtkSMPropertyHelper(legend, "Title").Set(title);
    vtkSMPropertyHelper(legend, "ComponentTitle").Set("");
    vtkSMPropertyHelper(legend, "Enabled").Set(1);
    vtkSMPropertyHelper(legend, "Visibility").Set(1);
    legend->UpdateVTKObjects();
  }
}

/// The active scalars, of cells before points; null without.
vtkPVArrayInformation* activeScalars(vtkPVDataInformation* data, int& association)
{
  for (int where : { vtkDataObject::CELL, vtkDataObject::POINT })
  {
    vtkPVDataSetAttributesInformation* arrays = data->GetAttributeInformation(where);
    vtkPVArrayInformation* scalars =
      arrays ? arrays->GetAttributeInformation(vtkDataSetAttributes::SCALARS) : nullptr;
    if (scalars)
    {
      association = where;
      return scalars;
    }
  }
  return nullptr;
}
}

void ActiveColors::updated(pqDataRepresentation* representation, vtkPVXMLElement*)
{
  vtkSMProxy* const proxy = representation->getProxy();
  if (proxy->GetProperty("ColorArrayName") && proxy->GetProperty("LookupTable"))
  {
    this->color(representation);
  }
}

void ActiveColors::color(pqDataRepresentation* representation)
{
  vtkSMProxy* proxy = representation->getProxy();
  vtkPVDataInformation* data = representation->getOutputPortFromInput()->getDataInformation();
  vtkSMPropertyHelper colored(proxy, "ColorArrayName");
  const char* name = colored.GetInputArrayNameToProcess();
  const bool isSolid = !name || !*name;
  int association = vtkDataObject::CELL;
  vtkPVArrayInformation* scalars = activeScalars(data, association);
  if (!this->HadScalars.contains(representation))
  {
    this->HadScalars[representation] = scalars || !isSolid;
    QObject::connect(representation, &QObject::destroyed, this,
      [this](QObject* gone) { this->HadScalars.remove(gone); });
  }
  if (!scalars)
  {
    return;
  }
  const bool isFirst = !this->HadScalars[representation];
  this->HadScalars[representation] = true;
  const bool isThere =
    !isSolid && data->GetArrayInformation(name, colored.GetInputArrayAssociation());
  if (isThere || (isSolid && !isFirst))
  {
    if (isThere && std::string(name) == "SurfaceId")
    {
      SurfaceColors::Name(vtkSMPropertyHelper(proxy, "LookupTable").GetAsProxy(),
        representation->getOutputPortFromInput()->getSource()->getProxy());
    }
    return;
  }
  const vtkSmartPointer<vtkSMProxy> before =
    isSolid ? nullptr : vtkSMPropertyHelper(proxy, "LookupTable").GetAsProxy();
  vtkNew<vtkSMTransferFunctionManager> colors;
  vtkSMProxy* table =
    colors->GetColorTransferFunction(scalars->GetName(), proxy->GetSessionProxyManager());
  colored.SetInputArrayToProcess(association, scalars->GetName());
  vtkSMPropertyHelper(proxy, "LookupTable").Set(table);
  const vtkSMPropertyHelper isFixed(table, "ScalarRangeInitialized", true);
  if (isFixed.GetAsInt() == 0)
  {
    const double* range = scalars->GetComponentRange(0);
    vtkSMTransferFunctionProxy::RescaleTransferFunction(table, range[0], range[1]);
  }
  if (std::string(scalars->GetName()) == "SurfaceId")
  {
    SurfaceColors::Name(table, representation->getOutputPortFromInput()->getSource()->getProxy());
  }
  proxy->UpdateVTKObjects();
  if (representation->isVisible() && representation->getView())
  {
    showLegend(before, table, scalars->GetName(), representation->getView()->getProxy());
  }
  representation->renderViewEventually();
}
