// SPDX-License-Identifier: BSD-3-Clause
#include "TestGrids.h"

#include "../Core/Motions.h"
#include "Mesh/Polyhedra.h"
#include "vtkDisplacementAlgorithm.h"
#include "vtkExtractMorphBoundary.h"

#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace grids
{
using morph::Index;
using morph::Points;

namespace
{
/// The number of faces, then for each its number of nodes and their ids.
vtkSmartPointer<vtkIdList> faceStream(const morph::Mesh& mesh, Index cell)
{
  auto stream = vtkSmartPointer<vtkIdList>::New();
  stream->InsertNextId(0);
  morph::forEachFace(mesh, cell,
    [&](const Index* nodes, Index size)
    {
      stream->SetId(0, stream->GetId(0) + 1);
      stream->InsertNextId(size);
      std::for_each(nodes, nodes + size, [&](Index node) { stream->InsertNextId(node); });
    });
  return stream;
}
}

vtkSmartPointer<vtkUnstructuredGrid> make(const morph::Mesh& mesh, int pointType)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataType(pointType);
  vtkNew<vtkIdTypeArray> number;
  number->SetName("Number");
  for (Index n = 0; n < mesh.numberOfNodes(); ++n)
  {
    points->InsertNextPoint(mesh.points.row(n).data());
    number->InsertNextValue(1000 + n);
  }
  grid->SetPoints(points);
  grid->GetPointData()->AddArray(number);

  vtkNew<vtkIdTypeArray> cell;
  cell->SetName("Cell");
  grid->Allocate(mesh.numberOfCells());
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    if (morph::isPolyhedron(mesh, c))
    {
      grid->InsertNextCell(VTK_POLYHEDRON, faceStream(mesh, c));
    }
    else
    {
      const std::vector<vtkIdType> nodes(mesh.cell(c), mesh.cell(c) + mesh.cellSize(c));
      grid->InsertNextCell(mesh.types[c], static_cast<vtkIdType>(nodes.size()), nodes.data());
    }
    cell->InsertNextValue(2000 + c);
  }
  grid->GetCellData()->AddArray(cell);
  return grid;
}

vtkSmartPointer<vtkUnstructuredGrid> hexes(int n)
{
  morph::Mesh mesh = meshes::hexes(n, n, n);
  meshes::jitterInterior(mesh, 0.15, meshes::seed());
  return make(mesh);
}

void moveBy(vtkDisplacementAlgorithm* filter, double x, double y, double z)
{
  filter->SetDisplacementToVector();
  filter->SetVector(x, y, z);
}

vtkSmartPointer<vtkUnstructuredGrid> copy(vtkUnstructuredGrid* grid)
{
  auto result = vtkSmartPointer<vtkUnstructuredGrid>::New();
  result->DeepCopy(grid);
  return result;
}

vtkSmartPointer<vtkPolyData> boundary(vtkUnstructuredGrid* grid, const Map& map)
{
  auto extract = of<vtkExtractMorphBoundary>(grid);
  extract->Update();
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->ShallowCopy(extract->GetOutput());
  result->SetPoints(cloud(mapped(points(result), map))->GetPoints());
  return result;
}

vtkSmartPointer<vtkPolyData> cloud(const Points& positions)
{
  auto result = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (Index n = 0; n < positions.rows(); ++n)
  {
    points->InsertNextPoint(positions.row(n).data());
  }
  result->SetPoints(points);
  return result;
}

void addIds(vtkDataSet* data, const char* name, const std::vector<Index>& ids)
{
  vtkNew<vtkIdTypeArray> array;
  array->SetName(name);
  for (Index id : ids)
  {
    array->InsertNextValue(id);
  }
  data->GetPointData()->AddArray(array);
}

void addVectors(vtkDataSet* data, const char* name, const Points& vectors)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(3);
  for (Index n = 0; n < vectors.rows(); ++n)
  {
    array->InsertNextTuple(vectors.row(n).data());
  }
  data->GetPointData()->AddArray(array);
}

void addNumbers(
  vtkDataSetAttributes* data, const char* name, vtkIdType tuples, double value, int components)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(tuples);
  array->Fill(value);
  data->AddArray(array);
}

void mark(vtkDataSet* data, const char* name, const std::function<bool(const Row&)>& is)
{
  vtkNew<vtkUnsignedCharArray> array;
  array->SetName(name);
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    array->InsertNextValue(is(Eigen::Map<const Row>(data->GetPoint(i))));
  }
  data->GetPointData()->AddArray(array);
}

void markCells(vtkDataSet* data, const char* name, const std::function<bool(const Row&)>& is)
{
  vtkNew<vtkUnsignedCharArray> array;
  array->SetName(name);
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
  {
    double b[6];
    data->GetCellBounds(c, b);
    array->InsertNextValue(is(Row(b[0] + b[1], b[2] + b[3], b[4] + b[5]) / 2));
  }
  data->GetCellData()->AddArray(array);
}

void addTexts(vtkDataSet* data, const char* name, const std::vector<std::string>& texts)
{
  vtkSmartPointer<vtkStringArray> array =
    vtkStringArray::SafeDownCast(data->GetFieldData()->GetAbstractArray(name));
  if (!array)
  {
    array = vtkSmartPointer<vtkStringArray>::New();
    array->SetName(name);
    data->GetFieldData()->AddArray(array);
  }
  for (const std::string& text : texts)
  {
    array->InsertNextValue(text);
  }
}

std::string errorOf(vtkAlgorithm* filter)
{
  const Run listener(filter);
  EXPECT_EQ(listener.Errors.size(), 1u);
  EXPECT_TRUE(listener.ExecutiveErrors.empty()) << listener.ExecutiveErrors[0];
  return listener.Errors.empty() ? std::string() : listener.Errors[0];
}

void expectError(vtkAlgorithm* filter, const std::string& part)
{
  const Run listener(filter);
  listener.ExpectError(part);
}

void expectWarning(vtkAlgorithm* filter, const std::string& part)
{
  const Run listener(filter);
  EXPECT_TRUE(listener.Errors.empty()) << listener.Errors[0];
  listener.ExpectWarning(part);
}

void update(vtkAlgorithm* filter)
{
  const Run listener(filter);
  EXPECT_TRUE(listener.Errors.empty()) << listener.Errors[0];
}

void updateQuietly(vtkAlgorithm* filter)
{
  const Listener listener(filter);
  update(filter);
  EXPECT_TRUE(listener.Warnings.empty()) << listener.Warnings[0];
}

Points points(vtkPointSet* data)
{
  Points result(data->GetNumberOfPoints(), 3);
  for (Index n = 0; n < result.rows(); ++n)
  {
    data->GetPoint(n, result.row(n).data());
  }
  return result;
}

Points mapped(const Points& points, const Map& map)
{
  return motions::mapped(points, map);
}

double field(vtkDataObject* data, const char* name)
{
  vtkDataArray* array = data->GetFieldData()->GetArray(name);
  EXPECT_TRUE(array && array->GetNumberOfTuples() == 1) << name;
  return array ? array->GetComponent(0, 0) : -1;
}

Row affine(const Row& x)
{
  Eigen::Matrix3d A;
  A << 1.4, 0.3, -0.1, -0.5, 0.9, 0.2, 0.1, 0.4, 1.1;
  return x * A.transpose() + Row(3, -7, 11);
}

Row twist(const Row& x)
{
  const double angle = 0.15 * x[2], c = std::cos(angle), s = std::sin(angle);
  return Row(
    c * x[0] - s * x[1] + 0.02 * x[1] * x[1], s * x[0] + c * x[1], x[2] + 0.05 * x[0] * x[0]);
}

namespace
{
void expectOne(const std::vector<std::string>& texts, const std::string& part)
{
  ASSERT_EQ(texts.size(), 1u) << "instead of one with " << part;
  EXPECT_NE(texts[0].find(part), std::string::npos) << part << " is not in " << texts[0];
}
}

struct Listener::Tags
{
  vtkSmartPointer<vtkAlgorithm> Filter;
  vtkNew<vtkCallbackCommand> Command;
  vtkNew<vtkCallbackCommand> ExecutiveCommand;
};

Listener::Listener(vtkAlgorithm* filter)
  : Observers(new Tags)
{
  this->Observers->Filter = filter;
  this->Observers->Command->SetClientData(this);
  this->Observers->Command->SetCallback(
    [](vtkObject*, unsigned long event, void* self, void* text)
    {
      auto* listener = static_cast<Listener*>(self);
      (event == vtkCommand::ErrorEvent ? listener->Errors : listener->Warnings)
        .emplace_back(static_cast<const char*>(text));
    });
  this->Observers->ExecutiveCommand->SetClientData(this);
  this->Observers->ExecutiveCommand->SetCallback(
    [](vtkObject*, unsigned long, void* self, void* text) {
      static_cast<Listener*>(self)->ExecutiveErrors.emplace_back(static_cast<const char*>(text));
    });
  filter->AddObserver(vtkCommand::ErrorEvent, this->Observers->Command);
  filter->AddObserver(vtkCommand::WarningEvent, this->Observers->Command);
  filter->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, this->Observers->ExecutiveCommand);
}

void Listener::ExpectError(const std::string& part) const
{
  expectOne(this->Errors, part);
}

void Listener::ExpectWarning(const std::string& part) const
{
  expectOne(this->Warnings, part);
}

Listener::~Listener()
{
  this->Observers->Filter->RemoveObserver(this->Observers->Command);
  this->Observers->Filter->GetExecutive()->RemoveObserver(this->Observers->ExecutiveCommand);
  delete this->Observers;
}

Run::Run(vtkAlgorithm* filter)
  : Listener(filter)
{
  filter->Update();
}
}
