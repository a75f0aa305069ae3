// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/SurfaceGrid.h"

#include "Private/Data/Geometry.h"
#include "Private/Data/Surface.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

namespace morph::filters
{
namespace
{
int typeOf(vtkIdType corners)
{
  return corners == 3 ? VTK_TRIANGLE : corners == 4 ? VTK_QUAD : VTK_POLYGON;
}

/// The number of each face's surface as active scalars of `output`.
void addNumbers(vtkPolyData* boundary, vtkDataSet* output)
{
  if (vtkDataArray* surfaces = boundary->GetCellData()->GetArray(Geometry::IdName))
  {
    auto named = vtkSmartPointer<vtkDataArray>::Take(surfaces->NewInstance());
    named->DeepCopy(surfaces);
    named->SetName(SurfaceGrid::SurfaceName);
    output->GetCellData()->AddArray(named);
    output->GetCellData()->SetActiveScalars(SurfaceGrid::SurfaceName);
  }
}
}

void SurfaceGrid::Write(
  vtkUnstructuredGrid* grid, vtkPolyData* boundary, vtkUnstructuredGrid* output)
{
  output->Initialize();
  output->SetPoints(grid->GetPoints());
  output->GetPointData()->ShallowCopy(grid->GetPointData());
  output->GetFieldData()->ShallowCopy(grid->GetFieldData());
  vtkDataArray* ids = boundary->GetPointData()->GetArray(Surface::IdName);
  output->AllocateExact(boundary->GetNumberOfPolys(), 4 * boundary->GetNumberOfPolys());
  vtkNew<vtkIdList> corners;
  vtkCellArray* faces = boundary->GetPolys();
  for (vtkIdType face = 0; face < faces->GetNumberOfCells(); ++face)
  {
    faces->GetCellAtId(face, corners);
    for (vtkIdType i = 0; i < corners->GetNumberOfIds(); ++i)
    {
      corners->SetId(i, static_cast<vtkIdType>(ids->GetComponent(corners->GetId(i), 0)));
    }
    output->InsertNextCell(typeOf(corners->GetNumberOfIds()), corners);
  }
  output->GetCellData()->AddArray(boundary->GetCellData()->GetArray("MorphCellId"));
  addNumbers(boundary, output);
}

void SurfaceGrid::Write(vtkPolyData* boundary, vtkPolyData* output)
{
  output->ShallowCopy(boundary);
  addNumbers(boundary, output);
}
}
