// SPDX-License-Identifier: BSD-3-Clause
#include "DefaultColors.h"

#include "ScaledJacobianPreset.h" // made from Presets/ScaledJacobian.json

#include <vtkLogger.h>
#include <vtkSMSettings.h>

#include <string>

void MeshMorphingSetDefaultColors()
{
  // The file is a list of one preset. ParaView takes an array's default colors from its settings,
  // which have the same keys under the array's name. The range must not follow the data
  // (see ColorRange.h), and the colors must not be binned, or the break would not stay at 0.
  const std::string list = ScaledJacobianPreset;
  const std::size_t first = list.find('{'), last = list.rfind('}');
  const std::string settings =
    R"({ "array_lookup_tables": { "ScaledJacobian": { "PVLookupTable": )" +
    list.substr(first, last - first) +
    R"(, "AutomaticRescaleRangeMode": -1, "ScalarRangeInitialized": 1, "Discretize": 0 } } } })";

  // The role of a point or face in a displaced boundary: categories with names.
  const std::string roles = R"({ "array_lookup_tables": { "Role": { "PVLookupTable": {
    "IndexedLookup": 1,
    "Annotations": [ "0", "Stays", "1", "Moves", "2", "Held", "3", "Follows",
                     "4", "Free", "5", "Zone", "6", "Layer" ],
    "IndexedColors": [ 0.75, 0.75, 0.75, 0.85, 0.35, 0.05, 0.3, 0.3, 0.3, 0.35, 0.65, 0.85,
                       0.55, 0.8, 0.45, 0.6, 0.4, 0.7, 0.95, 0.8, 0.3 ],
    "NanColor": [ 1.0, 1.0, 1.0 ] } } } })";

  // With a lower priority than the settings of the site and of the user.
  const double priority = 0;
  for (const std::string& defaults : { settings, roles })
  {
    if (!vtkSMSettings::GetInstance()->AddCollectionFromString(defaults, priority))
    {
      vtkLogF(ERROR, "MeshMorphing: these default colors were not accepted: %s", defaults.c_str());
    }
  }
}
