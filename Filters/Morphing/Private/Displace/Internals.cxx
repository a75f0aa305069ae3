// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/Internals.h"

#include "BoundaryMover/FitToTarget.h"
#include "BoundaryMover/Patches.h"
#include "Mesh/ShellLayer.h"
#include "Private/Data/AffineArrays.h"
#include "Private/Data/Arrays.h"
#include "Private/Data/GridMesh.h"
#include "Private/Data/Output.h"
#include "Private/Data/Surface.h"
#include "Private/Displace/DisplacedSurface.h"
#include "Private/Pipeline/Ranks.h"
#include "Private/Pipeline/Time.h"
#include "Private/Project/TargetDistance.h"
#include "Support/Error.h"
#include "Support/Lists.h"
#include "Support/Monitor.h"

#include <vtkAbstractTransform.h>
#include <vtkFieldData.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkSelection.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVariant.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <utility>

namespace filters = morph::filters;

using Surroundings = morph::Surroundings;

namespace
{
vtkMTimeType timeOf(vtkObject* object)
{
  return object ? object->GetMTime() : 0;
}

/// What each round of sliding has done.
void writeRounds(
  const std::vector<morph::SlidingWarp::Round>& rounds, double size, vtkFieldData* data)
{
  using Round = morph::SlidingWarp::Round;
  data->AddArray(filters::Arrays::MakeOf<vtkDoubleArray>(
    "SlideChange", rounds, [size](const Round& round) { return round.change / size; }));
  data->AddArray(filters::Arrays::MakeOf<vtkDoubleArray>(
    "SlideForce", rounds, [](const Round& round) { return round.force; }));
}

/// The pairs of the property or, where it is empty, of the file.
morph::PeriodicSides::Names periodicOf(std::string text, vtkPointSet* input)
{
  auto* ofFile =
    vtkStringArray::SafeDownCast(input->GetFieldData()->GetAbstractArray("PeriodicSurfaces"));
  const bool isOfFile = text.empty() && ofFile;
  for (vtkIdType i = 0; isOfFile && i < ofFile->GetNumberOfValues(); ++i)
  {
    text += ofFile->GetValue(i) + ";";
  }
  return morph::PeriodicSides::parse(text == "none" ? "" : text);
}

/// The patches of symmetry of the file that no property gives another role.
std::set<std::string> symmetricOf(const morph::DisplacementOptions& options, vtkPointSet* input)
{
  std::set<std::string> names;
  auto* ofFile =
    vtkStringArray::SafeDownCast(input->GetFieldData()->GetAbstractArray("SymmetrySurfaces"));
  for (vtkIdType i = 0; ofFile && i < ofFile->GetNumberOfValues(); ++i)
  {
    names.insert(ofFile->GetValue(i));
  }
  for (const auto* given :
    { &options.Surfaces, &options.FixedSurfaces, &options.SlidingSurfaces, &options.FreeSurfaces })
  {
    for (const std::string& name : *given)
    {
      names.erase(name);
    }
  }
  return names;
}

/// Throws morph::Error for a surface in two of the lists. One that moves may slide, too.
void requireOneRole(const morph::DisplacementOptions& options)
{
  using Names = std::set<std::string>;
  const bool areMoved = options.Moving == vtkDisplacementAlgorithm::MOVING_SURFACES;
  const auto require = [](const Names& first, const Names& second, const std::string& lists)
  {
    for (const std::string& name : first)
    {
      if (second.count(name) > 0)
      {
        throw morph::Error(
          "'" + name + "' is in " + lists + ", which contradict each other: take it out of one.");
      }
    }
  };
  const Names moved = areMoved ? options.Surfaces : Names();
  require(moved, options.FixedSurfaces, "`Surfaces` and `FixedSurfaces`");
  require(moved, options.FreeSurfaces, "`Surfaces` and `FreeSurfaces`");
  require(options.FixedSurfaces, options.SlidingSurfaces, "`FixedSurfaces` and `SlidingSurfaces`");
  require(options.FixedSurfaces, options.FreeSurfaces, "`FixedSurfaces` and `FreeSurfaces`");
  require(options.SlidingSurfaces, options.FreeSurfaces, "`SlidingSurfaces` and `FreeSurfaces`");
}

/// Whether all nodes of a shell move, not its edges alone.
bool movesAll(const morph::DisplacementOptions& options, bool hasTarget)
{
  return options.Moving == vtkDisplacementAlgorithm::MOVING_EVERYTHING ||
         (hasTarget && options.Moving == vtkDisplacementAlgorithm::MOVING_SURFACES &&
           options.Surfaces.empty());
}

/// The names of surfaces that have a role.
std::set<std::string> askedNames(const morph::DisplacementOptions& options)
{
  std::set<std::string> names;
  for (const auto* some : { &options.Surfaces, &options.FixedSurfaces, &options.SlidingSurfaces,
         &options.FreeSurfaces, &options.ContactSurfaces })
  {
    names.insert(some->begin(), some->end());
  }
  return names;
}

/// Throws for surfaces between blocks: their cells are gathered without their blocks.
void requireNoBlocks(const std::set<std::string>& names, const filters::InputBoundary& model)
{
  for (const std::string& name : names)
  {
    const bool isFound = std::any_of(model.innerSurfaces.begin(), model.innerSurfaces.end(),
      [&](const morph::InnerSurface& surface) { return surface.name == name; });
    if (name.find(" | ") != std::string::npos && !isFound)
    {
      throw morph::Error(
        "There is no surface '" + name +
        "'. On several MPI ranks a surface between blocks has no name: mark the parts by cell "
        "arrays, 1 in a part and 0 elsewhere, and name these.");
    }
  }
}

void writeGaps(
  const morph::Contact::Gaps& before, const morph::Contact::Gaps& after, vtkFieldData* data)
{
  auto gaps = filters::Arrays::Make<vtkDoubleArray>("ContactGaps", 0, 2);
  gaps->InsertNextTuple2(before.least, before.most);
  gaps->InsertNextTuple2(after.least, after.most);
  data->AddArray(gaps);
}
}

void vtkDisplacementAlgorithm::vtkInternals::ResetResults()
{
  this->Count.fill(0);
  this->SlideReport = this->ContactReport = "None";
  this->PresentDimension = 0;
  this->ControlPoints->Initialize();
  this->LatticePoints->Initialize();
  this->LatticePoints->SetNumberOfComponents(3);
}

void vtkDisplacementAlgorithm::vtkInternals::ClearList()
{
  this->SurfaceList->RemoveAllArrays();
  this->SurfaceSizes->Initialize();
  this->SurfaceShapes->Initialize();
  this->SurfaceBounds->Initialize();
  this->SurfaceBounds->SetNumberOfComponents(6);
  this->ZoneList->RemoveAllArrays();
  this->ZoneSizes->Initialize();
  this->ListedVersion = -1;
}

void vtkDisplacementAlgorithm::vtkInternals::List(const Options& options, vtkDataObject* input)
{
  filters::Monitor monitor(nullptr, options.NumberOfThreads);
  try
  {
    vtkDataObject* data = this->Blocks.Shell().Thicken(this->Blocks.Gather(
      input, options.CoincidentPoints, filters::GridMesh::UnknownCells::Refuse, monitor));
    monitor.TakeWarnings(); // the execution gives them
    auto* mesh = vtkPointSet::SafeDownCast(data);
    if (!mesh || mesh->GetNumberOfCells() == 0)
    {
      return;
    }
    this->Classify(
      options, filters::Input::RequireGridOrPolyData(mesh, "The input", this->Checked), monitor);
    const std::vector<std::string> warnings = monitor.TakeWarnings();
    this->Warnings.insert(this->Warnings.end(), warnings.begin(), warnings.end());
  }
  catch (const std::exception&)
  {
    // The execution raises the error again, and reports it.
    this->ClearList();
  }
}

void vtkDisplacementAlgorithm::vtkInternals::ListShapes()
{
  if (this->SurfaceShapes->GetNumberOfValues() > 0 || this->ListedVersion < 0)
  {
    return;
  }
  const std::vector<std::string> names = morph::patchNames(this->Model);
  const std::vector<std::string> shapes = morph::patchShapes(this->Model);
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    this->SurfaceShapes->InsertNextValue(names[i]);
    this->SurfaceShapes->InsertNextValue(shapes[i]);
  }
}

vtkDisplacementAlgorithm::vtkInternals::Inputs vtkDisplacementAlgorithm::vtkInternals::InputsOf(
  vtkInformationVector** inputVector)
{
  return { vtkSelection::GetData(inputVector[1]), vtkDataObject::GetData(inputVector[2]),
    vtkSelection::GetData(inputVector[3]), vtkDataObject::GetData(inputVector[4]),
    vtkDataObject::GetData(inputVector[5]) };
}

void vtkDisplacementAlgorithm::vtkInternals::WarnOfSeries(
  vtkInformationVector** inputVector, vtkInformation* output, morph::Monitor& monitor)
{
  morph::filters::Time::WarnOfSeries(inputVector, output,
    { "", "The selection", "The target", "The selection of the zone", "The control points",
      "The field" },
    monitor);
}

bool vtkDisplacementAlgorithm::vtkInternals::IsTeller() const
{
  return !this->Whole || filters::Ranks::IsFirst();
}

void vtkDisplacementAlgorithm::vtkInternals::Displace(const Options& options,
  const filters::Input::Mesh& mesh, const Inputs& inputs, vtkPolyData* output,
  morph::Monitor& monitor)
{
  vtkPointSet* input = nullptr;
  vtkPolyData* target = nullptr;
  const auto check = [&]
  {
    input = filters::Input::RequireGridOrPolyData(mesh.Data, "The input", this->Checked);
    const bool fits =
      options.Displacement == DISPLACEMENT_TARGET && options.Moving != MOVING_NOTHING;
    target = fits && inputs.Target ? filters::Input::RequirePolyData(inputs.Target, "The target")
                                   : nullptr;
    if (fits && !target && (mesh.IsDistributed || !mesh.IsElsewhere))
    {
      throw morph::Error("There is no target to move onto. Set one (Target, port 2): a surface, "
                         "from an STL file for instance.");
    }
  };
  if (mesh.IsDistributed)
  {
    filters::Ranks::Together(check);
    this->DisplaceOnRanks(options, input, inputs, target, output, monitor);
    return;
  }
  check();
  this->Whole.reset();
  auto* grid = vtkUnstructuredGrid::SafeDownCast(input);
  if (vtkPolyData* shell = this->WholeShell(options, grid, target))
  {
    Options whole = options;
    whole.Moving = MOVING_EVERYTHING;
    this->Displace(whole, shell, nullptr, inputs, target, output, monitor);
  }
  else if (!mesh.IsElsewhere)
  {
    this->Displace(options, input, grid, inputs, target, output, monitor);
  }
}

vtkPolyData* vtkDisplacementAlgorithm::vtkInternals::WholeShell(
  const Options& options, vtkUnstructuredGrid* grid, bool hasTarget)
{
  if (!grid || !movesAll(options, hasTarget) || filters::GridMesh::LayerOf(grid).nodes == 0)
  {
    return nullptr;
  }
  if (this->ShellOf != grid || this->ShellTime != grid->GetMTime())
  {
    const morph::Mesh mesh = filters::GridMesh::FromGrid(grid);
    morph::Monitor serial;
    this->IsShellClosed = morph::boundaryFaces(mesh, serial).nodes.empty();
    morph::BoundaryFaces faces = morph::frontFaces(mesh);
    faces.nodes =
      morph::consecutive(mesh.layer.nodes); // of the input, so that messages have its ids
    this->Shell = vtkSmartPointer<vtkPolyData>::New();
    filters::Surface::Write(grid, mesh, faces, this->Shell);
    this->ShellOf = grid;
    this->ShellTime = grid->GetMTime();
  }
  return hasTarget || this->IsShellClosed ? this->Shell : nullptr;
}

void vtkDisplacementAlgorithm::vtkInternals::Classify(
  const Options& options, vtkPointSet* input, morph::Monitor& monitor)
{
  filters::InputBoundary::Options geometry;
  geometry.Take(options);
  geometry.Names = askedNames(options);
  geometry.Blocks = this->Whole ? nullptr : this->Blocks.Merged();
  geometry.Whole = this->Whole ? &this->Whole->Boundary() : nullptr;
  const int before = this->Model.ClassifyCount();
  this->Model.Update(input, geometry, monitor);
  if (this->Whole && this->Blocks.Merged())
  {
    requireNoBlocks(geometry.Names, this->Model);
  }
  if (this->Model.ClassifyCount() != before)
  {
    this->Warnings.clear();
  }
  if (this->ListedVersion == this->Model.inputVersion)
  {
    return;
  }
  this->ClearList();
  for (const morph::PatchSize& size : morph::patchSizes(this->Model))
  {
    this->SurfaceList->AddArray(size.name.c_str(), false);
    this->SurfaceSizes->InsertNextValue(size.name);
    this->SurfaceSizes->InsertNextValue(
      std::to_string(size.count) + (size.isInner ? " inner" : ""));
    this->SurfaceSizes->InsertNextValue(vtkVariant(size.measure).ToString());
    const auto &low = size.box.min(), &high = size.box.max();
    this->SurfaceBounds->InsertNextTuple6(low[0], high[0], low[1], high[1], low[2], high[2]);
  }
  this->ListZones();
  this->ListedVersion = this->Model.inputVersion;
}

void vtkDisplacementAlgorithm::vtkInternals::Choose(
  const Options& options, vtkPointSet* input, vtkSelection* selection)
{
  filters::Chosen::Options by;
  by.How = static_cast<filters::Chosen::By>(options.Moving);
  by.FixedSurfaces = options.FixedSurfaces;
  if (options.Moving == MOVING_SELECTION)
  {
    selection = this->Selected.OfGrid(this->Blocks, selection, this->Extractor);
    by.Selection = selection;
    by.SelectionTime = timeOf(selection);
    by.Extractor = this->Extractor;
    by.IsSelected = this->Whole ? &this->IsSelected : nullptr;
  }
  else if (options.Moving == MOVING_SURFACES)
  {
    const bool byTarget = options.Surfaces.empty() && options.Displacement == DISPLACEMENT_TARGET;
    by.Surfaces =
      byTarget ? morph::surfacesNearest(*this->Fit.Get(), this->Model) : options.Surfaces;
  }
  else if (options.Moving == MOVING_REGION)
  {
    by.Region = this->Region;
    by.RegionTime = timeOf(this->Region);
  }
  else if (options.Moving == MOVING_ARRAY)
  {
    by.ArrayName = options.MovingArray;
  }
  if (this->ChosenVersion != this->Model.inputVersion || !(this->ChosenBy == by))
  {
    this->ChosenVersion = -1; // in case the choice throws
    this->Choice = filters::Chosen::Choose(input, this->Model, by);
    this->ChosenVersion = this->Model.inputVersion;
    this->ChosenBy = by;
    ++this->ChooseCount;
  }
}

void vtkDisplacementAlgorithm::vtkInternals::WriteDistances(
  const Surroundings::Result& result, vtkPolyData* output)
{
  std::vector<morph::Index> points, nodes;
  for (std::size_t i = 0; i < this->Model.NodeOfPoint().size(); ++i)
  {
    const morph::Index node = this->Model.NodeOfPoint()[i];
    if (result.roles[node] == Surroundings::Moves)
    {
      points.push_back(static_cast<morph::Index>(i));
      nodes.push_back(node);
    }
  }
  filters::TargetDistance::Write(this->Fit.Surface(), points,
    this->Model.points()(nodes, morph::allColumns), result.moved(nodes, morph::allColumns), output);
}

bool vtkDisplacementAlgorithm::vtkInternals::FindMoving(const Options& options, vtkPointSet* input,
  const Inputs& inputs, vtkPolyData* target, Moves& moves, morph::Monitor& monitor)
{
  try
  {
    morph::ProgressRange classifying(monitor, 0, 0.5);
    this->Classify(options, input, classifying);
  }
  catch (...)
  {
    this->ClearList();
    throw;
  }
  requireOneRole(options);
  for (const std::string& warning : std::exchange(this->Warnings, {}))
  {
    monitor.warn(warning);
  }
  filters::Surface::WarnOfNone(this->Model.faces, monitor);
  if (this->Model.faces.nodes.empty())
  {
    return false;
  }
  Surroundings::Options& rest = moves.Mover.rest;
  rest.sliding = morph::surfacesNamed(this->Model, options.SlidingSurfaces, "SlidingSurfaces");
  const morph::SymmetryPlanes planes =
    morph::symmetryPlanes(this->Model, symmetricOf(options, input));
  rest.sliding.insert(rest.sliding.end(), planes.surfaces.begin(), planes.surfaces.end());
  morph::sortUnique(rest.sliding);
  for (const std::string& name : planes.others)
  {
    monitor.warn("The patch '" + name +
                 "' is one of symmetry, but it is not flat, or a part of a surface, so that its "
                 "nodes follow what moves and may leave it. Name it under `SlidingSurfaces`, "
                 "`FixedSurfaces` or `FreeSurfaces`.");
  }
  if (target)
  {
    morph::ProgressRange fitting(monitor, 0.5, 0.7);
    moves.Given = this->Fitted(options, input, inputs.Selection, target, rest.sliding, fitting);
  }
  else
  {
    this->Choose(options, input, inputs.Selection);
  }
  return true;
}

void vtkDisplacementAlgorithm::vtkInternals::Prepare(const Options& options, vtkPointSet* input,
  const Inputs& inputs, morph::Points field, Moves& moves, morph::Monitor& monitor)
{
  Surroundings::Options& rest = moves.Mover.rest;
  filters::Motion::Options& motion = moves.Motion;
  motion = { options, this->Transform, &moves.Given };
  moves.Choice = this->Choice;
  const bool movesAny = !moves.Choice.moving.empty();
  const bool byArray = options.Displacement == DISPLACEMENT_ARRAY;
  if (movesAny && (options.Displacement == DISPLACEMENT_HANDLES ||
                    options.Displacement == DISPLACEMENT_LATTICE))
  {
    moves.Given =
      this->ByControlPoints(options, input, inputs.Selection, inputs.ControlPoints, monitor);
  }
  else if (movesAny && (byArray || options.Displacement == DISPLACEMENT_FIELD))
  {
    morph::Points by =
      byArray ? filters::Motion::OfArray(input, motion, moves.Choice) : std::move(field);
    rest.freeNodes = filters::Motion::TakeMissing(by, motion, moves.Choice, monitor);
    moves.Given = this->Model.points()(moves.Choice.moving, morph::allColumns) + by;
  }
  monitor.check();
  moves.Targets =
    filters::Motion::Targets(this->Model, moves.Choice, motion, &this->PresentDimension);
  if (motion.Displacement == DISPLACEMENT_ALONG_NORMALS)
  {
    // In a plane of symmetry the facets on its other side count, too.
    const morph::TargetRim rim(this->Model, moves.Choice, rest.sliding, this->Mover.surroundings());
    for (std::size_t i = 0; i < moves.Choice.moving.size(); ++i)
    {
      const morph::Index node = moves.Choice.moving[i];
      auto target = moves.Targets.row(static_cast<morph::Index>(i));
      const Eigen::RowVector3d from = this->Model.points().row(node), step = target - from;
      if (rim.has(node) && step.norm() > 0)
      {
        target = from + step.norm() * rim.along(node, step.normalized());
      }
    }
  }

  rest.how = static_cast<Surroundings::Kind>(options.Surroundings);
  rest.follow.method = static_cast<morph::SurfaceMorphOptions::Method>(options.SurfaceMethod);
  rest.follow.unattached = static_cast<morph::UnattachedMotion>(options.UnattachedMotion);
  rest.free = morph::surfacesNamed(this->Model, options.FreeSurfaces, "FreeSurfaces");
  morph::Contact::Options contact;
  contact.distance = options.ContactDistance;
  contact.surfaces = morph::surfacesNamed(this->Model, options.ContactSurfaces, "ContactSurfaces");
  morph::PeriodicSides::Names periodic = periodicOf(options.PeriodicSurfaces, input);
  if (options.Moving != MOVING_NOTHING)
  {
    moves.Mover.contact = std::move(contact);
    moves.Mover.periodic = std::move(periodic);
    moves.Mover.slide.rounds = options.SlideRounds;
    if (this->IsDragged)
    {
      moves.Mover.slide.tolerance = DragTolerance;
    }
  }
  for (const morph::Index sheet : this->Model.sheets())
  {
    if (std::count(rest.sliding.begin(), rest.sliding.end(), sheet) == 0)
    {
      rest.free.push_back(sheet); // twice does no harm
    }
  }
  std::sort(rest.free.begin(), rest.free.end());
  rest.radius = options.FalloffRadius * this->Model.size;
}

void vtkDisplacementAlgorithm::vtkInternals::Displace(const Options& options, vtkPointSet* input,
  vtkUnstructuredGrid* grid, const Inputs& inputs, vtkPolyData* target, vtkPolyData* output,
  morph::Monitor& monitor)
{
  const filters::WholeSurface* whole = this->Whole.get();
  // What the boundary alone decides is the same on all processes.
  const auto alike = [whole](const std::function<void()>& work)
  { whole ? whole->Together(work) : work(); };
  Moves moves;
  bool hasBoundary = false;
  filters::Zones::Options zones;
  alike([&] { hasBoundary = this->FindMoving(options, input, inputs, target, moves, monitor); });
  if (!hasBoundary)
  {
    return;
  }
  morph::Points field;
  if (options.Displacement == DISPLACEMENT_FIELD && !this->Choice.moving.empty())
  {
    field = this->ByField(options, inputs.Field, monitor);
  }
  alike(
    [&]
    {
      this->Prepare(options, input, inputs, std::move(field), moves, monitor);
      zones = this->ZoneOptions(options, inputs.Zone);
    });
  if (options.Moving != MOVING_NOTHING)
  {
    this->FindInner(options, grid, zones, moves.Mover);
  }
  const std::unique_ptr<morph::InnerPieces> pieces = whole ? whole->Volume() : nullptr;
  morph::ProgressRange moving(monitor, target ? 0.7 : 0.5, 1);
  this->Mover.move(this->Model, moves.Choice, moves.Targets, moves.Mover, pieces.get(), moving);
  alike([&] { this->Write(options, input, target, moves, output, monitor); });
  if (moves.Mover.hasInner())
  {
    alike([&] { this->AppendInner(grid, output); });
  }
  this->CountRoles(grid, moves.Mover.hasInner());
}

void vtkDisplacementAlgorithm::vtkInternals::Write(const Options& options, vtkPointSet* input,
  bool isFitted, const Moves& moves, vtkPolyData* output, morph::Monitor& monitor)
{
  const morph::BoundaryMover::Options& mover = moves.Mover;
  const Surroundings::Result& result = this->Mover.result();
  const std::vector<morph::Index> faces =
    morph::collapsedFaces(this->Model, moves.Choice, result.moved);
  std::vector<morph::Index> collapsed; // cells of the output
  for (std::size_t p = 0; p < this->Model.FaceOfPolygon().size(); ++p)
  {
    if (std::binary_search(faces.begin(), faces.end(), this->Model.FaceOfPolygon()[p]))
    {
      collapsed.push_back(this->Model.FirstPolygon() + static_cast<morph::Index>(p));
    }
  }
  if (!collapsed.empty())
  {
    monitor.warn(
      "The motion leaves faces of the boundary without area, and no cell behind them can "
      "be valid: the output's cell ids " +
      morph::listIds(collapsed) + (isFitted ? "." : ". Is a scale zero?"));
  }
  if (mover.hasInner())
  {
    filters::Output::RequireWritable(this->Mover.inner().rest(this->Model), result.moved,
      filters::Output::IsFloat(input, options.OutputPointsPrecision), "nodes");
  }
  filters::DisplacedSurface::Write(
    this->Model, result, input, options.OutputPointsPrecision, output);
  if (mover.slide.rounds > 0)
  {
    writeRounds(this->Mover.rounds().rounds(), this->Model.size, output->GetFieldData());
    this->SlideReport = this->Mover.rounds().report(this->Model.size);
  }
  if (mover.contact.distance > 0)
  {
    const morph::Contact& contact = this->Mover.contact();
    const morph::Contact::Gaps before = contact.gaps(this->Model, this->Model.points());
    const morph::Contact::Gaps after = contact.gaps(this->Model, result.moved);
    writeGaps(before, after, output->GetFieldData());
    this->ContactReport = contact.report(before, after);
  }
  if (mover.hasInner() || mover.slide.rounds > 0 || mover.contact.distance > 0 ||
      !mover.periodic.empty())
  {
    filters::AffineArrays::Remove(output);
  }
  else
  {
    this->Fields.Write(this->Model, this->Choice, moves.Motion, moves.Mover.rest, result,
      this->Mover.surroundings(), output, monitor);
  }
  if (isFitted)
  {
    this->WriteDistances(result, output);
  }
  this->Displaced->ShallowCopy(output);
  if (this->Whole)
  {
    this->Whole->KeepOwn(output);
  }
}

void vtkDisplacementAlgorithm::vtkInternals::CountRoles(vtkUnstructuredGrid* grid, bool hasInner)
{
  const std::vector<signed char>& roles = this->Mover.result().roles;
  std::array<morph::Index, Surroundings::IsLayer + 1> inside = {};
  const auto whole = static_cast<std::size_t>(this->Model.points().rows());
  // Without inner nodes all nodes inside stay. On ranks the model has the boundary's nodes alone.
  const morph::Index front = this->Model.mesh.layer.nodes; // whose images do not count
  const auto count = [&](morph::Index node)
  { this->Count[roles[node]] += front == 0 || node < front; };
  for (std::size_t i = 0; hasInner && i < whole; ++i)
  {
    count(static_cast<morph::Index>(i));
  }
  for (std::size_t i = 0; !hasInner && i < this->Model.faces.nodes.size(); ++i)
  {
    count(this->Model.faces.nodes[i]);
  }
  // All processes have the nodes of the boundary, and each has its own inner ones behind them.
  const morph::Index ownFront = hasInner ? filters::GridMesh::LayerOf(grid).nodes : 0;
  std::vector<morph::Index> beyond =
    morph::consecutive(roles.size() - whole, static_cast<morph::Index>(whole));
  const std::vector<morph::Index> points = this->Mover.inner().pointsOf(this->Model, beyond);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    inside[roles[beyond[i]]] += ownFront == 0 || points[i] < ownFront;
  }
  filters::RankGroup(this->Whole != nullptr).Sum(inside.data(), inside.size());
  for (std::size_t role = 0; role < inside.size(); ++role)
  {
    this->Count[role] += static_cast<vtkIdType>(inside[role]);
  }
}

/// A selection's ids are those of a process's piece, so each process evaluates its own.
void vtkDisplacementAlgorithm::vtkInternals::SelectOnRanks(
  vtkUnstructuredGrid* piece, vtkSelection* selection)
{
  const bool hasAny = selection && selection->GetNumberOfNodes() > 0;
  const bool isAnywhere = filters::Ranks::Count(hasAny) > 0;
  std::vector<std::uint8_t> isSelected;
  filters::Ranks::Together(
    [&]
    {
      if (hasAny || !isAnywhere) // which throws
      {
        selection = this->Selected.OfGrid(this->Blocks, selection, this->Extractor);
        isSelected = filters::Selection::Points(piece, selection, this->Extractor);
      }
    });
  this->IsSelected = this->Whole->AnyFlags(isSelected);
  this->ChosenVersion = -1;
}

void vtkDisplacementAlgorithm::vtkInternals::DisplaceOnRanks(const Options& options,
  vtkPointSet* input, const Inputs& inputs, vtkPolyData* target, vtkPolyData* output,
  morph::Monitor& monitor)
{
  auto* piece = vtkUnstructuredGrid::SafeDownCast(input);
  filters::Ranks::Together(
    [&]
    {
      if (!piece)
      {
        throw morph::Error("A boundary on several MPI ranks cannot be displaced again: "
                           "vtkBoundaryDisplacement takes the volume mesh there.");
      }
    });
  if (!this->Whole)
  {
    this->Whole = filters::WholeSurface::Make();
  }
  const auto needsAll = [&]
  {
    const filters::GatheredSurface& boundary = this->Whole->Boundary();
    const bool isShell = boundary.Shell.layer.nodes > 0;
    return (isShell && movesAll(options, target) && (target || boundary.Faces.nodes.empty())) ||
           filters::InputBoundary::LieInside(boundary, askedNames(options));
  };
  this->Whole->Take(piece, monitor, needsAll);
  const bool byHandles = options.Displacement == DISPLACEMENT_HANDLES;
  if (options.Moving == MOVING_SELECTION ||
      (options.Moving != MOVING_NOTHING && byHandles && options.SelectedHandles))
  {
    this->SelectOnRanks(piece, inputs.Selection);
  }
  vtkSmartPointer<vtkPolyData> whole, control;
  if (target)
  {
    whole = this->Whole->Gather(target);
  }
  if (filters::Ranks::Count(inputs.ControlPoints) > 0 &&
      (byHandles || options.Displacement == DISPLACEMENT_LATTICE))
  {
    filters::Ranks::Together(
      [&]
      {
        control = byHandles
                    ? filters::ControlPoints::AsHandles(inputs.ControlPoints)
                    : filters::ControlPoints::AsLattice(inputs.ControlPoints, options.LatticeSize);
      });
    control = this->Whole->Gather(control);
  }
  const Inputs gathered{ inputs.Selection, nullptr, inputs.Zone, control, inputs.Field };
  vtkUnstructuredGrid* grid = this->Whole->Boundary().Grid;
  vtkPolyData* shell = nullptr;
  if (this->Whole->Boundary().HasAll)
  {
    this->Whole->Together([&] { shell = this->WholeShell(options, grid, target); });
  }
  Options all = options;
  all.Moving = shell ? MOVING_EVERYTHING : options.Moving;
  this->Displace(all, shell ? static_cast<vtkPointSet*>(shell) : grid, shell ? nullptr : piece,
    gathered, whole, output, monitor);
}
