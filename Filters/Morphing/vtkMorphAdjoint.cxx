// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMorphAdjoint.h"

#include "Mesh/Mesh.h"
#include "Private/Data/Arrays.h"
#include "Private/Data/GridMesh.h"
#include "Private/Options.h"
#include "Private/Pipeline/Input.h"
#include "Private/Pipeline/Monitor.h"
#include "Private/Pipeline/Ports.h"
#include "Private/Pipeline/Ranks.h"
#include "Support/Error.h"
#include "vtkMorphAlgorithm.h"
#include "vtkMorphShapes.h"

#include <vtkAlgorithmOutput.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <string>
#include <vector>

namespace filters = morph::filters;

vtkStandardNewMacro(vtkMorphAdjoint);

class vtkMorphAdjoint::vtkInternals
{
public:
  filters::Ports Ports;
};

namespace
{
/// The first vtkMorphAlgorithm or vtkMorphShapes upstream, from `algorithm` on and level by level;
/// null where there is none.
vtkAlgorithm* nearestMorph(vtkAlgorithm* algorithm)
{
  std::vector<vtkAlgorithm*> found;
  const auto add = [&](vtkAlgorithm* next)
  {
    if (next && std::find(found.begin(), found.end(), next) == found.end())
    {
      found.push_back(next);
    }
  };
  add(algorithm);
  for (std::size_t i = 0; i < found.size(); ++i)
  {
    if (vtkMorphAlgorithm::SafeDownCast(found[i]) || vtkMorphShapes::SafeDownCast(found[i]))
    {
      return found[i];
    }
    for (int port = 0; port < found[i]->GetNumberOfInputPorts(); ++port)
    {
      for (int c = 0; c < found[i]->GetNumberOfInputConnections(port); ++c)
      {
        add(found[i]->GetInputAlgorithm(port, c));
      }
    }
  }
  return nullptr;
}

vtkDataArray* requireGradient(vtkPointSet* carrier, const std::string& name)
{
  if (name.empty())
  {
    throw morph::Error(
      "`GradientArray` is not set: name the point array that holds the derivatives of the "
      "objective with respect to the nodes.");
  }
  vtkDataArray* array = carrier->GetPointData()->GetArray(name.c_str());
  if (!array)
  {
    throw morph::Error("`GradientArray` names '" + name +
                       "', which is no numeric point array of the gradient's " +
                       "data set. Give it on port 2, or with the mesh on port 0.");
  }
  return array;
}
}

vtkMorphAdjoint::vtkMorphAdjoint()
  : Internals(new vtkInternals{ filters::Ports(this) })
  , Options(std::make_unique<morph::MorphAdjointOptions>())
{
  this->SetNumberOfInputPorts(3);
}

vtkMorphAdjoint::~vtkMorphAdjoint() = default;

void vtkMorphAdjoint::SetBoundaryConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkMorphAdjoint::SetBoundaryData(vtkDataObject* boundary)
{
  this->SetInputDataObject(1, boundary);
}

void vtkMorphAdjoint::SetGradientConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(2, output);
}

void vtkMorphAdjoint::SetGradientData(vtkDataObject* gradient)
{
  this->SetInputDataObject(2, gradient);
}

void vtkMorphAdjoint::SetMorph(vtkMorphAlgorithm* morph)
{
  if (this->Morph != morph)
  {
    this->Morph = morph;
    this->Modified();
  }
}

vtkMorphAlgorithm* vtkMorphAdjoint::GetMorph()
{
  return this->Morph;
}

void vtkMorphAdjoint::SetMorphShapes(vtkMorphShapes* shapes)
{
  if (this->MorphShapes != shapes)
  {
    this->MorphShapes = shapes;
    this->Modified();
  }
}

vtkMorphShapes* vtkMorphAdjoint::GetMorphShapes()
{
  return this->MorphShapes;
}

vtkMTimeType vtkMorphAdjoint::GetMTime()
{
  const vtkMTimeType own = this->Superclass::GetMTime();
  const vtkMTimeType ofMorph = this->Morph ? std::max(own, this->Morph->GetMTime()) : own;
  return this->MorphShapes ? std::max(ofMorph, this->MorphShapes->GetMTime()) : ofMorph;
}

int vtkMorphAdjoint::FillInputPortInformation(int port, vtkInformation* info)
{
  return filters::Ports::FillInformation(port, info);
}

vtkTypeBool vtkMorphAdjoint::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  if (request->Has(vtkDemandDrivenPipeline::REQUEST_INFORMATION()))
  {
    filters::Ports::RequestInformation(inputVector, outputVector);
    // If the boundary does not vary in time, the gradient may, with the steps of its morph.
    vtkInformation* output = outputVector->GetInformationObject(0);
    vtkInformation* gradient = inputVector[2]->GetInformationObject(0);
    if (gradient && !output->Has(vtkStreamingDemandDrivenPipeline::TIME_RANGE()))
    {
      filters::Time::CopySteps(gradient, output);
    }
    return 1;
  }
  if (request->Has(vtkStreamingDemandDrivenPipeline::REQUEST_UPDATE_EXTENT()))
  {
    vtkMorphAlgorithm* morph = this->FindMorph();
    return this->Internals->Ports.RequestUpdateExtent(morph ? morph->GetRestTime() : 0,
      filters::Ports::AskedTime(outputVector->GetInformationObject(0)), inputVector);
  }
  return this->Superclass::ProcessRequest(request, inputVector, outputVector);
}

int vtkMorphAdjoint::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkPointSet* boundary = vtkPointSet::GetData(inputVector[1]);
  vtkDataObject* output = vtkDataObject::GetData(outputVector);
  const int type = boundary ? boundary->GetDataObjectType() : VTK_POLY_DATA;
  if (!output || output->GetDataObjectType() != type)
  {
    const auto fresh = boundary ? vtkSmartPointer<vtkDataObject>::Take(boundary->NewInstance())
                                : vtkSmartPointer<vtkDataObject>(vtkNew<vtkPolyData>());
    outputVector->GetInformationObject(0)->Set(vtkDataObject::DATA_OBJECT(), fresh);
  }
  return 1;
}

int vtkMorphAdjoint::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkMorphAlgorithm* morph = this->FindMorph();
  vtkMorphShapes* shapes = this->FindShapes();
  vtkDataObject* carrier = vtkDataObject::GetData(inputVector[2]);
  vtkPointSet* output = vtkPointSet::GetData(outputVector);
  const filters::Ports::Task task = { "apply the adjoint", morph ? morph->GetNumberOfThreads() : 0,
    morph    ? morph->GetCoincidentPoints()
    : shapes ? shapes->GetCoincidentPoints()
             : 0,
    [] {},
    [&](vtkUnstructuredGrid* rest, vtkDataObject* boundary, bool isDistributed,
      filters::Monitor& monitor)
    {
      vtkDataObject* holder = carrier ? carrier : rest;
      if (carrier && !isDistributed)
      {
        const std::string& name = this->Options->GradientArray;
        holder = this->Internals->Ports.AsOne(carrier, "The gradient's data set", name.c_str());
      }
      if (shapes)
      {
        this->ExecuteShapes(shapes, rest, holder, output, isDistributed, monitor);
      }
      else
      {
        this->Execute(morph, rest, boundary, holder, output, isDistributed, monitor);
      }
    } };
  return this->Internals->Ports.RequestData(task, inputVector, outputVector);
}

vtkMorphAlgorithm* vtkMorphAdjoint::FindMorph()
{
  return this->Morph ? this->Morph.Get()
                     : vtkMorphAlgorithm::SafeDownCast(nearestMorph(this->GetInputAlgorithm(2, 0)));
}

vtkMorphShapes* vtkMorphAdjoint::FindShapes()
{
  if (this->MorphShapes || this->Morph)
  {
    return this->MorphShapes;
  }
  return vtkMorphShapes::SafeDownCast(nearestMorph(this->GetInputAlgorithm(2, 0)));
}

void vtkMorphAdjoint::ExecuteShapes(vtkMorphShapes* shapes, vtkUnstructuredGrid* rest,
  vtkDataObject* carrier, vtkPointSet* output, bool onRanks, morph::Monitor& monitor)
{
  // The mesh was checked before.
  vtkDataArray* gradient = nullptr;
  const auto check = [&]
  {
    vtkPointSet* holder =
      carrier == rest ? rest : filters::Input::RequirePointSet(carrier, "The gradient's data set");
    if (!onRanks || rest->GetNumberOfPoints() > 0) // a rank without points has no arrays
    {
      gradient = requireGradient(holder, this->Options->GradientArray);
    }
  };
  filters::RankGroup(onRanks).Together(check);
  auto derivatives = filters::Arrays::Make<vtkDoubleArray>("ShapeGradient");
  shapes->Differentiate(gradient, derivatives, monitor);
  auto names = filters::Arrays::Make<vtkStringArray>("ShapeNames");
  for (vtkIdType i = 0; i < derivatives->GetNumberOfValues(); ++i)
  {
    names->InsertNextValue(shapes->GetShapeName(static_cast<int>(i)));
  }
  output->GetFieldData()->AddArray(names);
  output->GetFieldData()->AddArray(derivatives);
}

void vtkMorphAdjoint::Execute(vtkMorphAlgorithm* morph, vtkUnstructuredGrid* rest,
  vtkDataObject* boundary, vtkDataObject* carrier, vtkPointSet* output, bool onRanks,
  morph::Monitor& monitor)
{
  vtkPointSet* points = nullptr;
  vtkDataArray* gradient = nullptr;
  const auto check = [&]
  {
    if (!morph)
    {
      throw morph::Error("There is no method: set Morph to the filter that morphs the mesh, or "
                         "give the gradient on port 2 by a pipeline with that filter in it.");
    }
    points = filters::Input::RequireBoundary(boundary);
    // The mesh was checked before.
    vtkPointSet* holder =
      carrier == rest ? rest : filters::Input::RequirePointSet(carrier, "The gradient's data set");
    if (!onRanks || rest->GetNumberOfPoints() > 0) // a rank without points has no arrays
    {
      gradient = requireGradient(holder, this->Options->GradientArray);
    }
    // With a DisplacementArray the method does not use the points, but the output has them.
    if (const auto wrong =
          morph::immoderateRows(filters::GridMesh::FromPoints(points->GetPoints()));
        !wrong.empty())
    {
      throw morph::Error(
        "The boundary has coordinates that are not finite (NaN or infinite), at its points " +
        morph::listIds(wrong) + ". Correct them.");
    }
  };
  filters::RankGroup(onRanks).Together(check);
  auto result = filters::Arrays::Make<vtkDoubleArray>("MorphGradient");
  morph->Transpose(rest, points, gradient, result, onRanks, monitor);
  output->ShallowCopy(points);
  filters::Arrays::Add(result, output->GetPointData());
  output->GetPointData()->SetActiveVectors("MorphGradient");
}

void vtkMorphAdjoint::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Morph: " << (this->Morph ? this->Morph->GetClassName() : "(none)") << "\n";
  os << indent << "MorphShapes: " << (this->MorphShapes ? "set" : "(none)") << "\n";
  this->PrintOptions(os, indent);
}
