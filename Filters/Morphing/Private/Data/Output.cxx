// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/Output.h"

#include "Mesh/Mesh.h"
#include "Private/Data/Arrays.h"
#include "Private/Data/Directions.h"
#include "Support/Error.h"

#include <vtkAlgorithm.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <type_traits>

namespace morph::filters
{
namespace
{
constexpr morph::Index Grain = 4096;

/// The points as written and minus `rest`, and whether all of these and those are writable.
template <typename Array>
struct Written
{
  vtkSmartPointer<Array> Coordinates, Displacement;
  bool IsWritable;

  static Written Make(
    const morph::Points& rest, const morph::Points& moved, morph::Monitor& monitor)
  {
    Written written = { Arrays::Make<Array>("Points", moved.rows(), 3),
      Arrays::Make<Array>("MorphDisplacement", moved.rows(), 3), true };
    auto *to = written.Coordinates->GetPointer(0), *by = written.Displacement->GetPointer(0);
    using Value = std::remove_pointer_t<decltype(to)>;
    const double most =
      std::min(morph::LargestLength, static_cast<double>(std::numeric_limits<Value>::max()));
    std::atomic<bool> isWritable = true;
    monitor.parallelFor(moved.rows(), Grain,
      [&](morph::Index first, morph::Index last)
      {
        const double *from = rest.data(), *x = moved.data();
        bool isModerate = true;
        for (morph::Index i = 3 * first; i < 3 * last; ++i)
        {
          isModerate &= std::abs(x[i]) <= most; // a NaN is not
          isModerate &= std::is_same_v<Value, double> || !(std::abs(x[i] - from[i]) > most);
        }
        if (!isModerate)
        {
          isWritable = false;
        }
        for (morph::Index i = 3 * first; i < 3 * last; ++i)
        {
          to[i] = static_cast<Value>(x[i]);
          const double difference = static_cast<double>(to[i]) - from[i];
          by[i] = static_cast<Value>(std::isnan(difference) ? 0 : difference); // stayed at NaN
        }
      });
    written.IsWritable = isWritable;
    return written;
  }
};

template <typename Array>
void writePoints(vtkUnstructuredGrid* input, const morph::Points& rest, const morph::Points& moved,
  vtkUnstructuredGrid* output, morph::Monitor& monitor)
{
  const auto written = Written<Array>::Make(rest, moved, monitor);
  if (!written.IsWritable)
  {
    Output::RequireWritable(rest, moved, std::is_same_v<Array, vtkFloatArray>, "nodes");
  }
  output->ShallowCopy(input);
  vtkNew<vtkPoints> points;
  points->SetData(written.Coordinates);
  output->SetPoints(points);
  Directions::RemoveNormals(output);
  Arrays::Add(written.Displacement, output->GetPointData());
  output->GetPointData()->SetActiveVectors("MorphDisplacement");
}

template <typename Array, typename Value>
void addField(vtkDataObject* output, const char* name, Value value)
{
  auto array = Arrays::Make<Array>(name);
  array->InsertNextValue(value);
  output->GetFieldData()->AddArray(array);
}
}

namespace Output
{
void Write(vtkUnstructuredGrid* input, const morph::Points& rest, const morph::Points& moved,
  int precision, vtkUnstructuredGrid* output, morph::Monitor& monitor)
{
  (IsFloat(input, precision) ? writePoints<vtkFloatArray> : writePoints<vtkDoubleArray>)(input,
    rest, moved, output, monitor);
  Directions::Warn(input, rest, moved, monitor);
}

void RequireWritable(const morph::Points& rest, const morph::Points& moved, bool isFloat,
  const char* what, const std::vector<morph::Index>* ids)
{
  const auto list = [ids](std::vector<morph::Index> rows)
  {
    for (morph::Index& row : rows)
    {
      row = ids ? (*ids)[row] : row;
    }
    return morph::listIds(rows);
  };
  // Points of no cell may be anything, and stay so.
  const auto wasFinite = [&rest](morph::Index n) { return rest.row(n).allFinite(); };
  std::vector<morph::Index> wrong = morph::immoderateRows(moved);
  wrong.erase(std::remove_if(wrong.begin(), wrong.end(), std::not_fn(wasFinite)), wrong.end());
  if (!wrong.empty())
  {
    throw morph::Error(std::string("The motion takes ") + what +
                       " to places that are not finite or beyond 1e50: node ids " + list(wrong) +
                       ". Move the boundary less.");
  }
  std::vector<morph::Index> tooLarge;
  for (morph::Index n = 0; isFloat && n < moved.rows(); ++n)
  {
    if (wasFinite(n) && std::max(moved.row(n).array().abs().maxCoeff(),
                          (moved.row(n) - rest.row(n)).array().abs().maxCoeff()) >
                          std::numeric_limits<float>::max())
    {
      tooLarge.push_back(n);
    }
  }
  if (!tooLarge.empty())
  {
    throw morph::Error(std::string("Single precision does not hold the new positions of ") + what +
                       ", which are above 3.4e38: node ids " + list(tooLarge) +
                       ". Set `OutputPointsPrecision` to double.");
  }
}

bool IsFloat(vtkPointSet* input, int precision)
{
  return precision == vtkAlgorithm::SINGLE_PRECISION ||
         (precision == vtkAlgorithm::DEFAULT_PRECISION && input->GetPoints() &&
           input->GetPoints()->GetDataType() == VTK_FLOAT);
}

void AddField(vtkDataObject* output, const char* name, double value)
{
  addField<vtkDoubleArray>(output, name, value);
}

void AddField(vtkDataObject* output, const char* name, int value)
{
  addField<vtkIntArray>(output, name, value);
}

void AddField(vtkDataObject* output, const char* name, vtkIdType value)
{
  addField<vtkIdTypeArray>(output, name, value);
}

void AddField(vtkDataObject* output, const char* name, const char* value)
{
  addField<vtkStringArray>(output, name, value);
}
}
}
