// SPDX-License-Identifier: BSD-3-Clause
#include "DefaultColors.h"

#include "ScaledJacobianPreset.h" // made from Presets/ScaledJacobian.json

#include <vtkLogger.h>
#include <vtkSMSettings.h>

#include <string>

void MeshMorphingSetDefaultColors()
{
  // The file is a list of one preset. ParaView takes an array's default colors from its settings,
  // which have the same keys under the array's name. The range must not follow the data, and the
  // colors must not be binned; otherwise the break would not stay at 0.
  const std::string list = ScaledJacobianPreset;
  const std::size_t first = list.find('{'), last = list.rfind('}');
  const std::string settings =
    R"({ "array_lookup_tables": { "ScaledJacobian": { "PVLookupTable": )" +
    list.substr(first, last - first) +
    R"(, "AutomaticRescaleRangeMode": -1, "ScalarRangeInitialized": 1, "Discretize": 0 } } } })";

  // With a lower priority than the settings of the site and of the user.
  const double priority = 0;
  if (!vtkSMSettings::GetInstance()->AddCollectionFromString(settings, priority))
  {
    vtkLogF(ERROR, "MeshMorphing: the default colors of ScaledJacobian were not accepted.");
  }
}
