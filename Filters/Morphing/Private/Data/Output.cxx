// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Data/Output.h"

#include "Private/Data/DataCheck.h"
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
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <limits>
#include <string>

namespace morph::filters
{
namespace
{
template <typename Array, typename Value>
void writePoints(const morph::Points& rest, const morph::Points& moved, vtkUnstructuredGrid* output)
{
  using Written = Eigen::Map<Eigen::Matrix<Value, Eigen::Dynamic, 3, Eigen::RowMajor>>;
  const auto make = [&moved](const char* name)
  {
    auto array = vtkSmartPointer<Array>::New();
    array->SetName(name);
    array->SetNumberOfComponents(3);
    array->SetNumberOfTuples(moved.rows());
    return array;
  };
  auto coordinates = make("Points");
  Written written(coordinates->GetPointer(0), moved.rows(), 3);
  written = moved.cast<Value>();
  vtkNew<vtkPoints> points;
  points->SetData(coordinates);
  output->SetPoints(points);

  auto displacement = make("MorphDisplacement");
  Written(displacement->GetPointer(0), moved.rows(), 3) =
    (written.template cast<double>() - rest).template cast<Value>();
  output->GetPointData()->AddArray(displacement);
  output->GetPointData()->SetActiveVectors("MorphDisplacement");
}

template <typename Array, typename Value>
void addField(vtkDataObject* output, const char* name, Value value)
{
  vtkNew<Array> array;
  array->SetName(name);
  array->InsertNextValue(value);
  output->GetFieldData()->AddArray(array);
}
}

namespace Output
{
void Write(vtkUnstructuredGrid* input, const morph::Points& rest, const morph::Points& moved,
  int precision, vtkUnstructuredGrid* output)
{
  RequireWritable(rest, moved, IsFloat(input, precision), "nodes");
  output->ShallowCopy(input);
  if (IsFloat(input, precision))
  {
    writePoints<vtkFloatArray, float>(rest, moved, output);
  }
  else
  {
    writePoints<vtkDoubleArray, double>(rest, moved, output);
  }
}

void RequireWritable(
  const morph::Points& rest, const morph::Points& moved, bool isFloat, const char* what)
{
  if (const auto wrong = DataCheck::Immoderate(moved); !wrong.empty())
  {
    throw morph::Error(std::string("The motion takes ") + what +
                       " to places that are not finite or beyond 1e50: node ids " +
                       morph::listIds(wrong) + ". Move the boundary less.");
  }
  std::vector<morph::Index> tooLarge;
  for (morph::Index n = 0; isFloat && n < moved.rows(); ++n)
  {
    if (std::max(moved.row(n).array().abs().maxCoeff(),
          (moved.row(n) - rest.row(n)).array().abs().maxCoeff()) >
        std::numeric_limits<float>::max())
    {
      tooLarge.push_back(n);
    }
  }
  if (!tooLarge.empty())
  {
    throw morph::Error(std::string("Single precision does not hold the new positions of ") + what +
                       ", which are above 3.4e38: node ids " + morph::listIds(tooLarge) +
                       ". Set OutputPointsPrecision to double.");
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
