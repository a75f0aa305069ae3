// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMorphQuality.h"

#include "vtkMorphMesh.h"

#include <vtkCellData.h>
#include <vtkDataSetAttributes.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <utility>

namespace
{
template <typename Array, typename Value>
void addField(vtkFieldData* fields, const char* name, Value value)
{
  vtkNew<Array> array;
  array->SetName(name);
  array->InsertNextValue(value);
  fields->AddArray(array);
}
}

namespace vtkMorphQuality
{
morph::Quality Measure(const morph::Mesh& mesh, vtkUnstructuredGrid* output,
  const std::vector<std::int8_t>& orientation, morph::Monitor& monitor)
{
  return Measure(mesh, output, orientation, {}, monitor);
}

morph::Quality Measure(const morph::Mesh& mesh, vtkUnstructuredGrid* output,
  const std::vector<std::int8_t>& orientation, std::vector<std::uint8_t> skip,
  morph::Monitor& monitor)
{
  auto* ghosts = vtkUnsignedCharArray::SafeDownCast(
    output->GetCellData()->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()));
  if (ghosts)
  {
    skip.resize(mesh.numberOfCells(), 0);
    for (morph::Index c = 0; c < mesh.numberOfCells(); ++c)
    {
      skip[c] |= ghosts->GetValue(c) &
                 (vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL);
    }
  }
  vtkPoints* points = output->GetPoints();
  if (auto* doubles = points ? vtkDoubleArray::FastDownCast(points->GetData()) : nullptr)
  {
    const Eigen::Map<const morph::Points> written(
      doubles->GetPointer(0), doubles->GetNumberOfTuples(), 3);
    return morph::measureQuality(mesh, written, orientation, skip, monitor);
  }
  return morph::measureQuality(mesh, vtkMorphMesh::FromPoints(points), orientation, skip, monitor);
}

void Write(const morph::Quality& quality, vtkUnstructuredGrid* output)
{
  vtkNew<vtkDoubleArray> values;
  values->SetName("ScaledJacobian");
  values->SetNumberOfValues(static_cast<vtkIdType>(quality.scaledJacobian.size()));
  std::copy(quality.scaledJacobian.begin(), quality.scaledJacobian.end(), values->GetPointer(0));
  output->GetCellData()->AddArray(values);
  output->GetCellData()->SetActiveScalars("ScaledJacobian");
  // Viewers prefer active point scalars to active cell scalars.
  output->GetPointData()->SetActiveScalars(nullptr);

  vtkFieldData* fields = output->GetFieldData();
  addField<vtkDoubleArray>(fields, "MinScaledJacobian", quality.minimum);
  addField<vtkDoubleArray>(fields, "MeanScaledJacobian", quality.mean);
  addField<vtkIdTypeArray>(fields, "InvertedCells", quality.inverted);
  addField<vtkIdTypeArray>(fields, "DegenerateCells", quality.degenerate);
  addField<vtkIdTypeArray>(fields, "WorstCellId", quality.worstCell);
}
}
