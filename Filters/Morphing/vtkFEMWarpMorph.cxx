// SPDX-License-Identifier: BSD-3-Clause
#include "vtkFEMWarpMorph.h"

#include "LinearMethods/FemWarp.h"
#include "Private/Data/Surface.h"
#include "Private/Options.h"
#include "Private/Pipeline/Input.h"
#include "Support/Error.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkUnstructuredGrid.h>

#include <utility>

namespace filters = morph::filters;

namespace
{
using Indices = std::vector<morph::Index>;

/// An array of one number a point or cell.
vtkDataArray* require(
  vtkDataSetAttributes* data, const std::string& name, vtkIdType count, const char* property)
{
  vtkDataArray* array = data->GetArray(name.c_str());
  if (!array || array->GetNumberOfTuples() != count || array->GetNumberOfComponents() != 1)
  {
    throw morph::Error(
      std::string(property) + " names '" + name + "', which is " +
      (array ? "not as long as the mesh, or has more than one component."
             : (std::string(property) == "WallArray" ? "no point array of the mesh."
                                                     : "no cell array of the mesh.")));
  }
  return array;
}

/// The nodes that a displaced boundary moves, as its filter says; none where it does not. On MPI
/// ranks these are global ids, of any number.
Indices movingNodes(vtkDataObject* boundary)
{
  Indices moving;
  auto* points = vtkPointSet::SafeDownCast(boundary);
  vtkDataArray* ids = points ? points->GetPointData()->GetArray(filters::Surface::IdName) : nullptr;
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

void multiply(vtkDataArray* by, vtkIdType cells, std::vector<double>& values)
{
  if (by->GetNumberOfTuples() != cells || by->GetNumberOfComponents() != 1)
  {
    throw morph::Error("The values of the stiffness are not as many as the mesh has cells.");
  }
  values.resize(cells, 1);
  for (vtkIdType c = 0; c < cells; ++c)
  {
    values[c] *= by->GetComponent(c, 0);
  }
}
}

vtkStandardNewMacro(vtkFEMWarpMorph);

vtkFEMWarpMorph::vtkFEMWarpMorph()
  : Taken(std::make_unique<morph::CellStiffness>())
  , Options(std::make_unique<morph::FEMWarpMorphOptions>())
{
}

vtkFEMWarpMorph::~vtkFEMWarpMorph() = default;

void vtkFEMWarpMorph::SetStiffnessValues(vtkDataArray* values)
{
  if (this->StiffnessValues != values)
  {
    this->StiffnessValues = values;
    this->Modified();
  }
}

void vtkFEMWarpMorph::TakeInputs(vtkUnstructuredGrid* rest, vtkDataObject* boundary)
{
  morph::CellStiffness next;
  next.kind = static_cast<morph::CellStiffness::Kind>(this->Options->Stiffness);
  next.exponent = this->Options->StiffnessExponent;
  const vtkIdType cells = rest->GetNumberOfCells(), nodes = rest->GetNumberOfPoints();
  const std::string name = filters::Input::ArrayName(this->Options->StiffnessArray);
  if (cells > 0 && !name.empty()) // a rank without cells has no arrays
  {
    multiply(require(rest->GetCellData(), name, cells, "StiffnessArray"), cells, next.values);
  }
  if (this->StiffnessValues)
  {
    multiply(this->StiffnessValues, cells, next.values);
  }
  if (this->Options->Stiffness == STIFFNESS_WALL_DISTANCE)
  {
    const std::string walls = filters::Input::ArrayName(this->Options->WallArray);
    if (walls.empty())
    {
      next.walls = movingNodes(boundary);
    }
    else
    {
      next.areWallsGlobal = false;
      next.noWalls = "WallArray names '" + walls + "', which is zero at all nodes.";
    }
    if (!walls.empty() && cells > 0)
    {
      vtkDataArray* marks = require(rest->GetPointData(), walls, nodes, "WallArray");
      for (vtkIdType i = 0; i < nodes; ++i)
      {
        if (marks->GetComponent(i, 0) < 0 || marks->GetComponent(i, 0) > 0)
        {
          next.walls.push_back(i);
        }
      }
    }
  }
  *this->Taken = std::move(next);
}

std::unique_ptr<morph::Morpher> vtkFEMWarpMorph::CreateMorpher()
{
  auto morpher = std::make_unique<morph::FemWarp>();
  morpher->setStiffness(*this->Taken);
  morpher->setTolerance(this->Options->Tolerance);
  return morpher;
}

void vtkFEMWarpMorph::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  this->PrintOptions(os, indent);
  os << indent << "StiffnessValues: " << this->StiffnessValues.Get() << "\n";
}
