// SPDX-License-Identifier: BSD-3-Clause
#ifndef TickedNames_h
#define TickedNames_h

#include <QStringList>

class vtkSMProperty;

/// The names that are ticked in a list in the panel, applied or not. `list`: pairs of a name and
/// its status. ParaView's adaptor would warn of each name that the list does not have yet.
QStringList tickedNames(vtkSMProperty* list);

#endif
