// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/DataCheck.h"

#include "Mesh/Mesh.h"
#include "Private/Data/Version.h"
#include "Support/Error.h"

#include <vtkAOSDataArrayTemplate.h>
#include <vtkAbstractArray.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace morph::filters
{
namespace
{
using morph::Error;
using morph::Index;

void requireLengths(
  vtkDataSetAttributes* data, vtkIdType count, const std::string& subject, const char* what)
{
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = data->GetAbstractArray(i);
    if (array && array->GetNumberOfTuples() < count)
    {
      const char* name = array->GetName();
      throw Error(subject + "'s " + what + " array '" + (name ? name : "(no name)") + "' has " +
                  std::to_string(array->GetNumberOfTuples()) + " tuples for " +
                  std::to_string(count) + " " + what +
                  "s. Give it one for each, or remove the array.");
    }
  }
}

/// Whether all ids are known to lie from 0 to `points` - 1. False proves nothing.
bool areWithin(vtkDataArray* ids, vtkIdType points)
{
  const auto within = [points](const auto* values, vtkIdType count)
  {
    bool all = true;
    for (vtkIdType i = 0; i < count; ++i)
    {
      all &= values[i] >= 0 && values[i] < points;
    }
    return all;
  };
  if (auto* wide = vtkAOSDataArrayTemplate<vtkTypeInt64>::FastDownCast(ids))
  {
    return within(wide->GetPointer(0), wide->GetNumberOfValues());
  }
  auto* narrow = vtkAOSDataArrayTemplate<vtkTypeInt32>::FastDownCast(ids);
  return narrow && within(narrow->GetPointer(0), narrow->GetNumberOfValues());
}

/// `first`: the id of the first of these cells in their data set.
void requireCells(
  vtkCellArray* cells, vtkIdType first, vtkIdType points, const std::string& subject)
{
  if (!cells || (cells->GetNumberOfCells() == 0 && cells->GetNumberOfConnectivityIds() == 0))
  {
    return;
  }
  if (!cells->IsValid())
  {
    throw Error(subject +
                "'s cell offsets do not match its connectivity. Write the cells again, with "
                "offsets that start at 0 and do not decrease.");
  }
  if (areWithin(cells->GetConnectivityArray(), points))
  {
    return; // as nearly always
  }
  std::vector<Index> wrong;
  vtkNew<vtkIdList> ids;
  for (vtkIdType c = 0; c < cells->GetNumberOfCells(); ++c)
  {
    cells->GetCellAtId(c, ids);
    const vtkIdType* begin = ids->GetPointer(0);
    if (!std::all_of(begin, begin + ids->GetNumberOfIds(),
          [points](vtkIdType id) { return id >= 0 && id < points; }))
    {
      wrong.push_back(first + c);
    }
  }
  if (!wrong.empty())
  {
    throw Error(subject + " has cells that name points outside 0 to " + std::to_string(points - 1) +
                ": cell ids " + morph::listIds(wrong) + ". Correct or remove these cells.");
  }
}

void requireTypes(vtkUnstructuredGrid* grid, const std::string& subject)
{
  vtkDataArray* types = Version::CellTypes(grid);
  const vtkIdType count = types ? types->GetNumberOfValues() : 0;
  if (grid->GetNumberOfCells() < 0)
  {
    throw Error(subject + "'s cells have no offsets, not even the first 0. Write the cells again.");
  }
  if (count < grid->GetNumberOfCells())
  {
    throw Error(subject + " has " + std::to_string(count) + " cell types for " +
                std::to_string(grid->GetNumberOfCells()) + " cells. Give one for each.");
  }
}

/// The bounds of the finite points, and the points beyond LargestLength.
class Range
{
public:
  void Add(Index point, int axis, double value)
  {
    const double size = std::abs(value);
    if (size <= morph::LargestLength)
    {
      this->Low[axis] = std::min(this->Low[axis], value);
      this->High[axis] = std::max(this->High[axis], value);
    }
    else if (std::isfinite(value) && (this->Huge.empty() || this->Huge.back() != point))
    {
      this->Huge.push_back(point);
    }
  }
  const std::vector<Index>& Beyond() const { return this->Huge; }
  double LargestSide() const
  {
    double side = 0;
    for (int j = 0; j < 3; ++j)
    {
      side = std::max(side, this->High[j] - this->Low[j]);
    }
    return side;
  }

private:
  static constexpr double Infinity = std::numeric_limits<double>::infinity();
  double Low[3] = { Infinity, Infinity, Infinity };
  double High[3] = { -Infinity, -Infinity, -Infinity };
  std::vector<Index> Huge;
};

/// Whether all values are moderate, as nearly always. Then `range` has them, at a fraction of the
/// cost of one by one.
template <typename Value>
bool addModerate(const Value* values, vtkIdType points, Range& range)
{
  Value low[3], high[3];
  std::fill_n(low, 3, std::numeric_limits<Value>::infinity());
  std::fill_n(high, 3, -std::numeric_limits<Value>::infinity());
  bool isModerate = true;
  for (vtkIdType i = 0; i < points; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      const Value value = values[3 * i + j];
      isModerate &= std::abs(value) <= morph::LargestLength; // a NaN is not
      low[j] = std::min(low[j], value);
      high[j] = std::max(high[j], value);
    }
  }
  for (int j = 0; j < 3 && isModerate && points > 0; ++j)
  {
    range.Add(0, j, low[j]);
    range.Add(0, j, high[j]);
  }
  return isModerate;
}

template <typename Value>
void addValues(const Value* values, vtkIdType points, Range& range)
{
  if (addModerate(values, points, range))
  {
    return;
  }
  for (vtkIdType i = 0; i < points; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      range.Add(i, j, static_cast<double>(values[3 * i + j]));
    }
  }
}

void requirePoints(vtkDataArray* points, const std::string& subject)
{
  if (points->GetNumberOfComponents() != 3)
  {
    throw Error(subject + "'s points have " + std::to_string(points->GetNumberOfComponents()) +
                " coordinates; three are needed.");
  }
  Range range;
  const vtkIdType count = points->GetNumberOfTuples();
  if (auto* doubles = vtkDoubleArray::FastDownCast(points))
  {
    addValues(doubles->GetPointer(0), count, range);
  }
  else if (auto* floats = vtkFloatArray::FastDownCast(points))
  {
    addValues(floats->GetPointer(0), count, range);
  }
  else
  {
    for (vtkIdType i = 0; i < count; ++i)
    {
      for (int j = 0; j < 3; ++j)
      {
        range.Add(i, j, points->GetComponent(i, j));
      }
    }
  }
  if (!range.Beyond().empty())
  {
    throw Error(subject + " has coordinates above 1e50, at point ids " +
                morph::listIds(range.Beyond()) + ". Use another unit, or correct them.");
  }
  morph::requireExtent(range.LargestSide(), subject.c_str());
}
}

namespace DataCheck
{
void Require(vtkDataObject* data, const char* subject, Cells cells)
{
  auto* set = vtkPointSet::SafeDownCast(data);
  if (!set)
  {
    return;
  }
  auto* grid = vtkUnstructuredGrid::SafeDownCast(set);
  auto* surface = vtkPolyData::SafeDownCast(set);
  if (grid)
  {
    requireTypes(grid, subject);
  }
  RequireLengths(set, subject);
  if (grid && cells == Cells::Here)
  {
    requireCells(grid->GetCells(), 0, grid->GetNumberOfPoints(), subject);
  }
  if (surface)
  {
    vtkIdType first = 0;
    for (vtkCellArray* kind :
      { surface->GetVerts(), surface->GetLines(), surface->GetPolys(), surface->GetStrips() })
    {
      requireCells(kind, first, surface->GetNumberOfPoints(), subject);
      first += kind->GetNumberOfCells();
    }
  }
  if (set->GetPoints())
  {
    requirePoints(set->GetPoints()->GetData(), subject);
  }
}

void RequireLengths(vtkDataSet* data, const char* subject)
{
  requireLengths(data->GetPointData(), data->GetNumberOfPoints(), subject, "point");
  requireLengths(data->GetCellData(), data->GetNumberOfCells(), subject, "cell");
}

bool IsMissing(const Eigen::RowVector3d& value, vtkDataArray* mask, morph::Index point)
{
  return value.hasNaN() ||
         (mask && point < mask->GetNumberOfTuples() && mask->GetComponent(point, 0) == 0);
}
}
}
