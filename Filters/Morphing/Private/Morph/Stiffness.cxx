// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Morph/Stiffness.h"

#include "Private/Data/Surface.h"
#include "Private/Pipeline/Input.h"
#include "Support/Error.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkUnstructuredGrid.h>

namespace morph::filters::Stiffness
{
namespace
{
/// An array of one number a point or cell.
vtkDataArray* require(
  vtkDataSetAttributes* data, const std::string& name, vtkIdType count, const char* property)
{
  vtkDataArray* array = data->GetArray(name.c_str());
  if (!array || array->GetNumberOfTuples() != count || array->GetNumberOfComponents() != 1)
  {
    throw morph::Error(
      "`" + std::string(property) + "` names '" + name + "', which is " +
      (array ? "not as long as the mesh, or has more than one component."
             : (std::string(property) == "WallArray" ? "no point array of the mesh."
                                                     : "no cell array of the mesh.")));
  }
  return array;
}

/// The nodes that a displaced boundary moves, as its filter says; none where it does not. On MPI
/// ranks these are global ids, of any number.
std::vector<morph::Index> movingNodes(vtkDataObject* boundary)
{
  std::vector<morph::Index> moving;
  auto* points = vtkPointSet::SafeDownCast(boundary);
  vtkDataArray* ids = points ? points->GetPointData()->GetArray(Surface::IdName) : nullptr;
  vtkDataArray* roles = points ? points->GetPointData()->GetArray("Role") : nullptr;
  for (vtkIdType i = 0; ids && roles && i < points->GetNumberOfPoints(); ++i)
  {
    const double id = ids->GetComponent(i, 0);
    if (roles->GetComponent(i, 0) == 1 && id >= 0)
    {
      moving.push_back(static_cast<morph::Index>(id));
    }
  }
  return moving;
}
}

morph::CellStiffness Take(const Options& options, vtkUnstructuredGrid* rest,
  vtkDataObject* boundary, const std::vector<double>& factors)
{
  morph::CellStiffness stiffness;
  stiffness.kind = static_cast<morph::CellStiffness::Kind>(options.Stiffness);
  stiffness.exponent = options.StiffnessExponent;
  stiffness.values = factors;
  const vtkIdType cells = rest->GetNumberOfCells(), nodes = rest->GetNumberOfPoints();
  const std::string& name = options.StiffnessArray;
  if (cells > 0 && !name.empty()) // a rank without cells has no arrays
  {
    vtkDataArray* array = require(rest->GetCellData(), name, cells, "StiffnessArray");
    stiffness.values.resize(cells, 1);
    for (vtkIdType c = 0; c < cells; ++c)
    {
      stiffness.values[c] *= array->GetComponent(c, 0);
    }
  }
  if (stiffness.kind != morph::CellStiffness::Kind::WallDistance)
  {
    return stiffness;
  }
  const std::string& walls = options.WallArray;
  if (walls.empty())
  {
    stiffness.walls = movingNodes(boundary);
    return stiffness;
  }
  stiffness.areWallsGlobal = false;
  stiffness.noWalls = "`WallArray` names '" + walls + "', which is zero at all nodes.";
  if (cells > 0)
  {
    vtkDataArray* marks = require(rest->GetPointData(), walls, nodes, "WallArray");
    for (vtkIdType i = 0; i < nodes; ++i)
    {
      if (marks->GetComponent(i, 0) < 0 || marks->GetComponent(i, 0) > 0)
      {
        stiffness.walls.push_back(i);
      }
    }
  }
  return stiffness;
}
}
