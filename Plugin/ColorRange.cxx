// SPDX-License-Identifier: BSD-3-Clause
#include "ColorRange.h"

#include <vtkCommand.h>
#include <vtkNew.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMProxyManager.h>
#include <vtkSMTransferFunctionManager.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace
{
/// Gives a color map its range back when a property has changed.
class RangeKeeper : public vtkCommand
{
public:
  static RangeKeeper* New() { return new RangeKeeper; }

  void Execute(vtkObject* caller, unsigned long, void* property) override
  {
    if (!property || static_cast<const char*>(property) == std::string("RGBPoints"))
    {
      this->Keep(vtkSMProxy::SafeDownCast(caller));
    }
  }

  void Keep(vtkSMProxy* table)
  {
    vtkSMPropertyHelper property(table, "RGBPoints");
    std::vector<double> points = property.GetDoubleArray(); // a place and its color, ascending
    if (points.size() < 8 || points.size() % 4 != 0)
    {
      return;
    }
    const bool isLocked = vtkSMPropertyHelper(table, "AutomaticRescaleRangeMode").GetAsInt() ==
                          vtkSMTransferFunctionManager::NEVER;
    const auto first = [](const std::vector<double>& all) { return all.front(); };
    const auto last = [](const std::vector<double>& all) { return all[all.size() - 4]; };
    if (!isLocked || this->Points.empty() ||
        (first(points) == first(this->Points) && last(points) == last(this->Points)))
    {
      this->Points = points;
      return;
    }
    const double before = first(points), width = last(points) - before;
    const bool isRescaled = points.size() == this->Points.size() && this->HaveColorsOf(points);
    if (isRescaled || !(width > 0))
    {
      points = this->Points; // exactly: a break of 1e-12 may be lost already
    }
    for (std::size_t i = 0; !isRescaled && width > 0 && i < points.size(); i += 4)
    {
      const double part = (points[i] - before) / width;
      points[i] = (1 - part) * first(this->Points) + part * last(this->Points);
    }
    property.Set(points.data(), static_cast<unsigned int>(points.size())); // comes here again
  }

private:
  bool HaveColorsOf(const std::vector<double>& points) const
  {
    bool equal = true;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      equal = equal && (i % 4 == 0 || points[i] == this->Points[i]);
    }
    return equal;
  }

  std::vector<double> Points; ///< that have the range
};

/// Gives each color map of ScaledJacobian a keeper when it is registered.
class Registrations : public vtkCommand
{
public:
  static Registrations* New() { return new Registrations; }

  void Execute(vtkObject*, unsigned long, void* data) override
  {
    const auto* made = static_cast<vtkSMProxyManager::RegisteredProxyInformation*>(data);
    if (made && made->Proxy && made->GroupName && made->GroupName == std::string("lookup_tables") &&
        IsOfScaledJacobian(made->ProxyName))
    {
      vtkNew<RangeKeeper> keeper;
      keeper->Keep(made->Proxy);
      made->Proxy->AddObserver(vtkCommand::PropertyModifiedEvent, keeper);
    }
  }

private:
  /// "ScaledJacobian.PVLookupTable", or that with the id of a separate map before it.
  static bool IsOfScaledJacobian(const char* name)
  {
    const std::string text = name ? name : "", end = "ScaledJacobian.PVLookupTable";
    const std::size_t before = text.size() - std::min(text.size(), end.size());
    return text.compare(before, std::string::npos, end) == 0 &&
           (before == 0 || text[before - 1] == '_' || text[before - 1] == '.');
  }
};
}

void MeshMorphingKeepColorRange()
{
  vtkNew<Registrations> registrations;
  vtkSMProxyManager::GetProxyManager()->AddObserver(vtkCommand::RegisterEvent, registrations);
}
