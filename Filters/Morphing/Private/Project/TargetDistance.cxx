// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Project/TargetDistance.h"

#include "Private/Data/Arrays.h"

#include <vtkDataSet.h>
#include <vtkDoubleArray.h>
#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStaticCellLocator.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace morph::filters::TargetDistance
{
namespace
{
using morph::Index;

constexpr double Unknown = std::numeric_limits<double>::quiet_NaN();

/// Adds the array, and returns the largest and the mean distance.
std::pair<double, double> add(vtkStaticCellLocator* target, const char* name,
  const std::vector<Index>& ids, const morph::Points& points, vtkDataSet* data)
{
  auto distances = Arrays::Make<vtkDoubleArray>(name, data->GetNumberOfPoints());
  distances->FillValue(Unknown);
  vtkNew<vtkGenericCell> cell;
  double largest = 0, sum = 0;
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    double place[3], distance2 = 0;
    vtkIdType id = -1;
    int part = 0;
    target->FindClosestPoint(
      points.row(static_cast<Index>(i)).data(), place, cell, id, part, distance2);
    const double distance = std::sqrt(distance2);
    distances->SetValue(ids[i], distance);
    largest = std::max(largest, distance);
    sum += distance;
  }
  data->GetPointData()->AddArray(distances);
  return ids.empty() ? std::pair(Unknown, Unknown)
                     : std::pair(largest, sum / static_cast<double>(ids.size()));
}
}

Summary Write(vtkPolyData* target, const std::vector<Index>& ids, const morph::Points& before,
  const morph::Points& after, vtkDataSet* data)
{
  vtkNew<vtkStaticCellLocator> locator;
  locator->SetDataSet(target);
  locator->BuildLocator();
  const auto [maxBefore, meanBefore] = add(locator, "TargetDistanceBefore", ids, before, data);
  const auto [max, mean] = add(locator, "TargetDistance", ids, after, data);
  return { maxBefore, meanBefore, max, mean };
}
}
