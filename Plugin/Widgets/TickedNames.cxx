// SPDX-License-Identifier: BSD-3-Clause
#include "TickedNames.h"

#include <vtkSMProperty.h>
#include <vtkSMUncheckedPropertyHelper.h>

#include <QString>
#include <QStringList>

QStringList tickedNames(vtkSMProperty* list)
{
  QStringList names;
  const vtkSMUncheckedPropertyHelper pairs(list);
  for (unsigned int i = 0; i + 1 < pairs.GetNumberOfElements(); i += 2)
  {
    if (QString(pairs.GetAsString(i + 1)).toInt() != 0)
    {
      names << pairs.GetAsString(i);
    }
  }
  return names;
}
