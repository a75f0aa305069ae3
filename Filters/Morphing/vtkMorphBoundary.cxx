// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMorphBoundary.h"

#include "Boundary/FaceQuality.h"
#include "BoundaryMorphing/SurfaceMeshSmoothing.h"
#include "BoundaryMorphing/SurfaceMorph.h"
#include "BoundaryMorphing/SurfaceSmoothing.h"
#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"
#include "Private/Data/Arrays.h"
#include "Private/Data/Directions.h"
#include "Private/Data/Geometry.h"
#include "Private/Data/GridMesh.h"
#include "Private/Data/Output.h"
#include "Private/Data/Results.h"
#include "Private/Data/Surface.h"
#include "Private/Distributed/WholeSurface.h"
#include "Private/Morph/BoundaryMatch.h"
#include "Private/Options.h"
#include "Private/Pipeline/Input.h"
#include "Private/Pipeline/Monitor.h"
#include "Private/Pipeline/Ports.h"
#include "Private/Pipeline/Ranks.h"
#include "Private/Pipeline/Time.h"
#include "Private/Project/TargetData.h"
#include "Support/Error.h"

#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace filters = morph::filters;

vtkStandardNewMacro(vtkMorphBoundary);

class vtkMorphBoundary::vtkInternals
{
  using Index = morph::Index;

public:
  filters::Results Results{ filters::ResultTables::vtkMorphBoundary() };
  filters::Ports Ports;

  explicit vtkInternals(vtkMorphBoundary* filter)
    : Ports(filter)
    , Filter(filter)
  {
  }

  void Morph(vtkUnstructuredGrid* grid, vtkDataObject* boundary, vtkDataObject* target,
    vtkPolyData* output, filters::Monitor& monitor);
  /// For a mesh on several MPI processes: each gets the part that its cells have. Collective.
  void MorphOnRanks(vtkUnstructuredGrid* piece, vtkDataObject* boundary, vtkDataObject* target,
    vtkPolyData* output, filters::Monitor& given);

private:
  /// The boundary of a mesh, and what it is to follow.
  struct Task
  {
    vtkUnstructuredGrid* Grid;
    const morph::Mesh& Mesh;
    const morph::BoundaryFaces& Faces;
    const std::vector<Index>& BodyOfNode;
    const std::vector<std::int8_t>* Orientation; ///< as for Surface::Write()
    double Size;
    std::function<morph::BoundaryTargets()> Match;
    vtkPolyData* Target;
  };

  vtkMorphBoundary* Filter;
  std::unique_ptr<filters::WholeSurface> Whole; ///< of a mesh on several MPI processes, or null

  filters::BoundaryMatch::Options Matching() const;
  void Run(const Task& task, vtkPolyData* output, filters::Monitor& monitor);

  void ReportProjection(const morph::ProjectionReport& onCurves,
    const morph::ProjectionReport& onSurfaces, const morph::Target& target,
    filters::Monitor& monitor);
};

namespace
{
using morph::Index;

/// The nodes of `match` whose geometry has at most `dimension`.
morph::BoundaryTargets upTo(
  const morph::BoundaryTargets& match, const morph::Classification& geometry, int dimension)
{
  morph::BoundaryTargets result;
  std::vector<Index> rows;
  for (std::size_t i = 0; i < match.ids.size(); ++i)
  {
    const std::int8_t own = geometry.dimension[match.ids[i]];
    if (own >= 0 && own <= dimension)
    {
      result.ids.push_back(match.ids[i]);
      rows.push_back(static_cast<Index>(i));
    }
  }
  result.targets.resize(static_cast<Index>(rows.size()), 3);
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    result.targets.row(static_cast<Index>(i)) = match.targets.row(rows[i]);
  }
  if (rows.empty())
  {
    const char* what = dimension == 0   ? "vertex"
                       : dimension == 1 ? "vertex or curve"
                                        : "vertex, curve or surface";
    throw morph::Error(
      "None of the " + std::to_string(match.ids.size()) +
      " nodes that the boundary names is on a " + what + " of the mesh (it has " +
      std::to_string(geometry.vertices.size()) + " vertices, " +
      std::to_string(geometry.curves.size()) + " curves and " +
      std::to_string(geometry.surfaces.size()) +
      " surfaces). Raise `PrescribedDimension`, lower `FeatureAngle`, or name other "
      "nodes.");
  }
  return result;
}

template <typename Array, typename Value>
vtkSmartPointer<Array> makeArray(const char* name, const morph::Points& rows)
{
  auto array = filters::Arrays::Make<Array>(name, rows.rows(), 3);
  std::transform(rows.data(), rows.data() + rows.size(), array->GetPointer(0),
    [](double value) { return static_cast<Value>(value); });
  return array;
}

vtkSmartPointer<vtkDataArray> makeArray(const char* name, const morph::Points& rows, bool isFloat)
{
  if (isFloat)
  {
    return makeArray<vtkFloatArray, float>(name, rows);
  }
  return makeArray<vtkDoubleArray, double>(name, rows);
}

void writeMotion(const morph::Points& rest, const morph::Points& moved,
  const std::vector<Index>& nodes, bool isFloat, vtkPolyData* output)
{
  const morph::Points to = moved(nodes, morph::allColumns);
  vtkNew<vtkPoints> points;
  points->SetData(makeArray("Points", to, isFloat));
  output->SetPoints(points);
  filters::Directions::RemoveNormals(output);
  filters::Arrays::Add(makeArray("MorphDisplacement", to - rest(nodes, morph::allColumns), isFloat),
    output->GetPointData());
  output->GetPointData()->SetActiveVectors("MorphDisplacement");
}

/// Writes the cell array, and returns the output's cell ids of the folded faces.
std::vector<Index> writeQuality(
  const morph::FaceQuality& quality, const std::vector<Index>& faceOf, vtkPolyData* output)
{
  auto values = filters::Arrays::Make<vtkDoubleArray>("ScaledJacobian");
  std::vector<Index> folded;
  for (std::size_t cell = 0; cell < faceOf.size(); ++cell)
  {
    const double value = quality.scaledJacobian[faceOf[cell]];
    values->InsertNextValue(value);
    if (value <= 0)
    {
      folded.push_back(static_cast<Index>(cell));
    }
  }
  filters::Arrays::Add(values, output->GetCellData());
  output->GetCellData()->SetActiveScalars("ScaledJacobian");
  // Viewers would color by an active point array.
  output->GetPointData()->SetActiveScalars(nullptr);
  return folded;
}

void warnOfNodes(morph::Monitor& monitor, const std::vector<Index>& nodes, const char* text)
{
  if (!nodes.empty())
  {
    monitor.warn(text + morph::listIds(nodes) + ".");
  }
}
}

vtkMorphBoundary::vtkMorphBoundary()
  : Internals(new vtkInternals(this))
  , Options(std::make_unique<morph::MorphBoundaryOptions>())
{
  this->SetNumberOfInputPorts(3);
}

vtkMorphBoundary::~vtkMorphBoundary() = default;

void vtkMorphBoundary::SetBoundaryConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkMorphBoundary::SetBoundaryData(vtkDataObject* boundary)
{
  this->SetInputDataObject(1, boundary);
}

void vtkMorphBoundary::SetTargetConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(2, output);
}

void vtkMorphBoundary::SetTargetData(vtkDataObject* target)
{
  this->SetInputDataObject(2, target);
}

int vtkMorphBoundary::FillInputPortInformation(int port, vtkInformation* info)
{
  return filters::Ports::FillInformation(port, info);
}

int vtkMorphBoundary::RequestInformation(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  return filters::Ports::RequestInformation(inputVector, outputVector);
}

int vtkMorphBoundary::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  return this->Internals->Ports.RequestUpdateExtent(this->Options->RestTime,
    filters::Ports::AskedTime(outputVector->GetInformationObject(0)), inputVector);
}

int vtkMorphBoundary::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataObject* target = vtkDataObject::GetData(inputVector[2]);
  vtkPolyData* output = vtkPolyData::GetData(outputVector);
  vtkInternals& kept = *this->Internals;
  const filters::Ports::Task task = { "morph this mesh's boundary", this->Options->NumberOfThreads,
    this->Options->CoincidentPoints, [&] { kept.Results.Reset(); },
    [&](vtkUnstructuredGrid* grid, vtkDataObject* boundary, bool isDistributed,
      filters::Monitor& monitor)
    {
      filters::Time::WarnOfSeries(
        inputVector, outputVector->GetInformationObject(0), { "", "", "The target" }, monitor);
      isDistributed ? kept.MorphOnRanks(grid, boundary, target, output, monitor)
                    : kept.Morph(grid, boundary, target, output, monitor);
    },
    [&](vtkDataObject*, const char*) { kept.Results.Write(output); } };
  return kept.Ports.RequestData(task, inputVector, outputVector);
}

void vtkMorphBoundary::vtkInternals::Morph(vtkUnstructuredGrid* grid, vtkDataObject* boundary,
  vtkDataObject* target, vtkPolyData* output, filters::Monitor& monitor)
{
  this->Whole.reset();
  vtkPointSet* given = filters::Input::RequireBoundary(boundary);
  vtkPolyData* surface = target ? filters::Input::RequirePolyData(target, "The target") : nullptr;
  const morph::Mesh mesh = filters::GridMesh::FromGrid(grid);
  morph::requireVolumeCells(mesh);
  const morph::BoundaryFaces faces = morph::boundaryFaces(mesh, monitor);
  const std::vector<Index> bodyOfNode = morph::bodyOfNodes(mesh, morph::connectedComponents(mesh));
  const double size = morph::meshSize(mesh);
  const auto match = [&] {
    return filters::BoundaryMatch::Match(given, { mesh, faces, size }, this->Matching());
  };
  this->Run({ grid, mesh, faces, bodyOfNode, nullptr, size, match, surface }, output, monitor);
}

void vtkMorphBoundary::vtkInternals::MorphOnRanks(vtkUnstructuredGrid* piece,
  vtkDataObject* boundary, vtkDataObject* target, vtkPolyData* output, filters::Monitor& given)
{
  // All processes find the same, and the first one tells it.
  filters::Monitor silent(this->Filter, this->Filter->Options->NumberOfThreads);
  filters::Monitor& monitor = filters::Ranks::IsFirst() ? given : silent;
  if (!this->Whole)
  {
    this->Whole = filters::WholeSurface::Make();
  }
  const filters::WholeSurface& whole = *this->Whole;
  vtkPointSet* points = nullptr;
  vtkSmartPointer<vtkPolyData> surface;
  filters::Ranks::Together(
    [&]
    {
      points = filters::Input::RequireBoundary(boundary);
      surface = target ? filters::Input::RequirePolyData(target, "The target") : nullptr;
    });
  this->Whole->Take(piece, monitor);
  const morph::BoundaryTargets match = whole.Match(points, this->Matching());
  if (surface)
  {
    surface = whole.Gather(surface);
  }
  whole.together(
    [&]
    {
      const filters::GatheredSurface& all = whole.Boundary();
      this->Run({ all.Grid, all.Shell, all.Faces, all.BodyOfNode, &all.Orientation, whole.Size(),
                  [&match] { return match; }, surface },
        output, monitor);
      whole.KeepOwn(output);
    });
}

filters::BoundaryMatch::Options vtkMorphBoundary::vtkInternals::Matching() const
{
  filters::BoundaryMatch::Options matching;
  matching.BoundaryIdArray = this->Filter->Options->BoundaryIdArray;
  matching.displacementArray = this->Filter->Options->DisplacementArray;
  matching.scaleFactor = this->Filter->Options->ScaleFactor;
  matching.matchTolerance = this->Filter->Options->MatchTolerance;
  matching.fixUnnamedBoundary = false;
  return matching;
}

void vtkMorphBoundary::vtkInternals::Run(
  const Task& task, vtkPolyData* output, filters::Monitor& monitor)
{
  const morph::Mesh& mesh = task.Mesh;
  const morph::BoundaryFaces& faces = task.Faces;
  filters::Surface::WarnOfNone(faces, monitor);
  monitor.SetRange(0.1, 0.2);
  filters::Geometry::Options options;
  options.Take(*this->Filter->Options);
  options.FeaturesInside = this->Filter->Options->FeaturesInside;
  const morph::Classification geometry =
    filters::Geometry::Classify(task.Grid, mesh, faces, options, monitor);

  const morph::BoundaryTargets named = task.Match();
  for (const std::string& warning : named.warnings)
  {
    monitor.warn(warning);
  }
  const morph::BoundaryTargets match =
    upTo(named, geometry, this->Filter->Options->PrescribedDimension);

  morph::SurfaceMorphOptions how;
  how.method =
    static_cast<morph::SurfaceMorphOptions::Method>(this->Filter->Options->SurfaceMethod);
  how.neighbors = this->Filter->Options->NumberOfNeighbors;
  how.unattached = static_cast<morph::UnattachedMotion>(this->Filter->Options->UnattachedMotion);
  morph::BoundaryMotion motion =
    morph::beginMotion(mesh.points, task.BodyOfNode, faces, geometry, match.ids, match.targets);
  this->Results.SetInteger("GivenPoints", static_cast<vtkIdType>(match.ids.size()));
  this->Results.SetInteger("FixedVertices", motion.count(morph::BoundaryMotion::Held));
  this->Results.SetInteger("ProjectedPoints", 0);
  this->Results.SetInteger("UnprojectedPoints", 0);
  this->Results.SetInteger("SmoothedSurfaces", 0);
  this->Results.SetText("KeptSurfaces", "None");

  monitor.SetRange(0.2, 0.3);
  morph::morphCurves(geometry, how.unattached, motion, monitor);
  std::unique_ptr<morph::Target> place;
  morph::ProjectionReport onCurves, onSurfaces;
  if (task.Target)
  {
    monitor.SetRange(0.3, 0.4);
    std::string warning;
    place = filters::TargetData::Make(task.Target, mesh.points, task.Size,
      filters::TargetData::OptionsOf(*this->Filter->Options, task.Size), warning, monitor);
    if (!warning.empty())
    {
      monitor.warn(warning);
    }
    onCurves = morph::projectCurves(geometry, *place, motion, monitor);
  }
  monitor.SetRange(0.4, 0.7);
  const morph::SurfaceMorphReport report =
    morph::morphSurfaces(faces, geometry, how, motion, monitor);
  if (place)
  {
    monitor.SetRange(0.7, 0.9);
    const morph::Points moved = motion.moved();
    place->assign(geometry, moved);
    place->orient(moved, morph::surfaceNodeNormals(mesh.points, moved, faces, geometry));
    onSurfaces = morph::projectSurfaces(faces, geometry, *place, motion, monitor);
    this->ReportProjection(onCurves, onSurfaces, *place, monitor);
  }
  if (how.method != morph::SurfaceMorphOptions::Method::WeightedResidual)
  {
    morph::smoothSurfaces(faces, geometry, place.get(), motion, monitor);
  }
  if (how.method == morph::SurfaceMorphOptions::Method::MeshSmoothing)
  {
    monitor.SetRange(0.9, 0.95);
    const morph::SurfaceMeshSmoothing meshes = morph::smoothSurfaceMeshes(
      faces, geometry, place.get(), morph::SmoothedSurfaces::All, motion, monitor);
    std::vector<Index> better;
    for (const Index s : meshes.kept)
    {
      better.push_back(geometry.surfaces[s].id);
    }
    this->Results.SetInteger("SmoothedSurfaces", static_cast<vtkIdType>(meshes.smoothed.size()));
    this->Results.SetText("KeptSurfaces", better.empty() ? "None" : morph::listIds(better));
  }
  monitor.SetRange(0.95, 1);

  const bool isFloat =
    filters::Output::IsFloat(task.Grid, this->Filter->Options->OutputPointsPrecision);
  morph::Points moved = motion.moved();
  filters::Output::RequireWritable(mesh.points, moved, isFloat, "the boundary's nodes");
  if (isFloat)
  {
    moved = moved.cast<float>().cast<double>().eval();
  }
  const std::vector<Index> faceOf =
    filters::Surface::Write(task.Grid, mesh, faces, output, task.Orientation);
  filters::Geometry::AddPointArrays(geometry, faces.nodes, output->GetPointData());
  filters::Geometry::AddSurfaceIds(geometry, faceOf, output);
  writeMotion(mesh.points, moved, faces.nodes, isFloat, output);

  const morph::FaceQuality quality = morph::faceQuality(mesh.points, moved, faces, geometry);
  const std::vector<Index> folded = writeQuality(quality, faceOf, output);
  this->Results.SetNumber("MinScaledJacobian", quality.minimum);
  this->Results.SetNumber("MeanScaledJacobian", quality.mean);
  this->Results.SetInteger("FoldedFaces", static_cast<vtkIdType>(quality.folded.size()));
  this->Results.Write(output);
  warnOfNodes(monitor, folded,
    "Faces of the moved boundary are folded, and no cell behind them can be valid: the output's "
    "cell ids ");
  std::vector<Index> reflected;
  for (Index s : report.reflected)
  {
    reflected.push_back(geometry.surfaces[s].id);
  }
  warnOfNodes(monitor, reflected,
    "The curves' motion reflects or flattens surfaces, which follow the nearest rotation and scale "
    "instead: surface ids ");
}

void vtkMorphBoundary::vtkInternals::ReportProjection(const morph::ProjectionReport& onCurves,
  const morph::ProjectionReport& onSurfaces, const morph::Target& target, filters::Monitor& monitor)
{
  const auto both = [](const std::vector<Index>& a, const std::vector<Index>& b)
  { return static_cast<vtkIdType>(a.size()) + static_cast<vtkIdType>(b.size()); };
  this->Results.SetInteger("ProjectedPoints", both(onCurves.projected, onSurfaces.projected));
  this->Results.SetInteger("UnprojectedPoints",
    both(onCurves.missed, onCurves.kept) + both(onSurfaces.missed, onSurfaces.kept));
  if (target.hasFeatures())
  {
    warnOfNodes(monitor, onCurves.missed,
      "Curve nodes are not projected, since no feature edge of the target is within "
      "`TargetReach`: node ids ");
  }
  else
  {
    warnOfNodes(monitor, onCurves.missed,
      "Curve nodes are not projected, since the target has no feature edges (lower "
      "`FeatureAngle`?): "
      "node ids ");
  }
  warnOfNodes(monitor, onCurves.kept,
    "Curve nodes are not projected, since their curve would turn back: node ids ");
  warnOfNodes(monitor, onSurfaces.missed,
    "Surface nodes are not projected, since the target has no place within `TargetReach` "
    "whose normal is within `TargetAngle`: node ids ");
  warnOfNodes(
    monitor, onSurfaces.kept, "Surface nodes are not projected, since faces would fold: node ids ");
}

double vtkMorphBoundary::GetNumber(const char* name) const
{
  return this->Internals->Results.Number(name);
}

const char* vtkMorphBoundary::GetKeptSurfaces() const
{
  return this->Internals->Results.Text("KeptSurfaces").c_str();
}

vtkIdType vtkMorphBoundary::GetInteger(const char* name) const
{
  return this->Internals->Results.Integer(name);
}

void vtkMorphBoundary::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  this->PrintOptions(os, indent);
  this->Internals->Results.Print(os, indent);
}
