// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/Internals.h"

#include "BoundaryMorphing/LatticeMotion.h"
#include "BoundaryMover/FitToTarget.h"
#include "BoundaryMover/Patches.h"
#include "Private/Data/AffineArrays.h"
#include "Private/Data/Output.h"
#include "Private/Data/Surface.h"
#include "Private/Displace/DisplacedSurface.h"
#include "Private/Displace/InnerPoints.h"
#include "Private/Displace/Selection.h"
#include "Private/Displace/Zones.h"
#include "Private/Distributed/WholeVolume.h"
#include "Private/Options.h"
#include "Private/Pipeline/Input.h"
#include "Private/Pipeline/Ranks.h"
#include "Private/Project/TargetDistance.h"
#include "Support/Error.h"

#include <vtkAbstractTransform.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkSelection.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVariant.h>

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

namespace filters = morph::filters;

namespace
{
vtkMTimeType timeOf(vtkObject* object)
{
  return object ? object->GetMTime() : 0;
}

std::vector<std::uint8_t> layerCells(vtkUnstructuredGrid* grid, const std::string& name)
{
  vtkDataArray* array = grid->GetCellData()->GetArray(name.c_str());
  if (!array || array->GetNumberOfTuples() != grid->GetNumberOfCells())
  {
    throw morph::Error("LayersArray names '" + name + "', which is no cell array of the input.");
  }
  return filters::Chosen::Marked(array);
}

/// What each round of sliding has done.
void writeRounds(
  const std::vector<morph::SlidingWarp::Round>& rounds, double size, vtkFieldData* data)
{
  vtkNew<vtkDoubleArray> change, force;
  change->SetName("SlideChange");
  force->SetName("SlideForce");
  for (const morph::SlidingWarp::Round& round : rounds)
  {
    change->InsertNextValue(round.change / size);
    force->InsertNextValue(round.force);
  }
  data->AddArray(change);
  data->AddArray(force);
}

/// The direction of a projection along one; zero: the normals.
Eigen::RowVector3d directionOf(int projectAlong, const std::array<double, 3>& vector)
{
  if (projectAlong == vtkDisplacementAlgorithm::PROJECT_ALONG_NORMAL)
  {
    return Eigen::RowVector3d::Zero();
  }
  if (projectAlong != vtkDisplacementAlgorithm::PROJECT_ALONG_VECTOR)
  {
    return Eigen::RowVector3d::Unit(projectAlong - vtkDisplacementAlgorithm::PROJECT_ALONG_X);
  }
  // Of any size, without overflow.
  const Eigen::RowVector3d direction(vector[0], vector[1], vector[2]);
  if (direction.isZero(0))
  {
    throw morph::Error("ProjectVector has no length. Give the direction in which nodes are to go "
                       "to the target.");
  }
  return direction / direction.cwiseAbs().maxCoeff();
}
}

void vtkBoundaryDisplacement::vtkInternals::Classify(
  const vtkBoundaryDisplacement* filter, vtkPointSet* input, filters::Monitor& monitor)
{
  filters::Geometry::Options options;
  options.FeatureAngle = filter->Options->FeatureAngle;
  options.CornerAngle = filter->Options->CornerAngle;
  options.SurfaceIdArray = filters::Input::ArrayName(filter->Options->SurfaceIdArray);
  options.UseGeometryArrays = filter->Options->UseGeometryArrays;
  const int before = this->Model.ClassifyCount();
  this->Model.Update(input, options, monitor, this->Whole.get());
  if (this->Model.ClassifyCount() != before)
  {
    this->Warnings = monitor.TakeWarnings();
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
  auto* grid = vtkUnstructuredGrid::SafeDownCast(input);
  if (grid && !this->Whole)
  {
    this->ListZones(grid, this->Model.mesh);
  }
  this->ListedVersion = this->Model.inputVersion;
}

void vtkBoundaryDisplacement::vtkInternals::ListZones(
  vtkUnstructuredGrid* grid, const morph::Mesh& mesh)
{
  const filters::MergedBlocks* blocks =
    this->OuterBlocks ? this->OuterBlocks : this->Blocks.Merged();
  for (const filters::Zones::Listed& zone : filters::Zones::List(grid, mesh, blocks))
  {
    this->ZoneList->AddArray(zone.Name.c_str(), false);
    this->ZoneSizes->InsertNextValue(zone.Name);
    for (const morph::Index count : { zone.Cells, zone.Nodes })
    {
      this->ZoneSizes->InsertNextValue(count > 0 ? std::to_string(count) : "");
    }
  }
}

void vtkBoundaryDisplacement::Choose(vtkPointSet* input, vtkSelection* selection)
{
  vtkInternals& own = *this->Internals;
  filters::Chosen::Options options;
  options.How = static_cast<filters::Chosen::By>(this->Options->Moving);
  options.FixedSurfaces = this->Options->FixedSurfaces;
  if (this->Options->Moving == MOVING_SELECTION)
  {
    selection = own.Selected.OfGrid(own.Blocks, selection, own.Extractor);
    options.Selection = selection;
    options.SelectionTime = timeOf(selection);
    options.Extractor = own.Extractor;
    options.IsSelected = own.Whole ? &own.IsSelected : nullptr;
  }
  else if (this->Options->Moving == MOVING_SURFACES)
  {
    const bool byTarget =
      this->Options->Surfaces.empty() && this->Options->Displacement == DISPLACEMENT_TARGET;
    options.Surfaces =
      byTarget ? morph::surfacesNearest(*own.Fit.Get(), own.Model) : this->Options->Surfaces;
  }
  else if (this->Options->Moving == MOVING_REGION)
  {
    options.Region = own.Region;
    options.RegionTime = timeOf(own.Region);
  }
  else if (this->Options->Moving == MOVING_ARRAY)
  {
    options.ArrayName = filters::Input::ArrayName(this->Options->MovingArray);
  }
  if (own.ChosenVersion != own.Model.inputVersion || !(own.ChosenBy == options))
  {
    own.ChosenVersion = -1; // in case the choice throws
    own.Choice = filters::Chosen::Choose(input, own.Model, options);
    own.ChosenVersion = own.Model.inputVersion;
    own.ChosenBy = options;
    ++this->ChooseCount;
  }
}

morph::Points vtkBoundaryDisplacement::vtkInternals::Fitted(vtkBoundaryDisplacement* filter,
  vtkPointSet* input, vtkSelection* selection, vtkPolyData* target,
  const std::vector<morph::Index>& sliding, filters::Monitor& monitor)
{
  const bool align = filter->Options->AlignTarget;
  morph::Target::Options options;
  options.featureAngle = filter->Options->FeatureAngle;
  options.normalAngle = filter->Options->TargetAngle;
  options.reach = filter->Options->TargetReach * this->Model.size;
  morph::FitOptions how;
  if (filter->Options->ProjectAlong != PROJECT_ALONG_CLOSEST_POINT)
  {
    how.project = morph::FitOptions::Project::Along;
    how.direction = directionOf(filter->Options->ProjectAlong, filter->Options->ProjectVector);
  }
  if (filter->Options->Moving == MOVING_SURFACES && filter->Options->Surfaces.empty())
  {
    this->Fit.Update(target, this->Model, nullptr, align, options, monitor);
    filter->Choose(input, selection);
  }
  else
  {
    filter->Choose(input, selection);
    this->Fit.Update(target, this->Model, &this->Choice, align, options, monitor);
  }
  if (!this->Fit.GetWarning().empty())
  {
    monitor.warn(this->Fit.GetWarning());
  }
  return morph::fittedTo(
    *this->Fit.Get(), this->Model, this->Choice, sliding, how, this->Mover.surroundings(), monitor);
}

std::vector<morph::Handle> vtkBoundaryDisplacement::vtkInternals::SelectedHandles(
  const vtkBoundaryDisplacement* filter, vtkPointSet* input, vtkSelection* selection)
{
  std::vector<std::uint8_t> isSelected = this->IsSelected;
  if (!this->Whole)
  {
    selection = this->Selected.OfGrid(this->Blocks, selection, this->Extractor);
    isSelected = filters::Selection::Points(input, selection, this->Extractor);
  }
  std::vector<morph::Handle> handles;
  for (const morph::Index node : this->Model.faces.nodes)
  {
    if (isSelected[node])
    {
      const auto& v = filter->Options->Vector;
      handles.push_back(
        { this->Model.points().row(node), { v[0], v[1], v[2] }, filter->Options->HandleRadius });
    }
  }
  return handles;
}

morph::Points vtkBoundaryDisplacement::vtkInternals::ByControlPoints(
  const vtkBoundaryDisplacement* filter, vtkPointSet* input, vtkSelection* selection,
  vtkDataObject* points, filters::Monitor& monitor)
{
  const morph::Points from = this->Model.points()(this->Choice.moving, morph::allColumns);
  if (filter->Options->Displacement == DISPLACEMENT_HANDLES)
  {
    std::vector<morph::Handle> handles = filters::ControlPoints::Handles(points, this->Handles);
    if (filter->Options->SelectedHandles)
    {
      const std::vector<morph::Handle> more = this->SelectedHandles(filter, input, selection);
      handles.insert(handles.end(), more.begin(), more.end());
    }
    return from + morph::HandleMotion(handles).displacements(from, monitor);
  }
  morph::LatticeMotion lattice;
  lattice.basis = static_cast<morph::LatticeMotion::Basis>(filter->Options->LatticeBasis);
  lattice.size = filter->Options->LatticeSize;
  if (filter->Options->AutoLattice && from.rows() > 0)
  {
    lattice.low = from.colwise().minCoeff();
    lattice.high = from.colwise().maxCoeff();
  }
  else
  {
    const auto& b = filter->Options->LatticeBounds;
    lattice.low << b[0], b[2], b[4];
    lattice.high << b[1], b[3], b[5];
    if ((lattice.high.array() < lattice.low.array()).any())
    {
      throw morph::Error("LatticeBounds have a minimum above its maximum. Give xmin, xmax, ymin, "
                         "ymax, zmin, zmax.");
    }
  }
  lattice.controlDisplacements =
    filters::ControlPoints::Lattice(points, this->LatticeDisplacements, lattice.size);
  return from + lattice.displacements(from, monitor);
}

filters::Zones::Options vtkBoundaryDisplacement::vtkInternals::ZoneOptions(
  const vtkBoundaryDisplacement* filter, vtkSelection* zone)
{
  filters::Zones::Options options;
  options.Fixed = filter->Options->FixedZones;
  options.Rigid = filter->Options->RigidZones;
  options.Region = this->ZoneRegion;
  options.RegionKind = filter->Options->ZoneRegionType;
  options.SelectionKind = filter->Options->ZoneSelectionType;
  if (filter->Options->ZoneSelectionType != ZONE_NONE)
  {
    options.Selection = this->ZoneSelected.OfGrid(this->Blocks, zone, this->Extractor);
  }
  options.Extractor = this->Extractor;
  return options;
}

void vtkBoundaryDisplacement::vtkInternals::FindInner(const vtkBoundaryDisplacement* filter,
  vtkUnstructuredGrid* grid, const filters::Zones::Options& zones,
  morph::BoundaryMover::Options& options)
{
  options.inner.keepLayers = filter->Options->KeepLayers;
  options.inner.layersName = filters::Input::ArrayName(filter->Options->LayersArray);
  if (!zones.Any() && options.inner.keepLayers == 0)
  {
    return;
  }
  if (!grid)
  {
    throw morph::Error("Zones and layers have inner nodes, and the input is a surface. Give the "
                       "volume mesh to this filter.");
  }
  const filters::MergedBlocks* blocks =
    this->OuterBlocks ? this->OuterBlocks : this->Blocks.Merged();
  const auto find = [&](filters::Zones::Kind kind)
  {
    const std::vector<filters::Zones::Part> parts =
      this->Whole
        ? filters::Zones::FindOnRanks(kind, grid, filters::WholeVolume(*this->Whole), blocks, zones)
        : filters::Zones::Find(kind, grid, this->Model.mesh, blocks, zones);
    return std::vector<morph::Zone>(parts.begin(), parts.end());
  };
  options.fixedZones = find(filters::Zones::Fixed);
  options.rigidZones = find(filters::Zones::Rigid);
  if (this->RigidTransform)
  {
    options.inner.rigid = [this, factor = filter->Options->ScaleFactor](
                            const Eigen::RowVector3d& x) -> Eigen::RowVector3d
    {
      Eigen::RowVector3d to;
      this->RigidTransform->TransformPoint(x.data(), to.data());
      return factor == 1 ? to : Eigen::RowVector3d(x + factor * (to - x));
    };
  }
  const auto takeLayers = [&]
  {
    // Of several processes those without cells have no arrays.
    if (!options.inner.layersName.empty() && !(this->Whole && grid->GetNumberOfCells() == 0))
    {
      options.inner.isLayer = layerCells(grid, options.inner.layersName);
    }
  };
  this->Whole ? filters::Ranks::Together(takeLayers) : takeLayers();
}

void vtkBoundaryDisplacement::vtkInternals::WriteDistances(
  const morph::Surroundings::Result& result, vtkPolyData* output)
{
  std::vector<morph::Index> points, nodes;
  for (std::size_t i = 0; i < this->Model.NodeOfPoint().size(); ++i)
  {
    const morph::Index node = this->Model.NodeOfPoint()[i];
    if (result.roles[node] == morph::Surroundings::Moves)
    {
      points.push_back(static_cast<morph::Index>(i));
      nodes.push_back(node);
    }
  }
  filters::TargetDistance::Write(this->Fit.Surface(), points,
    this->Model.points()(nodes, morph::allColumns), result.moved(nodes, morph::allColumns), output);
}

bool vtkBoundaryDisplacement::vtkInternals::Prepare(vtkBoundaryDisplacement* filter,
  vtkPointSet* input, const Extras& extras, Moves& moves, filters::Monitor& monitor)
{
  try
  {
    monitor.SetRange(0, 0.5);
    this->Classify(filter, input, monitor);
  }
  catch (...)
  {
    this->ClearList();
    throw;
  }
  for (const std::string& warning : this->Warnings)
  {
    monitor.warn(warning);
  }
  this->Warnings.clear();
  filters::Surface::WarnOfNone(this->Model.faces, monitor);
  if (this->Model.faces.nodes.empty())
  {
    return false;
  }
  morph::Surroundings::Options& rest = moves.Rest;
  rest.sliding =
    morph::surfacesNamed(this->Model, filter->Options->SlidingSurfaces, "SlidingSurfaces");
  if (extras.Target)
  {
    monitor.SetRange(0.5, 0.7);
    moves.Given =
      this->Fitted(filter, input, extras.Selection, extras.Target, rest.sliding, monitor);
  }
  else
  {
    filter->Choose(input, extras.Selection);
  }
  const bool byPoints = filter->Options->Displacement == DISPLACEMENT_HANDLES ||
                        filter->Options->Displacement == DISPLACEMENT_LATTICE;
  if (byPoints && !this->Choice.moving.empty())
  {
    moves.Given =
      this->ByControlPoints(filter, input, extras.Selection, extras.ControlPoints, monitor);
  }
  monitor.check();

  filters::Motion::Options& motion = moves.Motion;
  motion = { *filter->Options, this->Transform, &moves.Given };
  moves.Choice = this->Choice;
  moves.Rest.freeNodes = filters::Motion::TakeMissing(input, motion, moves.Choice, monitor);
  moves.Targets = filters::Motion::Targets(input, this->Model, moves.Choice, motion);
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

  rest.how = static_cast<morph::Surroundings::Kind>(filter->Options->Surroundings);
  rest.follow.method =
    static_cast<morph::SurfaceMorphOptions::Method>(filter->Options->SurfaceMethod);
  rest.follow.unattached = static_cast<morph::UnattachedMotion>(filter->Options->UnattachedMotion);
  rest.free = morph::surfacesNamed(this->Model, filter->Options->FreeSurfaces, "FreeSurfaces");
  for (const morph::Index sheet : this->Model.sheets())
  {
    if (std::count(rest.sliding.begin(), rest.sliding.end(), sheet) == 0)
    {
      rest.free.push_back(sheet); // twice does no harm
    }
  }
  std::sort(rest.free.begin(), rest.free.end());
  rest.radius = filter->Options->FalloffRadius * this->Model.size;
  return true;
}

void vtkBoundaryDisplacement::vtkInternals::Displace(vtkBoundaryDisplacement* filter,
  vtkPointSet* input, vtkUnstructuredGrid* grid, const Extras& extras, vtkPolyData* output,
  filters::Monitor& monitor)
{
  const filters::WholeSurface* whole = this->Whole.get();
  // What the boundary alone decides is the same on all processes.
  const auto alike = [whole](const std::function<void()>& work)
  { whole ? whole->Together(work) : work(); };
  Moves moves;
  bool hasBoundary = false;
  filters::Zones::Options zones;
  alike(
    [&]
    {
      hasBoundary = this->Prepare(filter, input, extras, moves, monitor);
      zones = this->ZoneOptions(filter, extras.Zone);
    });
  if (!hasBoundary)
  {
    return;
  }
  morph::BoundaryMover::Options options;
  options.rest = moves.Rest;
  if (filter->Options->Moving != MOVING_NOTHING)
  {
    this->FindInner(filter, grid, zones, options);
    options.slideRounds = filter->Options->SlideRounds;
  }
  monitor.SetRange(extras.Target ? 0.7 : 0.5, 1);
  std::unique_ptr<filters::WholeVolume> pieces;
  if (whole)
  {
    pieces = std::make_unique<filters::WholeVolume>(*whole);
  }
  this->Mover.move(this->Model, moves.Choice, moves.Targets, options, pieces.get(), monitor);
  alike([&] { this->Write(filter, input, extras, moves, options, output, monitor); });
  if (options.hasInner())
  {
    alike([&] { this->AppendInner(grid, output); });
  }
  this->Count(filter, options.hasInner());
}

void vtkBoundaryDisplacement::vtkInternals::Write(vtkBoundaryDisplacement* filter,
  vtkPointSet* input, const Extras& extras, const Moves& moves,
  const morph::BoundaryMover::Options& options, vtkPolyData* output, filters::Monitor& monitor)
{
  const morph::Surroundings::Result& result = this->Mover.result();
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
      morph::listIds(collapsed) + ". Is a scale zero?");
  }
  if (options.hasInner())
  {
    filters::Output::RequireWritable(this->Mover.inner().rest(this->Model), result.moved,
      filters::Output::IsFloat(input, filter->Options->OutputPointsPrecision), "nodes");
  }
  filters::DisplacedSurface::Write(
    this->Model, result, input, filter->Options->OutputPointsPrecision, output);
  if (options.slideRounds > 0)
  {
    writeRounds(this->Mover.rounds().rounds(), this->Model.size, output->GetFieldData());
    this->SlideReport = this->Mover.rounds().report(this->Model.size);
  }
  if (options.hasInner() || options.slideRounds > 0)
  {
    filters::AffineArrays::Remove(output);
  }
  else
  {
    this->Fields.Write(this->Model, this->Choice, moves.Motion, moves.Rest, result,
      this->Mover.surroundings(), output, monitor);
  }
  if (extras.Target)
  {
    this->WriteDistances(result, output);
  }
  if (this->Whole)
  {
    this->WholeOutput->ShallowCopy(output);
    this->Whole->KeepOwn(output);
  }
}

void vtkBoundaryDisplacement::vtkInternals::AppendInner(
  vtkUnstructuredGrid* grid, vtkPolyData* output)
{
  const morph::Surroundings::Result& result = this->Mover.result();
  const std::vector<morph::Index> nodes = morph::InnerNodes::placedInside(this->Model, result);
  std::vector<signed char> roles;
  for (const morph::Index node : nodes)
  {
    roles.push_back(result.roles[node]);
  }
  filters::InnerPoints::Append(grid, this->Mover.inner().pointsOf(this->Model, nodes),
    this->Mover.inner().rest(this->Model)(nodes, morph::allColumns),
    result.moved(nodes, morph::allColumns), roles, output);
  if (this->Whole)
  {
    this->Whole->MakeIdsGlobal(output, static_cast<vtkIdType>(nodes.size()));
  }
}

void vtkBoundaryDisplacement::vtkInternals::Count(
  vtkBoundaryDisplacement* filter, bool hasInner) const
{
  using morph::Surroundings;
  const std::vector<signed char>& roles = this->Mover.result().roles;
  std::array<morph::Index, Surroundings::IsLayer + 1> count = {}, inside = {};
  const auto whole = static_cast<std::size_t>(this->Model.points().rows());
  // Without inner nodes all nodes inside stay. On ranks the model has the boundary's nodes alone.
  for (std::size_t i = 0; hasInner && i < whole; ++i)
  {
    ++count[roles[i]];
  }
  for (std::size_t i = 0; !hasInner && i < this->Model.faces.nodes.size(); ++i)
  {
    ++count[roles[this->Model.faces.nodes[i]]];
  }
  // All processes have the nodes of the boundary, and each has its own inner ones behind them.
  for (std::size_t i = whole; i < roles.size(); ++i)
  {
    ++inside[roles[i]];
  }
  const filters::RankGroup processes(
    this->Whole ? filters::RankGroup::Of::All : filters::RankGroup::Of::One);
  processes.Sum(inside.data(), inside.size());
  const auto both = [&](Surroundings::Role role) { return count[role] + inside[role]; };
  filter->MovingPoints = both(Surroundings::Moves);
  filter->FixedPoints = both(Surroundings::IsHeld);
  filter->FollowingPoints = both(Surroundings::Follows);
  filter->FreePoints = both(Surroundings::IsFree);
  filter->ZonePoints = both(Surroundings::IsZone);
  filter->LayerPoints = both(Surroundings::IsLayer);
}

/// A selection's ids are those of a process's piece, so each process evaluates its own.
void vtkBoundaryDisplacement::vtkInternals::SelectOnRanks(
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

void vtkBoundaryDisplacement::vtkInternals::DisplaceOnRanks(vtkBoundaryDisplacement* filter,
  vtkPointSet* input, const Extras& extras, vtkPolyData* output, filters::Monitor& monitor)
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
    this->Whole = std::make_unique<filters::WholeSurface>();
  }
  this->Whole->Take(piece, monitor);
  const bool byHandles = filter->Options->Displacement == DISPLACEMENT_HANDLES;
  if (filter->Options->Moving == MOVING_SELECTION ||
      (filter->Options->Moving != MOVING_NOTHING && byHandles && filter->Options->SelectedHandles))
  {
    this->SelectOnRanks(piece, extras.Selection);
  }
  vtkSmartPointer<vtkPolyData> target, control;
  if (extras.Target)
  {
    target = filters::WholeSurface::Gather(extras.Target);
  }
  if (filters::Ranks::Count(extras.ControlPoints) > 0 &&
      (byHandles || filter->Options->Displacement == DISPLACEMENT_LATTICE))
  {
    filters::Ranks::Together(
      [&]
      {
        control = byHandles ? filters::ControlPoints::AsHandles(extras.ControlPoints)
                            : filters::ControlPoints::AsLattice(
                                extras.ControlPoints, filter->Options->LatticeSize);
      });
    control = filters::WholeSurface::Gather(control);
  }
  this->Displace(filter, this->Whole->Grid(), piece,
    { extras.Selection, target, extras.Zone, control }, output, monitor);
}
