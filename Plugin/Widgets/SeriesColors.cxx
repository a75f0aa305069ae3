// SPDX-License-Identifier: BSD-3-Clause
#include "SeriesColors.h"

#include "SurfaceColors.h"

#include <pqApplicationCore.h>
#include <pqDataRepresentation.h>
#include <pqOutputPort.h>
#include <pqPipelineSource.h>
#include <pqServerManagerModel.h>
#include <vtkPVArrayInformation.h>
#include <vtkPVDataInformation.h>
#include <vtkPVDataSetAttributesInformation.h>
#include <vtkPVXMLElement.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>

#include <string>
#include <vector>

namespace
{
bool isWanted(pqOutputPort* port)
{
  vtkPVXMLElement* const hints = port->getSource()->getProxy()->GetHints();
  vtkPVXMLElement* const hint = hints ? hints->FindNestedElementByName("SeriesColors") : nullptr;
  int wanted = -1;
  return hint && hint->GetScalarAttribute("port", &wanted) && wanted == port->getPortNumber();
}

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

void SeriesColors::startup()
{
  QObject::connect(pqApplicationCore::instance()->getServerManagerModel(),
    SIGNAL(representationAdded(pqRepresentation*)), this, SLOT(added(pqRepresentation*)));
}

void SeriesColors::added(pqRepresentation* representation)
{
  // A state that is loaded brings its own colors.
  if (qobject_cast<pqDataRepresentation*>(representation) &&
      !pqApplicationCore::instance()->isLoadingState())
  {
    QObject::connect(representation, SIGNAL(dataUpdated()), this, SLOT(dataUpdated()));
  }
}

void SeriesColors::dataUpdated()
{
  auto* const shown = qobject_cast<pqDataRepresentation*>(this->sender());
  pqOutputPort* const port = shown ? shown->getOutputPortFromInput() : nullptr;
  if (!port || this->Known.contains(shown) || !shown->getProxy()->GetProperty("SeriesColor") ||
      !isWanted(port))
  {
    return;
  }
  const std::vector<std::string> texts =
    colorsOf(port->getDataInformation()->GetRowDataInformation());
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
  shown->renderViewEventually();
}
