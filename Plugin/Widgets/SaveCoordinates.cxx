// SPDX-License-Identifier: BSD-3-Clause
#include "SaveCoordinates.h"

#include <pqActiveObjects.h>
#include <pqCoreUtilities.h>
#include <pqFileDialog.h>
#include <pqOutputPort.h>
#include <pqPipelineFilter.h>
#include <pqPipelineSource.h>
#include <pqServer.h>
#include <pqTimeKeeper.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMSessionProxyManager.h>
#include <vtkSMSourceProxy.h>
#include <vtkSmartPointer.h>

#include <QAction>
#include <QFileInfo>
#include <QLocale>
#include <QMainWindow>
#include <QStatusBar>
#include <QString>

namespace
{
const char* const Formats =
  "Solvers' files (*.e *.ex2 *.exo *.exii *.g *.gen *.cgns *.msh *.inp *.bdf *.nas *.fem *.dat "
  "*.k *.key *.dyn *.cdb *.su2 *.foam);;All files (*)";

/// The file that the data were read from; empty where none is known.
QString fileOf(pqPipelineSource* source)
{
  while (source)
  {
    vtkSMProxy* const proxy = source->getProxy();
    if (proxy->GetProperty("FileName") &&
        vtkSMPropertyHelper(proxy, "FileName").GetNumberOfElements() > 0)
    {
      return vtkSMPropertyHelper(proxy, "FileName").GetAsString();
    }
    auto* const filter = qobject_cast<pqPipelineFilter*>(source);
    source = filter && filter->getInputCount() > 0 ? filter->getInput(0) : nullptr;
  }
  return {};
}

/// What the user chooses; empty after Cancel.
QString chosen(pqServer* server, const char* name, const QString& title, const QString& start,
  const QString& formats, int mode)
{
  const QString folder = start.isEmpty() ? QString() : QFileInfo(start).path();
  pqFileDialog dialog(server, pqCoreUtilities::mainWidget(), title, folder, formats);
  dialog.setObjectName(name);
  dialog.setFileMode(static_cast<pqFileDialog::FileMode>(mode));
  if (mode == pqFileDialog::ExistingFile && !start.isEmpty())
  {
    dialog.selectFile(start);
  }
  const bool isChosen = dialog.exec() == QDialog::Accepted && !dialog.getSelectedFiles().isEmpty();
  return isChosen ? dialog.getSelectedFiles()[0] : QString();
}
}

SaveCoordinates::SaveCoordinates(QObject* parent)
  : QActionGroup(parent)
  , action_(new QAction(QString("Save Coordinates Into..."), this))
{
  this->action_->setObjectName("actionSaveCoordinatesInto");
  this->action_->setStatusTip("Write a copy of a solver's own file with the coordinates of the "
                              "active data, and with nothing else changed");
  this->addAction(this->action_);
  QObject::connect(this->action_, &QAction::triggered, this, [this] { this->save(); });
  QObject::connect(&pqActiveObjects::instance(), &pqActiveObjects::portChanged, this,
    [this](pqOutputPort*) { this->enable(); });
  this->enable();
}

void SaveCoordinates::enable()
{
  this->action_->setEnabled(pqActiveObjects::instance().activePort() != nullptr);
}

void SaveCoordinates::save()
{
  pqOutputPort* const port = pqActiveObjects::instance().activePort();
  if (!port)
  {
    return;
  }
  pqServer* const server = port->getServer();
  const QString read = fileOf(port->getSource());
  const QString original = chosen(server, "SolverFileDialog",
    read.isEmpty() ? QString("File whose coordinates are replaced")
                   : "File whose coordinates are replaced: " + QFileInfo(read).fileName(),
    read, Formats, pqFileDialog::ExistingFile);
  if (original.isEmpty())
  {
    return;
  }
  const QString extension = QFileInfo(original).suffix();
  const QString formats =
    extension.isEmpty()
      ? QString("All files (*)")
      : QString("Copy of %1 (*.%2)").arg(QFileInfo(original).fileName(), extension);
  const QString copy = chosen(server, "SaveCoordinatesDialog", "Save coordinates into", original,
    formats, pqFileDialog::AnyFile);
  if (copy.isEmpty())
  {
    return;
  }
  const auto writer = vtkSmartPointer<vtkSMProxy>::Take(
    server->proxyManager()->NewProxy("writers", "SolverFileWriter"));
  vtkSMPropertyHelper(writer, "Input")
    .Set(port->getSource()->getProxy(), static_cast<unsigned int>(port->getPortNumber()));
  vtkSMPropertyHelper(writer, "FileName").Set(copy.toUtf8().constData());
  vtkSMPropertyHelper(writer, "OriginalFileName").Set(original.toUtf8().constData());
  writer->UpdateVTKObjects();
  vtkSMSourceProxy::SafeDownCast(writer)->UpdatePipeline(server->getTimeKeeper()->getTime());
  writer->UpdatePropertyInformation();
  const vtkIdType changed = vtkSMPropertyHelper(writer, "ChangedCoordinates").GetAsIdType();
  auto* const window = qobject_cast<QMainWindow*>(pqCoreUtilities::mainWidget());
  if (window && changed >= 0) // else an error was told
  {
    window->statusBar()->showMessage(
      QString("%1 coordinates of %2 changed, all else kept")
        .arg(QLocale(QLocale::English).toString(qlonglong(changed)), QFileInfo(copy).fileName()));
  }
}
