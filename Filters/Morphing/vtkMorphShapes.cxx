// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMorphShapes.h"

#include "LinearMethods/FemWarp.h"
#include "LinearMethods/LogBarrierWarp.h"
#include "LinearMethods/SimplexLinear.h"
#include "LinearMethods/SimplexNaturalNeighbor.h"
#include "LinearMethods/WeightedResidual.h"
#include "Private/Data/BadCells.h"
#include "Private/Data/Gradient.h"
#include "Private/Data/Output.h"
#include "Private/Data/Quality.h"
#include "Private/Data/Results.h"
#include "Private/Data/Version.h"
#include "Private/Morph/MorphOutput.h"
#include "Private/Pipeline/CrewMonitor.h"
#include "Private/Pipeline/Execution.h"
#include "Private/Pipeline/Input.h"
#include "Private/Pipeline/Ports.h"
#include "Private/Pipeline/Property.h"
#include "Private/Shapes/Designs.h"
#include "Private/Shapes/ShapeModes.h"
#include "Private/Shapes/WeightRanges.h"
#include "Support/Error.h"
#include "Support/ProgressRange.h"

#include <vtkAlgorithmOutput.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationDoubleKey.h>
#include <vtkInformationDoubleVectorKey.h>
#include <vtkInformationIntegerKey.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <sstream>
#include <utility>

namespace filters = morph::filters;

vtkStandardNewMacro(vtkMorphShapes);

morphSetNumberMacro(vtkMorphShapes, Tolerance, 1e-15, 0.999)
  morphSetNumberMacro(vtkMorphShapes, MatchTolerance, 0.0, 1.0)

    namespace
{
  std::unique_ptr<morph::LinearMorpher> makeMethod(int method, double tolerance)
  {
    switch (method)
    {
      case vtkMorphShapes::METHOD_LBWARP:
      {
        auto lbwarp = std::make_unique<morph::LogBarrierWarp>();
        lbwarp->setTolerance(tolerance);
        lbwarp->setOutsideHull(morph::LogBarrierWarp::OutsideHull::Relax);
        return lbwarp;
      }
      case vtkMorphShapes::METHOD_WEIGHTED_RESIDUAL:
        return std::make_unique<morph::WeightedResidual>();
      case vtkMorphShapes::METHOD_SIMPLEX_LINEAR:
        return std::make_unique<morph::SimplexLinear>();
      case vtkMorphShapes::METHOD_SIMPLEX_NATURAL_NEIGHBOR:
        return std::make_unique<morph::SimplexNaturalNeighbor>();
      default:
        break;
    }
    auto femwarp = std::make_unique<morph::FemWarp>();
    femwarp->setTolerance(tolerance);
    return femwarp;
  }

  /// Sets element `i` of a list, which grows if need be; returns whether that changed it.
  template <typename Value>
  bool setElement(std::vector<Value> & list, int i, const Value& value)
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

class vtkMorphShapes::vtkInternals
{
public:
  filters::Results Results{ filters::ResultTables::vtkMorphShapes() };
  filters::ShapeModes Modes;
  filters::Ports Ports;
  filters::WeightRanges Ranges; ///< of the last execution
  std::vector<double> Weights;  ///< of the last execution; empty where it had no result
  filters::Designs Designs;
  vtkIdType Rows = 0;  ///< of the table, as of the last update of the information
  vtkIdType Row = 0;   ///< that the outputs are asked for
  morph::Points Moved; ///< kept for its memory: its content has no effect

  explicit vtkInternals(vtkMorphShapes* filter)
    : Ports(filter)
    , Filter(filter)
  {
  }

  void Morph(vtkUnstructuredGrid* grid, vtkInformationVector* boundaries, vtkDataObject* table,
    vtkInformationVector* outputs, morph::Monitor& monitor);

private:
  vtkMorphShapes* Filter;

  filters::ShapeModes::Options Options() const;
  std::vector<filters::ShapeModes::Shape> Shapes(vtkInformationVector* boundaries) const;
  void Solve(vtkInformationVector* boundaries, morph::Monitor& monitor);
  void Measure(vtkUnstructuredGrid* output, vtkUnstructuredGrid* badCells, vtkPolyData* surface,
    morph::Monitor& monitor);
  /// The present weights: the filter's, or those of the table's row.
  std::vector<double> PresentWeights(
    std::size_t shapes, vtkDataObject* table, morph::Monitor& monitor);
  void FindRanges(const std::vector<double>& weights, morph::Monitor& monitor);
  std::vector<std::string> Names(std::size_t number) const;
  void WriteShapes(const std::vector<double>& weights, vtkUnstructuredGrid* output) const;
};

vtkMorphShapes::vtkMorphShapes()
  : Internals(new vtkInternals(this))
{
  this->SetNumberOfInputPorts(3);
  this->SetNumberOfOutputPorts(3);
  this->Internals->Results.Reset();
}

vtkMorphShapes::~vtkMorphShapes()
{
  this->SetBoundaryIdArray(nullptr);
  this->SetDisplacementArray(nullptr);
}

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
  if (filters::Property::Accepts(this, "Weight", weight, this->GetWeight(shape)) &&
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
    kept.Rows = table ? table->GetNumberOfRows() : 0;
  }
  std::vector<double> times(kept.Rows);
  std::iota(times.begin(), times.end(), 0.);
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
  const double time =
    filters::Ports::AskedTime(filters::Ports::Asked(request, outputVector)).value_or(0);
  const auto last = static_cast<double>(std::max<vtkIdType>(this->Internals->Rows - 1, 0));
  this->Internals->Row = static_cast<vtkIdType>(std::clamp(std::floor(time), 0., last));
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
  vtkUnstructuredGrid* output = vtkUnstructuredGrid::GetData(outputVector);
  vtkInternals& kept = *this->Internals;
  const filters::Ports::Task task = { "morph this mesh", this->NumberOfThreads,
    [&]
    {
      kept.Results.Reset();
      kept.Ranges = {};
      kept.Weights.clear();
    },
    [&](vtkUnstructuredGrid* grid, vtkDataObject*, filters::Monitor& monitor)
    {
      vtkDataObject* table = vtkDataObject::GetData(inputVector[2]);
      kept.Morph(grid, inputVector[1], table, outputVector, monitor);
    },
    [&](vtkDataObject* input, const char* status)
    {
      if (filters::Version::AbortRequested(this))
      {
        filters::Version::KeepAbortedOutput(this);
      }
      filters::MorphOutput::WriteUndeformed(input, status, 0, kept.Results, output);
      kept.Modes.GetKept().WriteUndeformedSurface(output, vtkPolyData::GetData(outputVector, 2));
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

filters::ShapeModes::Options vtkMorphShapes::vtkInternals::Options() const
{
  filters::ShapeModes::Options options;
  options.Matching.BoundaryIdArray = filters::Input::ArrayName(this->Filter->BoundaryIdArray);
  options.Matching.DisplacementArray = filters::Input::ArrayName(this->Filter->DisplacementArray);
  options.Matching.MatchTolerance = this->Filter->MatchTolerance;
  options.Matching.HoldUnnamedBoundary = this->Filter->HoldUnnamedBoundary;
  std::ostringstream text;
  text.precision(17);
  text << this->Filter->Method << " " << this->Filter->Tolerance;
  options.Method = text.str();
  options.CreateMorpher = [filter = this->Filter]
  { return makeMethod(filter->Method, filter->Tolerance); };
  return options;
}

std::vector<filters::ShapeModes::Shape> vtkMorphShapes::vtkInternals::Shapes(
  vtkInformationVector* boundaries) const
{
  const int number = boundaries->GetNumberOfInformationObjects();
  if (number == 0)
  {
    throw morph::Error("There is no shape: connect displaced boundaries to port 1, one for each "
                       "shape, Boundary Displacement's output for instance.");
  }
  std::vector<filters::ShapeModes::Shape> shapes;
  for (int i = 0; i < number; ++i)
  {
    const std::string name = this->Filter->GetShapeName(i);
    try
    {
      shapes.push_back(
        { name, filters::Input::RequireBoundary(vtkDataObject::GetData(boundaries, i)),
          this->Filter->GetMotion(i) == MOTION_AS_ROTATION });
    }
    catch (const morph::Error& error)
    {
      throw morph::Error(error.kind(), "Shape '" + name + "': " + error.what());
    }
  }
  return shapes;
}

void vtkMorphShapes::vtkInternals::Solve(vtkInformationVector* boundaries, morph::Monitor& monitor)
{
  const filters::ShapeModes::Effort effort =
    this->Modes.Solve(this->Shapes(boundaries), this->Options(), monitor);
  this->Results.SetInteger(
    "PrepareCount", this->Results.Integer("PrepareCount") + effort.Preparations);
  this->Results.SetInteger("SolveCount", this->Results.Integer("SolveCount") + effort.Solved);
  this->Results.SetInteger("SolverIterations", effort.Iterations);
  this->Results.SetNumber("PrepareSeconds", effort.Seconds);
  this->Results.SetInteger("PrescribedPoints", effort.Prescribed);
}

std::vector<double> vtkMorphShapes::vtkInternals::PresentWeights(
  std::size_t shapes, vtkDataObject* table, morph::Monitor& monitor)
{
  std::vector<double> weights;
  for (std::size_t i = 0; i < shapes; ++i)
  {
    weights.push_back(this->Filter->GetWeight(static_cast<int>(i)));
  }
  if (!table)
  {
    this->Designs = {};
    return weights;
  }
  filters::Designs designs = filters::Designs::Read(table, this->Names(shapes), weights);
  designs.KeepAnswer(std::move(this->Designs));
  this->Designs = std::move(designs);
  if (this->Filter->CheckDesigns)
  {
    std::vector<morph::Index> rows;
    for (const std::size_t row : this->Designs.Inverted(this->Modes, monitor))
    {
      rows.push_back(static_cast<morph::Index>(row));
    }
    this->Results.SetText("InvertingDesigns", rows.empty() ? "none" : morph::listIds(rows, 100));
  }
  const auto last = static_cast<vtkIdType>(this->Designs.Number()) - 1;
  return this->Designs[std::min(this->Row, last)];
}

void vtkMorphShapes::vtkInternals::Morph(vtkUnstructuredGrid* grid,
  vtkInformationVector* boundaries, vtkDataObject* table, vtkInformationVector* outputs,
  morph::Monitor& monitor)
{
  vtkUnstructuredGrid* output = vtkUnstructuredGrid::GetData(outputs);
  this->Modes.SetGrid(grid, monitor);
  this->Results.SetInteger("MirroredBodies", this->Modes.GetKept().MirroredBodies());
  morph::ProgressRange solving(monitor, 0, 0.6);
  this->Solve(boundaries, solving);
  morph::ProgressRange checking(monitor, 0.6, 0.8);
  const std::vector<double> weights =
    this->PresentWeights(boundaries->GetNumberOfInformationObjects(), table, checking);

  const auto start = std::chrono::steady_clock::now();
  const morph::Points& rest = this->Modes.GetKept().Mesh().points;
  morph::blend(rest, this->Modes.Weighted(weights), this->Moved, monitor);
  this->Results.SetNumber("EvaluateSeconds",
    std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  filters::Output::Write(grid, rest, this->Moved, this->Filter->OutputPointsPrecision, output);
  if (this->Filter->FindValidRanges)
  {
    this->FindRanges(weights, monitor);
  }
  this->Measure(
    output, vtkUnstructuredGrid::GetData(outputs, 1), vtkPolyData::GetData(outputs, 2), monitor);
  this->WriteShapes(weights, output);
  this->Weights = weights;
}

void vtkMorphShapes::vtkInternals::Measure(vtkUnstructuredGrid* output,
  vtkUnstructuredGrid* badCells, vtkPolyData* surface, morph::Monitor& monitor)
{
  const bool all = this->Filter->Quality == QUALITY_ALL;
  const std::vector<std::uint8_t>& inner = this->Modes.GetKept().Surface().InnerCells();
  const morph::Mesh& mesh = this->Modes.GetKept().Mesh();
  const std::vector<std::int8_t>& orientation = this->Modes.GetKept().Orientation();
  const morph::Quality quality =
    all ? filters::Quality::Measure(mesh, output, orientation, monitor)
        : filters::Quality::Measure(mesh, output, orientation, inner, monitor);
  this->Results.SetInteger("SurfaceInvertedCells",
    this->Modes.GetKept().Surface().Write(output->GetPoints(), quality, surface));
  filters::Quality::Remove(output);
  if (all)
  {
    filters::Quality::Write(quality, output);
    filters::BadCells::Extract(quality, output, badCells);
    this->Results.Set(quality);
    this->Results.SetText(
      "MorphStatus", quality.inverted + quality.degenerate > 0 ? "Inverted" : "Valid");
  }
  else
  {
    this->Results.SetText("MorphStatus", "Unmeasured");
  }
  this->Results.Write(output);
}

void vtkMorphShapes::vtkInternals::FindRanges(
  const std::vector<double>& weights, morph::Monitor& monitor)
{
  this->Ranges = filters::WeightRanges::Find(this->Modes, weights, this->Moved, monitor);
  this->Results.SetText("ValidRanges", this->Ranges.Text(this->Names(weights.size())));
  this->Results.SetNumber("LargestFactor", this->Ranges.LargestFactor);
}

std::vector<std::string> vtkMorphShapes::vtkInternals::Names(std::size_t number) const
{
  std::vector<std::string> names;
  for (std::size_t i = 0; i < number; ++i)
  {
    names.push_back(this->Filter->GetShapeName(static_cast<int>(i)));
  }
  return names;
}

void vtkMorphShapes::vtkInternals::WriteShapes(
  const std::vector<double>& weights, vtkUnstructuredGrid* output) const
{
  vtkNew<vtkStringArray> names;
  names->SetName("ShapeNames");
  for (const std::string& name : this->Names(weights.size()))
  {
    names->InsertNextValue(name);
  }
  output->GetFieldData()->AddArray(names);
  const auto add = [&](const char* name, const auto& valueOf)
  {
    vtkNew<vtkDoubleArray> values;
    values->SetName(name);
    for (std::size_t i = 0; i < weights.size(); ++i)
    {
      values->InsertNextValue(valueOf(i));
    }
    output->GetFieldData()->AddArray(values);
  };
  add("ShapeWeights", [&](std::size_t i) { return weights[i]; });
  if (this->Filter->FindValidRanges)
  {
    add("ShapeLowestWeight", [this](std::size_t i) { return this->Ranges.Shapes[i].lowest; });
    add("ShapeHighestWeight", [this](std::size_t i) { return this->Ranges.Shapes[i].highest; });
  }
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
  filters::CrewMonitor monitor(this, this->NumberOfThreads);
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
  const morph::Points nodes =
    filters::Gradient::Require(gradient, kept.Modes.GetKept().Mesh().numberOfNodes());
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
  const auto text = [](const char* name) { return name ? name : "(none)"; };
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
  os << indent << "Method: " << this->Method << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "BoundaryIdArray: " << text(this->BoundaryIdArray) << "\n";
  os << indent << "DisplacementArray: " << text(this->DisplacementArray) << "\n";
  os << indent << "MatchTolerance: " << this->MatchTolerance << "\n";
  os << indent << "HoldUnnamedBoundary: " << this->HoldUnnamedBoundary << "\n";
  os << indent << "FindValidRanges: " << this->FindValidRanges << "\n";
  os << indent << "CheckDesigns: " << this->CheckDesigns << "\n";
  os << indent << "Quality: " << this->Quality << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "OutputPointsPrecision: " << this->OutputPointsPrecision << "\n";
  this->Internals->Results.Print(os, indent);
}
