// SPDX-License-Identifier: BSD-3-Clause
#include "MorphHelp.h"

#include <pqApplicationCore.h>
#include <vtkLogger.h>
#include <vtkPVPluginTracker.h>

#include <QFileInfo>
#include <QHelpEngine>
#include <QString>

#include <string>

void MorphHelp::startup()
{
  vtkPVPluginTracker* const plugins = vtkPVPluginTracker::GetInstance();
  for (unsigned int i = 0; i < plugins->GetNumberOfPlugins(); ++i)
  {
    const char* const file = plugins->GetPluginFileName(i);
    if (!file || plugins->GetPluginName(i) != std::string("MeshMorphing"))
    {
      continue;
    }
    const QFileInfo pages(QFileInfo(file).canonicalPath() + "/MeshMorphing.qch");
    if (!pages.exists())
    {
      vtkLogF(WARNING, "MeshMorphing: %s is missing; the plugin has no help pages.",
        pages.filePath().toLocal8Bit().constData());
      return;
    }
    // Qt 6 opens the collection of pages for reading alone, unless told otherwise.
    QHelpEngine* const help = pqApplicationCore::instance()->helpEngine();
    help->setReadOnly(false);
    if (!help->setupData() || !help->registerDocumentation(pages.filePath()))
    {
      vtkLogF(WARNING, "MeshMorphing: no help pages from %s: %s",
        pages.filePath().toLocal8Bit().constData(), help->error().toLocal8Bit().constData());
    }
    return;
  }
}
