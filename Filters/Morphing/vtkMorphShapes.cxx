// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMorphShapes.h"

#include "Private/Data/Gradient.h"
#include "Private/Data/Version.h"
#include "Private/Morph/MorphOutput.h"
#include "Private/Options.h"
#include "Private/Pipeline/CrewMonitor.h"
#include "Private/Pipeline/Execution.h"
#include "Private/Pipeline/Property.h"
#include "Private/Pipeline/Time.h"
#include "Private/Shapes/Internals.h"
#include "Support/Error.h"
#include "Support/Lists.h"

#include <vtkAlgorithmOutput.h>
#include <vtkDoubleArray.h>
#include <vtkInformation.h>
#include <vtkInformationDoubleKey.h>
#include <vtkInformationDoubleVectorKey.h>
#include <vtkInformationIntegerKey.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>

namespace filters = morph::filters;

vtkStandardNewMacro(vtkMorphShapes);

namespace
{
/// Sets element `i` of a list, which grows if need be; returns whether that changed it.
template <typename Value>
bool setElement(std::vector<Value>& list, int i, const Value& value)
{
  if (i < 0)
  {
    return false;
  }
  const std::size_t place = i;
  if (place < list.size() && list[place] == value)
  {
    return false;
  }
  list.resize(std::max(list.size(), place + 1));
  list[place] = value;
  return true;
}

template <typename Value>
Value element(const std::vector<Value>& list, int i)
{
  return i >= 0 && static_cast<std::size_t>(i) < list.size() ? list[i] : Value();
}
}

vtkMorphShapes::vtkMorphShapes()
  : Internals(new vtkInternals(this))
  , Options(std::make_unique<morph::MorphShapesOptions>())
{
  this->SetNumberOfInputPorts(3);
  this->SetNumberOfOutputPorts(3);
  this->Internals->Results.Reset();
}

vtkMorphShapes::~vtkMorphShapes() = default;

void vtkMorphShapes::AddShapeConnection(vtkAlgorithmOutput* output)
{
  this->AddInputConnection(1, output);
}

void vtkMorphShapes::AddShapeData(vtkDataObject* boundary)
{
  this->AddInputDataObject(1, boundary);
}

void vtkMorphShapes::RemoveAllShapes()
{
  this->SetNumberOfInputConnections(1, 0);
}

void vtkMorphShapes::SetTableConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(2, output);
}

void vtkMorphShapes::SetTableData(vtkDataObject* table)
{
  this->SetInputDataObject(2, table);
}

int vtkMorphShapes::GetNumberOfShapes()
{
  return this->GetNumberOfInputConnections(1);
}

void vtkMorphShapes::SetNumberOfWeights(int number)
{
  const std::size_t size = std::max(0, number);
  if (size != this->Weights.size())
  {
    this->Weights.resize(size);
    this->Modified();
  }
}

void vtkMorphShapes::SetWeight(int shape, double weight)
{
  if (filters::Property::Accepts(this, "Weight", weight, this->GetWeight(shape),
        -filters::Property::Any, filters::Property::Any) &&
      setElement(this->Weights, shape, weight))
  {
    this->Modified();
  }
}

double vtkMorphShapes::GetWeight(int shape) const
{
  return element(this->Weights, shape);
}

void vtkMorphShapes::SetNumberOfShapeNames(int number)
{
  const std::size_t size = std::max(0, number);
  if (size != this->ShapeNames.size())
  {
    this->ShapeNames.resize(size);
    this->Modified();
  }
}

void vtkMorphShapes::SetShapeName(int shape, const char* name)
{
  if (setElement(this->ShapeNames, shape, std::string(name ? name : "")))
  {
    this->Modified();
  }
}

std::string vtkMorphShapes::GetShapeName(int shape) const
{
  const std::string name = element(this->ShapeNames, shape);
  return name.empty() ? "Shape " + std::to_string(shape + 1) : name;
}

void vtkMorphShapes::SetNumberOfMotions(int number)
{
  const std::size_t size = std::max(0, number);
  if (size != this->Motions.size())
  {
    this->Motions.resize(size);
    this->Modified();
  }
}

void vtkMorphShapes::SetMotion(int shape, int motion)
{
  const int known = motion == MOTION_AS_ROTATION ? MOTION_AS_ROTATION : MOTION_AS_DISPLACEMENT;
  if (setElement(this->Motions, shape, known))
  {
    this->Modified();
  }
}

int vtkMorphShapes::GetMotion(int shape) const
{
  return element(this->Motions, shape);
}

vtkTypeBool vtkMorphShapes::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  return filters::Ports::MakeOutput(request, inputVector, outputVector) ||
         this->Superclass::ProcessRequest(request, inputVector, outputVector);
}

int vtkMorphShapes::FillInputPortInformation(int port, vtkInformation* info)
{
  const int done = filters::Ports::FillInformation(port, info);
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_IS_REPEATABLE(), 1);
  }
  return done;
}

int vtkMorphShapes::FillOutputPortInformation(int port, vtkInformation* info)
{
  return filters::Ports::FillOutputInformation(port, info);
}

int vtkMorphShapes::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkInternals& kept = *this->Internals;
  kept.Rows = 0;
  if (vtkAlgorithmOutput* source =
        this->GetNumberOfInputConnections(2) > 0 ? this->GetInputConnection(2, 0) : nullptr)
  {
    source->GetProducer()->Update(source->GetIndex());
    auto* table =
      vtkTable::SafeDownCast(source->GetProducer()->GetOutputDataObject(source->GetIndex()));
    // Where one process alone has read the table, all have its times: all of them have to run.
    const filters::RankGroup all(true);
    kept.Rows = static_cast<vtkIdType>(
      all.Maximum(table ? static_cast<double>(table->GetNumberOfRows()) : 0));
  }
  std::vector<double> times = morph::consecutive<double>(kept.Rows);
  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    // The undeformed mesh and the shapes are taken at their inputs' own time.
    vtkInformation* output = outputVector->GetInformationObject(port);
    output->Remove(Pipeline::TIME_STEPS());
    output->Remove(Pipeline::TIME_RANGE());
    if (!times.empty())
    {
      const double range[2] = { times.front(), times.back() };
      output->Set(Pipeline::TIME_STEPS(), times.data(), static_cast<int>(times.size()));
      output->Set(Pipeline::TIME_RANGE(), range, 2);
    }
  }
  return 1;
}

int vtkMorphShapes::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkInternals& kept = *this->Internals;
  kept.Time = filters::Ports::AskedTime(filters::Ports::Asked(request, outputVector)).value_or(0);
  kept.Row = kept.RowOf(kept.Rows);
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    for (int i = 0; i < inputVector[port]->GetNumberOfInformationObjects(); ++i)
    {
      filters::Ports::AskForAll(inputVector[port]->GetInformationObject(i));
    }
  }
  return 1;
}

int vtkMorphShapes::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkInternals& kept = *this->Internals;
  vtkUnstructuredGrid* output = kept.Ports.Output(outputVector);
  const filters::Ports::Task task = { "morph this mesh", this->Options->NumberOfThreads,
    this->Options->CoincidentPoints,
    [&]
    {
      kept.Results.Reset();
      kept.Ranges = {};
      kept.Weights.clear();
    },
    [&](vtkUnstructuredGrid* grid, vtkDataObject*, bool isDistributed, filters::Monitor& monitor)
    {
      filters::Time::WarnOfSeries(inputVector, nullptr, { "", "A shape" }, monitor);
      vtkDataObject* table = vtkDataObject::GetData(inputVector[2]);
      kept.Morph(grid, isDistributed, inputVector[1], table, outputVector, monitor);
    },
    [&](vtkDataObject* input, const char* status)
    {
      if (filters::Version::AbortRequested(this))
      {
        filters::Version::KeepAbortedOutput(this);
      }
      filters::MorphOutput::WriteUndeformed(input, status, 0, kept.Results, output);
      kept.WriteUndeformedSurface(output, vtkPolyData::GetData(outputVector, 2));
    } };
  const int done = kept.Ports.RequestData(task, inputVector, outputVector);
  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    vtkDataObject* data = vtkDataObject::GetData(outputVector, port);
    data->GetInformation()->Remove(vtkDataObject::DATA_TIME_STEP());
    if (kept.Rows > 0)
    {
      data->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), static_cast<double>(kept.Row));
    }
  }
  return done;
}

double vtkMorphShapes::GetLowestWeight(int shape) const
{
  const auto& ranges = this->Internals->Ranges.Shapes;
  return shape >= 0 && static_cast<std::size_t>(shape) < ranges.size() ? ranges[shape].lowest : NAN;
}

double vtkMorphShapes::GetHighestWeight(int shape) const
{
  const auto& ranges = this->Internals->Ranges.Shapes;
  return shape >= 0 && static_cast<std::size_t>(shape) < ranges.size() ? ranges[shape].highest
                                                                       : NAN;
}

vtkDoubleArray* vtkMorphShapes::GetValidWeights()
{
  vtkDoubleArray* ends = this->Internals->ValidWeights;
  ends->SetNumberOfComponents(2);
  ends->SetNumberOfTuples(0);
  for (const morph::ValidRange& range : this->Internals->Ranges.Shapes)
  {
    ends->InsertNextTuple2(range.isEmpty ? 0 : range.lowest, range.isEmpty ? 0 : range.highest);
  }
  return ends;
}

const char* vtkMorphShapes::GetValidRanges() const
{
  return this->Internals->Results.Text("ValidRanges").c_str();
}

const char* vtkMorphShapes::GetInvertingDesigns() const
{
  return this->Internals->Results.Text("InvertingDesigns").c_str();
}

bool vtkMorphShapes::ComputeDerivatives(vtkDataArray* gradient, vtkDoubleArray* derivatives)
{
  filters::CrewMonitor monitor(this, this->Options->NumberOfThreads);
  const filters::Execution::Outcome outcome = filters::Execution::Run(
    this, "compute derivatives", [&] { this->Differentiate(gradient, derivatives, monitor); },
    [&] { derivatives->Initialize(); });
  return outcome == filters::Execution::Outcome::Done;
}

void vtkMorphShapes::Differentiate(
  vtkDataArray* gradient, vtkDoubleArray* derivatives, morph::Monitor& monitor)
{
  const vtkInternals& kept = *this->Internals;
  if (kept.Weights.empty())
  {
    throw morph::Error("Morph Shapes has no result: update it before its derivatives.");
  }
  const morph::Index points = kept.Modes.GetSolver()->GridNodes();
  const bool isPiece = kept.Modes.Group().IsOfAll();
  morph::Points nodes(0, 3);
  kept.Modes.Group().Together(
    [&]
    {
      if (points > 0 || !isPiece) // a process without points has no arrays
      {
        nodes = filters::Gradient::Require(gradient, points);
      }
    });
  derivatives->Initialize();
  for (const double value : kept.Modes.Derivatives(kept.Weights, nodes, monitor))
  {
    derivatives->InsertNextValue(value);
  }
}

double vtkMorphShapes::GetNumber(const char* name) const
{
  return this->Internals->Results.Number(name);
}

vtkIdType vtkMorphShapes::GetInteger(const char* name) const
{
  return this->Internals->Results.Integer(name);
}

const char* vtkMorphShapes::GetMorphStatus() const
{
  return this->Internals->Results.Text("MorphStatus").c_str();
}

void vtkMorphShapes::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const auto list = [&](const char* name, const auto& values)
  {
    os << indent << name << ":";
    for (const auto& value : values)
    {
      os << " " << value;
    }
    os << "\n";
  };
  os << indent << "Shapes: " << this->GetNumberOfShapes() << "\n";
  list("ShapeNames", this->ShapeNames);
  list("Weights", this->Weights);
  list("Motions", this->Motions);
  this->PrintOptions(os, indent);
  this->Internals->Results.Print(os, indent);
}
