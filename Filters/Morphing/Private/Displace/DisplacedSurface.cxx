// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/DisplacedSurface.h"

#include "Private/Data/Output.h"
#include "Private/Data/Surface.h"

#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSignedCharArray.h>

namespace morph::filters
{
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
  vtkDataArray* rest = output->GetPointData()->GetArray(Surface::RestName);
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

namespace DisplacedSurface
{
void Write(const BoundaryModel& model, const Surroundings::Result& result, vtkPointSet* input,
  int precision, vtkPolyData* output)
{
  Output::RequireWritable(
    model.Rest(), result.Moved, Output::IsFloat(input, precision), "the boundary's nodes");
  output->ShallowCopy(model.Surface());
  if (Output::IsFloat(input, precision))
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
}
