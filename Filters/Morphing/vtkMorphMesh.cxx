// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMorphMesh.h"

#include "LinearMethods/FemWarp.h"
#include "LinearMethods/LogBarrierWarp.h"
#include "Private/Data/AffineArrays.h"
#include "Private/Data/Arrays.h"
#include "Private/Displace/Internals.h"
#include "Private/Displace/Views.h"
#include "Private/GridMorpher/GridMorpher.h"
#include "Private/Morph/Stiffness.h"
#include "Private/Pipeline/CrewMonitor.h"
#include "Private/Pipeline/Execution.h"
#include "Private/Pipeline/Ports.h"
#include "Private/Pipeline/Ranks.h"
#include "Private/Pipeline/Time.h"
#include "Private/Pipeline/UpToDateInput.h"
#include "Private/Project/TargetDistance.h"
#include "Support/Error.h"
#include "Support/Monitor.h"
#include "vtkFEMWarpMorph.h"
#include "vtkInversionFreeMorph.h"
#include "vtkLBWarpMorph.h"
#include "vtkRadialBasisMorph.h"
#include "vtkSimplexLinearMorph.h"
#include "vtkSimplexNaturalNeighborMorph.h"
#include "vtkSmoothingMorph.h"
#include "vtkWeightedResidualMorph.h"

#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationDoubleVectorKey.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSelection.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace filters = morph::filters;

using Pipeline = vtkStreamingDemandDrivenPipeline;

vtkStandardNewMacro(vtkMorphMesh);

namespace
{
vtkSmartPointer<vtkMorphAlgorithm> makeMethod(int method)
{
  switch (method)
  {
    case vtkMorphMesh::METHOD_LBWARP:
      return vtkSmartPointer<vtkLBWarpMorph>::New();
    case vtkMorphMesh::METHOD_WEIGHTED_RESIDUAL:
      return vtkSmartPointer<vtkWeightedResidualMorph>::New();
    case vtkMorphMesh::METHOD_SIMPLEX_LINEAR:
      return vtkSmartPointer<vtkSimplexLinearMorph>::New();
    case vtkMorphMesh::METHOD_SIMPLEX_NATURAL_NEIGHBOR:
      return vtkSmartPointer<vtkSimplexNaturalNeighborMorph>::New();
    case vtkMorphMesh::METHOD_SMOOTHING:
      return vtkSmartPointer<vtkSmoothingMorph>::New();
    case vtkMorphMesh::METHOD_INVERSION_FREE:
      return vtkSmartPointer<vtkInversionFreeMorph>::New();
    case vtkMorphMesh::METHOD_RADIAL_BASIS:
      return vtkSmartPointer<vtkRadialBasisMorph>::New();
    default:
      return vtkSmartPointer<vtkFEMWarpMorph>::New();
  }
}
}

/// What an execution leaves for the next one, and the steps of one: the boundary moves, then the
/// mesh follows it.
class vtkMorphMesh::vtkMorphing
{
public:
  using Inputs = vtkInternals::Inputs;

  filters::Results Results{ filters::ResultTables::vtkMorphMesh() };
  vtkNew<vtkStringArray> Messages;
  bool IsQuiet = false;
  filters::GridMorpher Morpher;
  filters::GridMorpher::Motion Motion;
  vtkSmartPointer<vtkMorphAlgorithm> Method;
  int MethodIs = -1; ///< the property Method, of Method

  explicit vtkMorphing(vtkMorphMesh* filter)
    : Morpher(filter, this->Results)
    , Filter(filter)
  {
  }

  /// Whether steps start from each other.
  bool IsSeries() const
  {
    return filters::GridMorpher::IsSeries(this->Filter->MeshOptions->Stepping, this->Motion.Steps);
  }
  /// What displaces the boundary in the step that is asked for. MOVING_NOTHING: nothing moves yet.
  /// Collective on ranks.
  morph::DisplacementOptions Displacement(const Inputs& inputs);
  /// Displaces the boundary, unless it has been. `mesh`: a grid.
  void Displace(const morph::DisplacementOptions& options, const filters::Input::Mesh& mesh,
    const Inputs& inputs, morph::filters::Monitor& monitor);
  /// Shows the boundary where nothing moves yet.
  void Show(
    vtkUnstructuredGrid* grid, const Inputs& inputs, const filters::GridMorpher::Outputs& outputs);
  /// Returns an error that comes with a result, or nothing.
  std::string Morph(morph::DisplacementOptions options, const filters::Input::Mesh& mesh,
    const Inputs& inputs, const filters::GridMorpher::Outputs& outputs,
    morph::filters::Monitor& monitor);
  void Say(const char* kind, const std::string& message)
  {
    this->Messages->InsertNextValue(kind);
    this->Messages->InsertNextValue(message);
  }

private:
  vtkMorphMesh* Filter;
  vtkNew<vtkPolyData> Boundary; ///< displaced
  /// What Boundary depends on: while it is the same, so is the boundary.
  using Origin =
    std::tuple<morph::DisplacementOptions, std::vector<std::pair<const void*, vtkMTimeType>>,
      std::vector<std::array<double, 7>>, std::vector<std::array<double, 6>>>;
  std::optional<Origin> BoundaryOrigin;
  std::vector<std::string> BoundaryWarnings;
  bool NeedsHandles = false; ///< DISPLACEMENT_HANDLES has none

  vtkInternals& Mover() const { return *this->Filter->Internals; }
  Origin OriginOf(const morph::DisplacementOptions& options, const filters::Input::Mesh& mesh,
    const Inputs& inputs) const;
  /// What to do where nothing moves.
  std::string Advice(const Inputs& inputs) const;
  /// The factors of soft zones, one a cell; none without such zones. Throws morph::Error.
  /// Collective on ranks.
  std::vector<double> SoftCells(vtkUnstructuredGrid* grid, const Inputs& inputs) const;
  /// `isRough`: solves to DragTolerance.
  filters::GridMorpher::Method MethodOf(vtkUnstructuredGrid* grid, const std::vector<double>& soft,
    bool isRough, morph::Monitor& monitor) const;
  /// The boundary with the ids of this process's mesh.
  vtkSmartPointer<vtkPolyData> BoundaryOfGrid() const;
  /// Adds the distances from the target, as they are on `output`.
  void WriteDistances(vtkUnstructuredGrid* grid, vtkUnstructuredGrid* output);
  /// Makes the summary that of all MPI processes. `nodes`: those with distances on `output`.
  void SummarizeOnRanks(const std::vector<morph::Index>& nodes, vtkUnstructuredGrid* output,
    filters::TargetDistance::Summary& distance) const;
};

vtkMorphMesh::vtkMorphMesh()
  : Morphing(new vtkMorphing(this))
  , MeshOptions(std::make_unique<morph::MorphMeshOptions>())
{
  this->SetNumberOfOutputPorts(4);
  this->Morphing->Results.Reset();
}

vtkMorphMesh::~vtkMorphMesh() = default;

vtkUnstructuredGrid* vtkMorphMesh::GetOutput()
{
  return this->GetOutput(0);
}

vtkUnstructuredGrid* vtkMorphMesh::GetOutput(int port)
{
  return vtkUnstructuredGrid::SafeDownCast(this->GetOutputDataObject(port));
}

void vtkMorphMesh::CopySurfaces(vtkDataArraySelection* names, vtkPolyData* output)
{
  this->Superclass::CopySurfaces(names, output);
  const vtkInternals& own = *this->Internals;
  vtkPointSet* shown = this->GetOutput();
  vtkDataArray* ids = output->GetPointData()->GetArray("MorphPointId");
  // On ranks as displaced: the first shows them, and does not have all of the morphed mesh.
  if (own.Whole || !ids || !shown || shown->GetNumberOfPoints() != own.Model.points().rows())
  {
    return;
  }
  auto points =
    filters::Arrays::MakePoints(shown->GetPoints()->GetDataType(), output->GetNumberOfPoints());
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
  {
    points->SetPoint(i, shown->GetPoint(static_cast<vtkIdType>(ids->GetComponent(i, 0))));
  }
  output->SetPoints(points);
}

vtkMorphAlgorithm* vtkMorphMesh::GetMethodFilter()
{
  vtkMorphing& own = *this->Morphing;
  if (own.MethodIs != this->MeshOptions->Method)
  {
    own.MethodIs = this->MeshOptions->Method;
    own.Method = makeMethod(own.MethodIs);
  }
  return own.Method;
}

vtkMTimeType vtkMorphMesh::GetMTime()
{
  return std::max(this->Superclass::GetMTime(), this->GetMethodFilter()->GetMTime());
}

vtkTypeBool vtkMorphMesh::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  return filters::Ports::MakeOutput(request, inputVector, outputVector) ||
         this->Superclass::ProcessRequest(request, inputVector, outputVector);
}

int vtkMorphMesh::FillOutputPortInformation(int port, vtkInformation* info)
{
  return filters::Ports::FillOutputInformation(port, info);
}

int vtkMorphMesh::RequestInformation(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  const filters::Steps steps(this->MeshOptions->NumberOfSteps, nullptr);
  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    vtkInformation* output = outputVector->GetInformationObject(port);
    output->Remove(Pipeline::TIME_STEPS()); // the executive has copied the mesh's
    output->Remove(Pipeline::TIME_RANGE());
    steps.Write(output);
  }
  // A user who is about to choose surfaces wants to see their names before the first execution. See
  // vtkBoundaryDisplacement for several ranks.
  if (filters::Ranks::Processes() == 1)
  {
    this->Internals->List(*this->Options, filters::upToDateInput(this, inputVector));
  }
  return 1;
}

int vtkMorphMesh::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    if (vtkInformation* info = inputVector[port]->GetInformationObject(0))
    {
      filters::Time::AskRest(this->MeshOptions->RestTime, info);
    }
  }
  filters::GridMorpher::Motion& motion = this->Morphing->Motion;
  motion.Steps = filters::Steps(this->MeshOptions->NumberOfSteps, nullptr);
  motion.Step = motion.Steps.Asked(filters::Ports::Asked(request, outputVector));
  if (this->Morphing->IsSeries())
  {
    vtkMTimeType inputs = 0;
    for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
    {
      for (int i = 0; i < this->GetNumberOfInputConnections(port); ++i)
      {
        auto* const upstream =
          vtkDemandDrivenPipeline::SafeDownCast(this->GetInputExecutive(port, i));
        inputs = std::max(inputs, upstream ? upstream->GetPipelineMTime() : 0);
      }
    }
    this->Morphing->Morpher.CheckSeries(this->GetMTime(), true, inputs, motion.Step);
  }
  return 1;
}

int vtkMorphMesh::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkMorphing& own = *this->Morphing;
  filters::Blocks& blocks = this->Internals->Blocks;
  vtkSmartPointer<vtkDataObject> input = vtkDataObject::GetData(inputVector[0]);
  const filters::GridMorpher::Outputs outputs = { blocks.Output(outputVector),
    vtkUnstructuredGrid::GetData(outputVector, 1), vtkPolyData::GetData(outputVector, 2) };
  vtkPolyData* control = vtkPolyData::GetData(outputVector, 3);
  filters::CrewMonitor monitor(this, this->Options->NumberOfThreads);
  std::string partial;
  own.Results.Reset();
  const auto work = [&]
  {
    const filters::Input::Mesh mesh = filters::Input::TakeMesh(input, blocks,
      this->Options->CoincidentPoints, filters::Input::Use::ToMorph, this->GetClassName(), monitor);
    input = mesh.Data;
    const auto check = [&]
    {
      if (!vtkUnstructuredGrid::SafeDownCast(input))
      {
        filters::Input::RequireGrid(input, "The input"); // has the message
      }
    };
    filters::RankGroup(mesh.IsDistributed).Together(check);
    vtkInternals::WarnOfSeries(inputVector, nullptr, monitor);
    const vtkMorphing::Inputs inputs = vtkInternals::InputsOf(inputVector);
    const morph::DisplacementOptions options = own.Displacement(inputs);
    own.Displace(options, mesh, inputs, monitor);
    if (options.Moving == MOVING_NOTHING)
    {
      own.Show(vtkUnstructuredGrid::SafeDownCast(input), inputs, outputs);
    }
    else if (mesh.IsDistributed || !mesh.IsElsewhere)
    {
      partial = own.Morph(options, mesh, inputs, outputs, monitor);
      if (this->Internals->IsTeller())
      {
        control->ShallowCopy(this->Internals->ControlPoints);
      }
    }
  };
  const auto clear = [&]
  {
    outputs.Mesh->Initialize();
    outputs.BadCells->Initialize();
    outputs.Surface->Initialize();
    control->Initialize();
    own.Results.Reset();
  };
  own.Messages->Initialize();
  const auto fail = [&](const std::string& problem)
  {
    own.Say("Error", problem);
    if (!own.IsQuiet)
    {
      vtkErrorMacro(<< problem);
    }
  };
  const filters::Execution::Outcome outcome =
    filters::Execution::Run(this, "morph this mesh", work, clear, fail);
  for (const std::string& warning : monitor.TakeWarnings())
  {
    own.Say("Warning", warning);
    if (!this->MeshOptions->Live && !own.IsQuiet) // they would come with every step of a drag
    {
      vtkWarningMacro(<< warning);
    }
  }
  if (outcome != filters::Execution::Outcome::Done)
  {
    own.Morpher.WriteUndeformed(
      input, outcome == filters::Execution::Outcome::Cancelled ? "Cancelled" : "Failed", outputs);
  }
  blocks.Scatter(outputVector);
  own.Motion.Steps.WriteTime(own.Motion.Step, outputVector);
  if (!partial.empty())
  {
    fail(partial);
  }
  return 1;
}

morph::DisplacementOptions vtkMorphMesh::vtkMorphing::Displacement(const Inputs& inputs)
{
  morph::DisplacementOptions options = *this->Filter->Options;
  // The boundary in the precision of the computation: the output alone is rounded.
  options.OutputPointsPrecision = DOUBLE_PRECISION;
  if (this->Motion.Steps.Any())
  {
    options.ScaleFactor *= this->Motion.Steps.Fraction(this->Motion.Step);
  }
  const bool anySelection =
    filters::Ranks::Count(inputs.Selection && inputs.Selection->GetNumberOfNodes() > 0) > 0;
  const bool byHandles = options.Displacement == DISPLACEMENT_HANDLES;
  const bool byPoints = byHandles || options.Displacement == DISPLACEMENT_LATTICE;
  const bool selectionMoves = anySelection && !(byHandles && options.SelectedHandles);
  const bool byTarget =
    options.Displacement == DISPLACEMENT_TARGET && inputs.Target && !selectionMoves;
  const bool anyPoints =
    filters::Ranks::Count(!filters::ControlPoints::AreNone(inputs.ControlPoints)) > 0;
  this->NeedsHandles = byHandles && !anyPoints && this->Mover().Handles.empty() &&
                       !(options.SelectedHandles && anySelection);
  if (options.Moving == MOVING_SURFACES && options.Surfaces.empty() && !byTarget)
  {
    options.Moving = selectionMoves ? MOVING_SELECTION
                     : byPoints     ? MOVING_EVERYTHING
                                    : MOVING_NOTHING;
  }
  if (this->NeedsHandles || (options.Moving == MOVING_SELECTION && !anySelection))
  {
    options.Moving = MOVING_NOTHING;
  }
  return options;
}

std::string vtkMorphMesh::vtkMorphing::Advice(const Inputs& inputs) const
{
  const morph::DisplacementOptions& options = *this->Filter->Options;
  const std::string none = "Nothing moves yet. ";
  if (this->NeedsHandles)
  {
    return none + "Give a handle: add a row to Handles, choose Control Points, or copy selected "
                  "points and tick Selected Handles.";
  }
  if (options.Moving == MOVING_SELECTION)
  {
    return none + "Select points or cells in the view, and press Copy Active Selection.";
  }
  if (options.Displacement == DISPLACEMENT_TARGET && !inputs.Target)
  {
    return none + "Choose the Target, a surface such as an STL file.";
  }
  return none + "Tick surfaces, or select cells in the view and press Add selected surfaces.";
}

vtkMorphMesh::vtkMorphing::Origin vtkMorphMesh::vtkMorphing::OriginOf(
  const morph::DisplacementOptions& options, const filters::Input::Mesh& mesh,
  const Inputs& inputs) const
{
  const vtkInternals& mover = this->Mover();
  std::vector<std::pair<const void*, vtkMTimeType>> objects;
  for (vtkObject* object : std::initializer_list<vtkObject*>{ mesh.Data, inputs.Selection,
         inputs.Target, inputs.Zone, inputs.ControlPoints, inputs.Field, mover.Region,
         mover.ZoneRegion, mover.Transform, mover.RigidTransform, mover.Extractor })
  {
    objects.emplace_back(object, object ? object->GetMTime() : 0);
  }
  objects.emplace_back(nullptr, mover.IsDragged && options.SlideRounds > 0); // rougher
  return { options, objects, mover.Handles, mover.LatticeDisplacements };
}

void vtkMorphMesh::vtkMorphing::Displace(const morph::DisplacementOptions& options,
  const filters::Input::Mesh& mesh, const Inputs& inputs, filters::Monitor& monitor)
{
  vtkInternals& mover = this->Mover();
  mover.IsDragged = this->Filter->MeshOptions->Live;
  Origin origin = this->OriginOf(options, mesh, inputs);
  // On several processes all displace it or none: it communicates.
  if (filters::Ranks::Processes() > 1 || this->BoundaryOrigin != origin)
  {
    this->BoundaryOrigin.reset(); // in case it throws
    this->Boundary->Initialize();
    mover.ResetResults();
    const std::vector<std::string> before = monitor.TakeWarnings();
    morph::ProgressRange displacing(monitor, 0, 0.3);
    mover.Displace(options, mesh, inputs, this->Boundary, displacing);
    this->BoundaryWarnings = monitor.TakeWarnings();
    for (const std::string& warning : before)
    {
      monitor.warn(warning);
    }
    this->BoundaryOrigin = std::move(origin);
  }
  for (const std::string& warning : this->BoundaryWarnings)
  {
    if (mover.IsTeller())
    {
      monitor.warn(warning);
    }
  }
}

void vtkMorphMesh::vtkMorphing::Show(
  vtkUnstructuredGrid* grid, const Inputs& inputs, const filters::GridMorpher::Outputs& outputs)
{
  filters::Views::Boundary(grid, this->BoundaryOfGrid(), outputs.Mesh);
  filters::Views::Boundary(this->Boundary, outputs.Surface);
  this->Results.SetText("Advice", this->Advice(inputs));
  this->Results.Write(outputs.Mesh);
}

std::vector<double> vtkMorphMesh::vtkMorphing::SoftCells(
  vtkUnstructuredGrid* grid, const Inputs& inputs) const
{
  vtkInternals& mover = this->Mover();
  filters::Zones::Options zones = mover.ZoneOptions(*this->Filter->Options, inputs.Zone);
  zones.Soft = this->Filter->MeshOptions->SoftZones;
  if (zones.Soft.empty() && zones.RegionKind != ZONE_SOFT && zones.SelectionKind != ZONE_SOFT)
  {
    return {};
  }
  std::vector<double> factors(grid->GetNumberOfCells(), 1);
  for (const filters::Zones::Part& part : mover.FindZones(filters::Zones::Soft, grid, zones))
  {
    for (std::size_t c = 0; c < part.isCell.size(); ++c)
    {
      if (part.isCell[c])
      {
        factors[c] = this->Filter->MeshOptions->SoftStiffness;
      }
    }
  }
  return factors;
}

filters::GridMorpher::Method vtkMorphMesh::vtkMorphing::MethodOf(vtkUnstructuredGrid* grid,
  const std::vector<double>& soft, bool isRough, morph::Monitor& monitor) const
{
  const morph::MorphMeshOptions& own = *this->Filter->MeshOptions;
  vtkMorphAlgorithm* method = this->Filter->GetMethodFilter();
  morph::MorphOptions options = method->GetOptions();
  options.BoundaryIdArray.clear();
  options.DisplacementArray.clear();
  options.ScaleFactor = 1; // the boundary has it
  options.Validity = own.Live ? int(vtkMorphAlgorithm::VALIDITY_NONE) : own.Validity;
  options.Quality = own.Quality;
  options.FeatureLines = own.FeatureLines;
  options.Stepping = own.Stepping;
  options.OutputPointsPrecision = this->Filter->Options->OutputPointsPrecision;
  if (own.Method != METHOD_FEMWARP)
  {
    if (!soft.empty())
    {
      throw morph::Error("This method has no stiffness, so there are no soft zones. Use FEMWARP.");
    }
    if (filters::Stiffness::Of(own).AreGiven())
    {
      monitor.warn("This method has no stiffness: `Stiffness` counts for FEMWARP alone.");
    }
    return { options, [method, isRough]
      {
        std::unique_ptr<morph::Morpher> morpher = method->CreateMorpher();
        if (auto* lbwarp = dynamic_cast<morph::LogBarrierWarp*>(morpher.get()); lbwarp && isRough)
        {
          lbwarp->setTolerance(std::max(lbwarp->tolerance(), vtkInternals::DragTolerance));
        }
        return morpher;
      } };
  }
  auto stiffness =
    filters::Stiffness::Take(filters::Stiffness::Of(own), grid, this->Boundary, soft);
  return { options, [method, isRough, stiffness = std::move(stiffness)]
    {
      std::unique_ptr<morph::Morpher> morpher = method->CreateMorpher();
      auto& femwarp = dynamic_cast<morph::FemWarp&>(*morpher);
      femwarp.setStiffness(stiffness);
      if (isRough)
      {
        femwarp.setTolerance(std::max(femwarp.tolerance(), vtkInternals::DragTolerance));
      }
      return morpher;
    } };
}

std::string vtkMorphMesh::vtkMorphing::Morph(morph::DisplacementOptions options,
  const filters::Input::Mesh& mesh, const Inputs& inputs,
  const filters::GridMorpher::Outputs& outputs, filters::Monitor& monitor)
{
  auto* grid = vtkUnstructuredGrid::SafeDownCast(mesh.Data);
  const std::vector<double> soft = this->SoftCells(grid, inputs);
  filters::GridMorpher::Method method;
  // The solution of an affine motion serves all steps of a drag, and what is there on release.
  const bool isAffine = filters::AffineArrays::Read(this->Boundary).has_value();
  const bool isAffineSomewhere =
    mesh.IsDistributed ? filters::Ranks::Count(isAffine) > 0 : isAffine;
  const bool isRough = this->Filter->MeshOptions->Live && !isAffineSomewhere;
  filters::RankGroup(mesh.IsDistributed)
    .Together([&] { method = this->MethodOf(grid, soft, isRough, monitor); });
  filters::GridMorpher::Motion motion; // Boundary has made it
  if (this->IsSeries())
  {
    motion = this->Motion;
    motion.Boundary = [&](int step)
    {
      options.ScaleFactor = this->Filter->Options->ScaleFactor * this->Motion.Steps.Fraction(step);
      this->Displace(options, mesh, inputs, monitor);
      return this->Boundary.Get();
    };
  }
  morph::ProgressRange morphing(monitor, 0.3, 1);
  std::string partial = this->Morpher.Morph(
    grid, this->Boundary, mesh.IsDistributed, motion, method, outputs, morphing);
  for (const char* name : { "SlideChange", "SlideForce", "ContactGaps" })
  {
    outputs.Mesh->GetFieldData()->RemoveArray(name); // the input may be a result
    if (vtkDataArray* array = this->Boundary->GetFieldData()->GetArray(name))
    {
      outputs.Mesh->GetFieldData()->AddArray(array);
    }
  }
  this->Results.SetText("SlideReport", this->Mover().SlideReport);
  this->Results.SetText("ContactReport", this->Mover().ContactReport);
  this->Results.SetNumber("PresentDimension", this->Mover().PresentDimension);
  this->WriteDistances(grid, outputs.Mesh);
  return partial;
}

vtkSmartPointer<vtkPolyData> vtkMorphMesh::vtkMorphing::BoundaryOfGrid() const
{
  vtkSmartPointer<vtkPolyData> boundary = this->Boundary.Get();
  return this->Mover().Whole ? this->Mover().Whole->OfPiece(boundary) : boundary;
}

void vtkMorphMesh::vtkMorphing::WriteDistances(
  vtkUnstructuredGrid* grid, vtkUnstructuredGrid* output)
{
  vtkPolyData* target = this->Filter->Options->Displacement == DISPLACEMENT_TARGET
                          ? this->Mover().Fit.Surface()
                          : nullptr;
  const vtkSmartPointer<vtkPolyData> boundary = this->BoundaryOfGrid();
  vtkDataArray* ids = boundary->GetPointData()->GetArray("MorphPointId");
  vtkDataArray* roles = boundary->GetPointData()->GetArray("Role");
  if (!target || !ids || !roles || output->GetNumberOfPoints() != grid->GetNumberOfPoints())
  {
    return;
  }
  std::vector<morph::Index> nodes;
  for (vtkIdType i = 0; i < boundary->GetNumberOfPoints(); ++i)
  {
    if (roles->GetComponent(i, 0) == 1)
    {
      nodes.push_back(static_cast<morph::Index>(ids->GetComponent(i, 0)));
    }
  }
  morph::Points before(static_cast<morph::Index>(nodes.size()), 3), after = before;
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    grid->GetPoint(nodes[i], before.row(static_cast<morph::Index>(i)).data());
    output->GetPoint(nodes[i], after.row(static_cast<morph::Index>(i)).data());
  }
  filters::TargetDistance::Summary distance =
    filters::TargetDistance::Write(target, nodes, before, after, output);
  if (this->Mover().Whole)
  {
    this->SummarizeOnRanks(nodes, output, distance);
  }
  this->Results.SetNumber("MaxTargetDistanceBefore", distance.MaxBefore);
  this->Results.SetNumber("MeanTargetDistanceBefore", distance.MeanBefore);
  this->Results.SetNumber("MaxTargetDistance", distance.Max);
  this->Results.SetNumber("MeanTargetDistance", distance.Mean);
}

void vtkMorphMesh::vtkMorphing::SummarizeOnRanks(const std::vector<morph::Index>& nodes,
  vtkUnstructuredGrid* output, filters::TargetDistance::Summary& distance) const
{
  const filters::WholeSurface& whole = *this->Mover().Whole;
  const auto summarize = [&](const char* name)
  {
    vtkDataArray* array = output->GetPointData()->GetArray(name);
    std::vector<double> values;
    for (const morph::Index node : nodes)
    {
      values.push_back(array->GetComponent(static_cast<vtkIdType>(node), 0));
    }
    return whole.MaximumAndMean(nodes, values);
  };
  std::tie(distance.MaxBefore, distance.MeanBefore) = summarize("TargetDistanceBefore");
  std::tie(distance.Max, distance.Mean) = summarize("TargetDistance");
}

vtkStringArray* vtkMorphMesh::GetMessages()
{
  return this->Morphing->Messages;
}

void vtkMorphMesh::SetQuiet(bool quiet)
{
  this->Morphing->IsQuiet = quiet;
}

bool vtkMorphMesh::GetQuiet() const
{
  return this->Morphing->IsQuiet;
}

double vtkMorphMesh::GetNumber(const char* name) const
{
  return this->Morphing->Results.Number(name);
}

vtkIdType vtkMorphMesh::GetInteger(const char* name) const
{
  return this->Morphing->Results.Integer(name);
}

const char* vtkMorphMesh::GetText(const char* name) const
{
  return this->Morphing->Results.Text(name).c_str();
}

void vtkMorphMesh::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  this->PrintOptions(os, indent);
  this->Morphing->Results.Print(os, indent);
}
