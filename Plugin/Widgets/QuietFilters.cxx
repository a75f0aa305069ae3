// SPDX-License-Identifier: BSD-3-Clause
#include "QuietFilters.h"

#include <pqApplicationCore.h>
#include <pqPipelineSource.h>
#include <pqServerManagerModel.h>
#include <vtkClientServerStream.h>
#include <vtkSMProxy.h>
#include <vtkSMSession.h>

void QuietFilters::startup()
{
  auto* const model = pqApplicationCore::instance()->getServerManagerModel();
  QObject::connect(model, &pqServerManagerModel::sourceAdded, this, &QuietFilters::quiet);
  for (pqPipelineSource* const source : model->findItems<pqPipelineSource*>())
  {
    this->quiet(source);
  }
}

void QuietFilters::quiet(pqPipelineSource* source)
{
  vtkSMProxy* const filter = source->getProxy();
  if (!filter->GetProperty("Messages"))
  {
    return;
  }
  // Not a property: a state and a trace would keep it, and scripts fall silent.
  vtkClientServerStream stream;
  stream << vtkClientServerStream::Invoke << VTKOBJECT(filter) << "SetQuiet" << 1
         << vtkClientServerStream::End;
  filter->GetSession()->ExecuteStream(filter->GetLocation(), stream);
}
