// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceColors.h"

#include <vtkSMProperty.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>

#include <array>
#include <string>
#include <vector>

namespace
{
const std::string Prefix = "Surface ";
constexpr std::size_t Most = 24;

/// The ids of the surfaces, as texts.
std::vector<std::string> idsOf(vtkSMProxy* filter)
{
  std::vector<std::string> ids;
  vtkSMProperty* const property = filter->GetProperty("SurfaceSizes");
  if (property)
  {
    filter->UpdatePropertyInformation(property);
    const vtkSMPropertyHelper sizes(property);
    for (unsigned int i = 0; i + 2 < sizes.GetNumberOfElements(); i += 3)
    {
      const std::string name = sizes.GetAsString(i);
      if (name.compare(0, Prefix.size(), Prefix) == 0)
      {
        ids.push_back(name.substr(Prefix.size()));
      }
    }
  }
  return ids;
}

/// Whether the table has categories with other names than surfaces'.
bool isOfUser(const vtkSMPropertyHelper& annotations)
{
  for (unsigned int i = 0; i + 1 < annotations.GetNumberOfElements(); i += 2)
  {
    if (std::string(annotations.GetAsString(i + 1)).compare(0, Prefix.size(), Prefix) != 0)
    {
      return true;
    }
  }
  return false;
}
}

std::array<double, 3> SurfaceColors::ColorOf(std::size_t place)
{
  // Twelve, and again lighter.
  constexpr double colors[12][3] = { { 0.30, 0.47, 0.66 }, { 0.95, 0.56, 0.17 },
    { 0.35, 0.63, 0.31 }, { 0.88, 0.34, 0.35 }, { 0.46, 0.72, 0.70 }, { 0.93, 0.79, 0.28 },
    { 0.69, 0.48, 0.63 }, { 1.00, 0.62, 0.65 }, { 0.61, 0.46, 0.37 }, { 0.47, 0.44, 0.43 },
    { 0.00, 0.62, 0.87 }, { 0.55, 0.82, 0.49 } };
  std::array<double, 3> color;
  const double white = place < 12 ? 0 : 0.5;
  for (std::size_t i = 0; i < 3; ++i)
  {
    color[i] = white + (1 - white) * colors[place % 12][i];
  }
  return color;
}

void SurfaceColors::Name(vtkSMProxy* table, vtkSMProxy* filter)
{
  const std::vector<std::string> ids = idsOf(filter);
  vtkSMPropertyHelper annotations(table, "Annotations");
  if (ids.empty() || ids.size() > Most || isOfUser(annotations))
  {
    return;
  }
  vtkSMPropertyHelper colors(table, "IndexedColors");
  annotations.SetNumberOfElements(static_cast<unsigned int>(2 * ids.size()));
  colors.SetNumberOfElements(static_cast<unsigned int>(3 * ids.size()));
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    const auto place = static_cast<unsigned int>(i);
    annotations.Set(2 * place, ids[i].c_str());
    annotations.Set(2 * place + 1, (Prefix + ids[i]).c_str());
    const std::array<double, 3> color = ColorOf(i);
    for (unsigned int k = 0; k < 3; ++k)
    {
      colors.Set(3 * place + k, color[k]);
    }
  }
  vtkSMPropertyHelper(table, "IndexedLookup").Set(1);
  table->UpdateVTKObjects();
}
