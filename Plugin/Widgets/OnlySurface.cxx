// SPDX-License-Identifier: BSD-3-Clause
#include "OnlySurface.h"

#include <pqApplicationCore.h>
#include <pqOutputPort.h>
#include <pqPipelineFilter.h>
#include <pqPropertyWidget.h>
#include <pqServerManagerModel.h>
#include <vtkPVDataInformation.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkType.h>

#include <QList>
#include <QString>
#include <QTimer>

OnlySurface::OnlySurface(vtkPVXMLElement* hint, pqPropertyWidget* widget)
  : Superclass(hint, widget)
{
  // The panel is still being made, and its links would empty the widget again.
  QTimer::singleShot(0, this, [this] { this->choose(); });
}

OnlySurface::~OnlySurface() = default;

void OnlySurface::choose()
{
  vtkSMProxy* const proxy = this->parentWidget()->proxy();
  const auto* const model = pqApplicationCore::instance()->getServerManagerModel();
  const auto* const filter = model->findItem<pqPipelineFilter*>(proxy);
  vtkSMPropertyHelper target(this->parentWidget()->property());
  const QString how = vtkSMPropertyHelper(proxy, "Displacement").GetAsString();
  if (!filter || filter->modifiedState() != pqProxy::UNINITIALIZED || how != "Target" ||
      (target.GetNumberOfElements() > 0 && target.GetAsProxy()))
  {
    return;
  }
  QList<vtkSMProxy*> surfaces;
  for (pqPipelineSource* const source : model->findItems<pqPipelineSource*>())
  {
    const bool isRead = source->modifiedState() != pqProxy::UNINITIALIZED;
    if (source != filter && isRead && source->getNumberOfOutputPorts() == 1 &&
        source->getOutputPort(0)->getDataInformation()->GetDataSetType() == VTK_POLY_DATA)
    {
      surfaces << source->getProxy();
    }
  }
  if (surfaces.size() == 1)
  {
    target.Set(surfaces[0], 0);
  }
}
