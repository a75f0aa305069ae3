// SPDX-License-Identifier: BSD-3-Clause
#include "StopButton.h"

#include "vtkSMReportingSourceProxy.h"

#include <QApplication>
#include <QEvent>
#include <pqApplicationCore.h>
#include <pqCoreUtilities.h>
#include <pqPipelineSource.h>
#include <pqProgressManager.h>
#include <pqProgressWidget.h>
#include <pqServerManagerModel.h>
#include <vtkAlgorithm.h>
#include <vtkCommand.h>

namespace
{
/// Milliseconds: before a filter can be stopped, and between two looks at the button.
constexpr qint64 Patience = 1000, Pause = 100;

pqProgressManager* manager()
{
  return pqApplicationCore::instance()->getProgressManager();
}

/// What would change the pipeline that is at work. A timer that is put off fires again.
bool mustWait(QEvent::Type type)
{
  switch (type)
  {
    case QEvent::Close:
    case QEvent::ContextMenu:
    case QEvent::KeyPress:
    case QEvent::KeyRelease:
    case QEvent::MouseButtonDblClick:
    case QEvent::MouseButtonPress:
    case QEvent::MouseButtonRelease:
    case QEvent::MouseMove:
    case QEvent::Shortcut:
    case QEvent::ShortcutOverride:
    case QEvent::Timer:
    case QEvent::Wheel:
      return true;
    default:
      return false;
  }
}
}

void StopButton::startup()
{
  auto* const model = pqApplicationCore::instance()->getServerManagerModel();
  QObject::connect(model, &pqServerManagerModel::sourceAdded, this, &StopButton::watch);
  for (pqPipelineSource* const source : model->findItems<pqPipelineSource*>())
  {
    this->watch(source);
  }
}

void StopButton::watch(pqPipelineSource* source)
{
  auto* const proxy = vtkSMReportingSourceProxy::SafeDownCast(source->getProxy());
  auto* const filter = vtkAlgorithm::SafeDownCast(proxy ? proxy->GetClientSideObject() : nullptr);
  if (filter)
  {
    pqCoreUtilities::connect(filter, vtkCommand::StartEvent, this, SLOT(started(vtkObject*)));
    pqCoreUtilities::connect(filter, vtkCommand::ProgressEvent, this, SLOT(progressed(vtkObject*)));
    pqCoreUtilities::connect(filter, vtkCommand::EndEvent, this, SLOT(ended(vtkObject*)));
  }
}

void StopButton::started(vtkObject* filter)
{
  if (!this->Running && QApplication::mouseButtons() == Qt::NoButton)
  {
    this->Running = vtkAlgorithm::SafeDownCast(filter);
    this->Since.start();
  }
}

void StopButton::progressed(vtkObject* filter)
{
  if (filter != this->Running || this->IsLooking ||
      this->Since.elapsed() < (this->IsOffered ? Pause : Patience))
  {
    return;
  }
  if (!this->IsOffered)
  {
    manager()->setEnableAbort(true);
    this->IsOffered = true;
    // The manager's own signal is gone from ParaView 6.1.
    for (auto* const bar : pqCoreUtilities::mainWidget()->findChildren<pqProgressWidget*>())
    {
      QObject::connect(
        bar, &pqProgressWidget::abortPressed, this, &StopButton::stop, Qt::UniqueConnection);
    }
  }
  this->IsLooking = true;
  qApp->installEventFilter(this);
  // Its own filter lets nothing pass to a window, and so nothing to the button in it.
  const bool unblocked = manager()->unblockEvents(true);
  pqCoreUtilities::processEvents(QEventLoop::ExcludeSocketNotifiers);
  manager()->unblockEvents(unblocked);
  qApp->removeEventFilter(this);
  this->IsLooking = false;
  this->Since.start();
}

void StopButton::ended(vtkObject* filter)
{
  if (filter != this->Running)
  {
    return;
  }
  this->Running->SetAbortExecute(0); // the next execution is another one
  this->Running = nullptr;
  if (this->IsOffered)
  {
    manager()->setEnableAbort(false);
    this->IsOffered = false;
  }
}

void StopButton::stop()
{
  if (this->Running)
  {
    this->Running->SetAbortExecute(1);
  }
}

bool StopButton::eventFilter(QObject* receiver, QEvent* event)
{
  if (!mustWait(event->type()) || manager()->nonBlockableObjects().contains(receiver))
  {
    return false;
  }
  // An event of the window is one that it hands to the widget at its place.
  if (receiver->isWindowType() && event->type() != QEvent::Close && event->type() != QEvent::Timer)
  {
    return false;
  }
  event->ignore();
  return true;
}
