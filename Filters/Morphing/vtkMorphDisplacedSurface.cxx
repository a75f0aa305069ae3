// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMorphDisplacedSurface.h"

#include "vtkMorphBoundaryMatch.h"
#include "vtkMorphOutput.h"

#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSignedCharArray.h>

namespace
{
using morph::Index;

template <typename Array, typename Value>
void writePoints(const std::vector<Index>& nodes, const morph::Points& moved, vtkPolyData* output)
{
  const auto make = [&](const char* name)
  {
    auto array = vtkSmartPointer<Array>::New();
    array->SetName(name);
    array->SetNumberOfComponents(3);
    array->SetNumberOfTuples(static_cast<vtkIdType>(nodes.size()));
    return array;
  };
  auto coordinates = make("Points");
  auto displacement = make("BoundaryDisplacement");
  vtkDataArray* rest = output->GetPointData()->GetArray(vtkMorphBoundaryMatch::RestName);
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      const vtkIdType k = static_cast<vtkIdType>(i);
      const Value written = static_cast<Value>(moved(nodes[i], j));
      coordinates->SetTypedComponent(k, j, written);
      displacement->SetTypedComponent(
        k, j, static_cast<Value>(static_cast<double>(written) - rest->GetComponent(k, j)));
    }
  }
  vtkNew<vtkPoints> points;
  points->SetData(coordinates);
  output->SetPoints(points);
  output->GetPointData()->AddArray(displacement);
  output->GetPointData()->SetActiveVectors("BoundaryDisplacement");
}
}

namespace vtkMorphDisplacedSurface
{
void Write(const vtkMorphBoundaryModel& model, const vtkMorphSpread::Result& result,
  vtkPointSet* input, int precision, vtkPolyData* output)
{
  vtkMorphOutput::RequireWritable(model.Rest(), result.Moved,
    vtkMorphOutput::IsFloat(input, precision), "the boundary's nodes");
  output->ShallowCopy(model.Surface());
  if (vtkMorphOutput::IsFloat(input, precision))
  {
    writePoints<vtkFloatArray, float>(model.NodeOfPoint(), result.Moved, output);
  }
  else
  {
    writePoints<vtkDoubleArray, double>(model.NodeOfPoint(), result.Moved, output);
  }
  vtkNew<vtkSignedCharArray> roles;
  roles->SetName("Role");
  for (Index node : model.NodeOfPoint())
  {
    roles->InsertNextValue(result.Roles[node]);
  }
  output->GetPointData()->AddArray(roles);
  output->GetPointData()->SetActiveScalars("Role");
}
}
