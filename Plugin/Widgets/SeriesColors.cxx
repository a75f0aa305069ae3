// SPDX-License-Identifier: BSD-3-Clause
#include "SeriesColors.h"

#include "SurfaceColors.h"

#include <pqDataRepresentation.h>
#include <pqOutputPort.h>
#include <pqView.h>
#include <vtkPVArrayInformation.h>
#include <vtkPVDataInformation.h>
#include <vtkPVDataSetAttributesInformation.h>
#include <vtkPVXMLElement.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMViewProxy.h>

#include <string>
#include <vector>

namespace
{
/// A name, red, green and blue for each column.
std::vector<std::string> colorsOf(vtkPVDataSetAttributesInformation* columns)
{
  std::vector<std::string> texts;
  for (int i = 0; i < columns->GetNumberOfArrays(); ++i)
  {
    texts.emplace_back(columns->GetArrayInformation(i)->GetName());
    for (const double part : SurfaceColors::ColorOf(static_cast<std::size_t>(i)))
    {
      texts.push_back(std::to_string(part));
    }
  }
  return texts;
}
}

void SeriesColors::updated(pqDataRepresentation* shown, vtkPVXMLElement* hint)
{
  if (this->Known.contains(shown) || !shown->getProxy()->GetProperty("SeriesColor"))
  {
    return;
  }
  const std::vector<std::string> texts =
    colorsOf(shown->getOutputPortFromInput()->getDataInformation()->GetRowDataInformation());
  if (texts.empty())
  {
    return; // nothing is computed yet
  }
  this->Known.insert(shown);
  QObject::connect(
    shown, &QObject::destroyed, this, [this](QObject* gone) { this->Known.remove(gone); });
  vtkSMPropertyHelper colors(shown->getProxy(), "SeriesColor");
  colors.SetNumberOfElements(static_cast<unsigned int>(texts.size()));
  for (std::size_t i = 0; i < texts.size(); ++i)
  {
    colors.Set(static_cast<unsigned int>(i), texts[i].c_str());
  }
  shown->getProxy()->UpdateVTKObjects();
  vtkSMProxy* const chart = shown->getView()->getViewProxy();
  vtkSMPropertyHelper(chart, "BottomAxisTitle").Set(hint->GetAttribute("x"));
  vtkSMPropertyHelper(chart, "LeftAxisTitle").Set(hint->GetAttribute("y"));
  vtkSMPropertyHelper(chart, "LegendLocation").Set("BottomLeft");
  chart->UpdateVTKObjects();
  shown->renderViewEventually();
}
