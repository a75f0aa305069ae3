// SPDX-License-Identifier: BSD-3-Clause
// Where what moves goes: onto a target, by control points, or by a field.
#include "BoundaryMorphing/LatticeMotion.h"
#include "BoundaryMover/FitToTarget.h"
#include "BoundaryMover/PrescribedMotion.h"
#include "Private/Displace/FieldDisplacement.h"
#include "Private/Displace/Internals.h"
#include "Support/Error.h"

namespace filters = morph::filters;

namespace
{
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
    throw morph::Error("`ProjectVector` has no length. Give the direction in which nodes are to go "
                       "to the target.");
  }
  return direction / direction.cwiseAbs().maxCoeff();
}
}

morph::Points vtkDisplacementAlgorithm::vtkInternals::Fitted(const Options& options,
  vtkPointSet* input, vtkSelection* selection, vtkPolyData* target,
  const std::vector<morph::Index>& sliding, morph::Monitor& monitor)
{
  const morph::Target::Options place = filters::TargetData::OptionsOf(options, this->Model.size);
  std::optional<Eigen::RowVector3d> along;
  if (options.ProjectAlong != PROJECT_ALONG_CLOSEST_POINT)
  {
    along = directionOf(options.ProjectAlong, options.ProjectVector);
  }
  if (options.Moving == MOVING_SURFACES && options.Surfaces.empty())
  {
    this->Fit.Update(target, this->Model, nullptr, options.AlignTarget, place, monitor);
    this->Choose(options, input, selection);
  }
  else
  {
    this->Choose(options, input, selection);
    this->Fit.Update(target, this->Model, &this->Choice, options.AlignTarget, place, monitor);
  }
  if (!this->Fit.GetWarning().empty())
  {
    monitor.warn(this->Fit.GetWarning());
  }
  return morph::fittedTo(*this->Fit.Get(), this->Model, this->Choice, sliding,
    along ? &*along : nullptr, this->Mover.surroundings(), monitor);
}

std::vector<morph::Handle> vtkDisplacementAlgorithm::vtkInternals::ChosenHandles(
  const Options& options, vtkPointSet* input, vtkSelection* selection)
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
      const auto& v = options.Vector;
      handles.push_back(
        { this->Model.points().row(node), { v[0], v[1], v[2] }, options.HandleRadius });
    }
  }
  return handles;
}

morph::Points vtkDisplacementAlgorithm::vtkInternals::ByControlPoints(const Options& options,
  vtkPointSet* input, vtkSelection* selection, vtkDataObject* points, morph::Monitor& monitor)
{
  const morph::Points from = this->Model.points()(this->Choice.moving, morph::allColumns);
  if (options.Displacement == DISPLACEMENT_HANDLES)
  {
    std::vector<morph::Handle> handles = filters::ControlPoints::Handles(points, this->Handles);
    if (options.SelectedHandles)
    {
      const std::vector<morph::Handle> more = this->ChosenHandles(options, input, selection);
      handles.insert(handles.end(), more.begin(), more.end());
    }
    filters::ControlPoints::Write(handles, this->ControlPoints);
    return from +
           morph::HandleMotion(handles, options.HandleSmoothing).displacements(from, monitor);
  }
  morph::LatticeMotion lattice = LatticeOf(options, from);
  lattice.controlDisplacements =
    filters::ControlPoints::Lattice(points, this->LatticeDisplacements, lattice.size);
  const morph::Points rest = lattice.controlPoints();
  this->LatticePoints->SetNumberOfTuples(static_cast<vtkIdType>(rest.rows()));
  for (morph::Index i = 0; i < rest.rows(); ++i)
  {
    this->LatticePoints->SetTuple(static_cast<vtkIdType>(i), rest.row(i).data());
  }
  filters::ControlPoints::Write(lattice, this->ControlPoints);
  return from + lattice.displacements(from, monitor);
}

morph::LatticeMotion vtkDisplacementAlgorithm::vtkInternals::LatticeOf(
  const Options& options, const morph::Points& from)
{
  morph::LatticeMotion lattice;
  lattice.basis = static_cast<morph::LatticeMotion::Basis>(options.LatticeBasis);
  lattice.size = options.LatticeSize;
  if (options.LatticeBox != LATTICE_BOX_OWN)
  {
    lattice.surround(from, options.LatticeBox == LATTICE_BOX_ALONG);
    return lattice;
  }
  const morph::AffineMotion turn =
    morph::affineMotion({ { 0, 0, 0 }, options.LatticeRotation, { 1, 1, 1 } });
  lattice.axes += turn.rightCols<3>();
  lattice.origin = Eigen::RowVector3d::Map(options.LatticePosition.data());
  lattice.high = Eigen::RowVector3d::Map(options.LatticeLength.data());
  return lattice;
}

morph::Points vtkDisplacementAlgorithm::vtkInternals::ByField(
  const Options& options, vtkDataObject* field, morph::Monitor& monitor)
{
  const std::string& array = options.FieldArray;
  const auto origin = std::make_tuple(field, field ? field->GetMTime() : 0, array,
    options.FieldDistance, this->Model.inputVersion, this->ChooseCount);
  if (!this->Whole && field && this->FieldOrigin == origin)
  {
    return this->FieldValues;
  }
  this->FieldOrigin = {}; // in case it throws
  this->FieldValues = filters::FieldDisplacement::At(field, array,
    this->Model.points()(this->Choice.moving, morph::allColumns),
    options.FieldDistance * this->Model.size, filters::RankGroup(this->Whole != nullptr), monitor);
  if (!this->Whole)
  {
    this->FieldOrigin = origin;
  }
  return this->FieldValues;
}
