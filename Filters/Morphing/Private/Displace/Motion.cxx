// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/Motion.h"
#include "Private/Pipeline/Input.h"

#include "Boundary/FaceAreas.h"
#include "Private/Data/DataCheck.h"
#include "Private/Displace/SurfaceShape.h"
#include "Support/Error.h"
#include "vtkDisplacementAlgorithm.h"

#include <vtkAbstractTransform.h>
#include <vtkDataArray.h>
#include <vtkLinearTransform.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkSmartPointer.h>
#include <vtkTransform.h>

#include <algorithm>

namespace morph::filters
{
namespace
{
using morph::Error;
using morph::Index;
using morph::Points;

/// center + transform(x - center). What the transform leaves alone stays bit for bit. A null
/// transform is the identity.
Points transformed(
  const Points& from, vtkAbstractTransform* transform, const Eigen::RowVector3d& center)
{
  Points to = from;
  for (Index i = 0; transform && i < to.rows(); ++i)
  {
    const Eigen::RowVector3d offset = from.row(i) - center;
    Eigen::RowVector3d there;
    transform->TransformPoint(offset.data(), there.data());
    if (there != offset)
    {
      to.row(i) = there + center;
    }
  }
  return to;
}

/// Why an array cannot hold the displacements of so many points; empty where it can.
std::string problem(vtkAbstractArray* any, vtkIdType points)
{
  if (!any)
  {
    return "which the input does not have as a point array";
  }
  if (!vtkDataArray::SafeDownCast(any))
  {
    return "which is not numeric";
  }
  if (any->GetNumberOfComponents() != 3)
  {
    return "which has " + std::to_string(any->GetNumberOfComponents()) +
           " components; a displacement has three";
  }
  if (any->GetNumberOfTuples() != points)
  {
    return "which has " + std::to_string(any->GetNumberOfTuples()) + " values for the input's " +
           std::to_string(points) + " points";
  }
  return {};
}

Points arrayRows(vtkPointSet* input, const std::string& name, const std::vector<Index>& nodes)
{
  if (name.empty())
  {
    throw Error("No array is named that holds the displacements: set DisplacementArray to a point "
                "vector array of the input.");
  }
  vtkAbstractArray* any = input->GetPointData()->GetAbstractArray(name.c_str());
  const std::string what = problem(any, input->GetNumberOfPoints());
  if (!what.empty())
  {
    throw Error("DisplacementArray names '" + name + "', " + what + ".");
  }
  auto* array = vtkDataArray::SafeDownCast(any);
  Points rows(static_cast<Index>(nodes.size()), 3);
  for (Index i = 0; i < rows.rows(); ++i)
  {
    array->GetTuple(nodes[i], rows.row(i).data());
  }
  return rows;
}

/// The middle of the box around these points.
Eigen::RowVector3d centerOf(const Points& points)
{
  return 0.5 * (points.colwise().minCoeff() + points.colwise().maxCoeff());
}

/// The point that is the origin of the transform. `from`: what moves.
Eigen::RowVector3d turningPoint(const Points& from, const Motion::Options& options)
{
  if (options.Displacement == vtkDisplacementAlgorithm::DISPLACEMENT_TRANSFORM &&
      !options.TransformAboutCenter)
  {
    return Eigen::RowVector3d::Zero();
  }
  return options.AutoCenter
           ? centerOf(from)
           : Eigen::RowVector3d(options.Center[0], options.Center[1], options.Center[2]);
}

/// Scales and turns about the origin, and translates.
vtkSmartPointer<vtkTransform> placement(const Motion::Options& options)
{
  auto transform = vtkSmartPointer<vtkTransform>::New();
  transform->Translate(options.Translation.data());
  transform->RotateZ(options.Rotation[2]);
  transform->RotateX(options.Rotation[0]);
  transform->RotateY(options.Rotation[1]);
  // A factor of zero is allowed, where VTK raises an error.
  vtkNew<vtkMatrix4x4> scale;
  for (int i = 0; i < 3; ++i)
  {
    scale->SetElement(i, i, options.Scale[i]);
  }
  transform->Concatenate(scale);
  return transform;
}

/// Moves nodes away from the axis of their cylinder.
Points withRadius(
  const BoundaryModel& model, const Choice::Result& choice, const Points& from, double change)
{
  std::vector<Index> row(model.Points().rows(), -1);
  for (std::size_t i = 0; i < choice.Moving.size(); ++i)
  {
    row[choice.Moving[i]] = static_cast<Index>(i);
  }
  Points to = from;
  std::vector<std::uint8_t> isDone(choice.Moving.size(), 0);
  for (const morph::GeometrySurface& surface : model.Geometry().surfaces)
  {
    if (std::none_of(surface.faces.begin(), surface.faces.end(),
          [&](Index face) { return choice.IsMovingFace[face] != 0; }))
    {
      continue;
    }
    const SurfaceShape shape(model.Points(), model.Faces(), surface);
    const std::string name = "Surface " + std::to_string(surface.id);
    if (shape.GetKind() != SurfaceShape::Kind::Cylinder)
    {
      throw Error("RadiusChange needs cylinders, and " + name +
                  ", which moves, is none. Choose cylinders, or another displacement.");
    }
    if (shape.GetRadius() + change <= 0)
    {
      throw Error("RadiusChange would leave " + name + " no radius: it has " +
                  std::to_string(shape.GetRadius()) + ".");
    }
    for (const Index node : surface.nodes)
    {
      if (row[node] >= 0 && !isDone[row[node]])
      {
        to.row(row[node]) += change * shape.Outwards(from.row(row[node]));
        isDone[row[node]] = 1;
      }
    }
  }
  if (std::all_of(isDone.begin(), isDone.end(), [](std::uint8_t done) { return !done; }))
  {
    throw Error("RadiusChange needs cylinders, and no face moves. Choose surfaces that are some.");
  }
  return to;
}

Points positions(const BoundaryModel& model, const std::vector<Index>& nodes)
{
  return model.Points()(nodes, morph::allColumns);
}

/// The displacement of the whole motion; nothing where it is not affine.
std::optional<morph::AffineMotion> affineMotion(
  const Points& from, const Motion::Options& options, const Eigen::RowVector3d& center)
{
  morph::AffineMotion motion = morph::AffineMotion::Zero();
  vtkSmartPointer<vtkLinearTransform> linear;
  switch (options.Displacement)
  {
    case vtkDisplacementAlgorithm::DISPLACEMENT_VECTOR:
      motion.col(0) << options.Vector[0], options.Vector[1], options.Vector[2];
      return motion;
    case vtkDisplacementAlgorithm::DISPLACEMENT_TRANSLATE_ROTATE_SCALE:
      linear = placement(options);
      break;
    case vtkDisplacementAlgorithm::DISPLACEMENT_TRANSFORM:
      linear = vtkLinearTransform::SafeDownCast(options.Transform);
      break;
    default:
      break;
  }
  if (!linear)
  {
    return {};
  }
  linear->Update();
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      motion(i, 1 + j) = linear->GetMatrix()->GetElement(i, j) - (i == j);
    }
    motion(i, 0) = linear->GetMatrix()->GetElement(i, 3);
  }
  motion.col(0) += motion.rightCols<3>() * (center - turningPoint(from, options)).transpose();
  return motion;
}

Points wholeMotion(vtkPointSet* input, const BoundaryModel& model, const Choice::Result& choice,
  const Motion::Options& options, const Points& from)
{
  switch (options.Displacement)
  {
    case vtkDisplacementAlgorithm::DISPLACEMENT_VECTOR:
      return from.rowwise() +
             Eigen::RowVector3d(options.Vector[0], options.Vector[1], options.Vector[2]);
    case vtkDisplacementAlgorithm::DISPLACEMENT_ALONG_NORMALS:
      return from + options.Distance * morph::nodeNormals(model.OutwardAreas(model.Points()),
                                         model.Faces(), choice.IsMovingFace, choice.Moving);
    case vtkDisplacementAlgorithm::DISPLACEMENT_ARRAY:
      return from + arrayRows(input, Input::ArrayName(options.DisplacementArray), choice.Moving);
    case vtkDisplacementAlgorithm::DISPLACEMENT_TRANSLATE_ROTATE_SCALE:
      return transformed(from, placement(options), turningPoint(from, options));
    case vtkDisplacementAlgorithm::DISPLACEMENT_RADIUS:
      return withRadius(model, choice, from, options.RadiusChange);
    case vtkDisplacementAlgorithm::DISPLACEMENT_TARGET:
    case vtkDisplacementAlgorithm::DISPLACEMENT_HANDLES:
    case vtkDisplacementAlgorithm::DISPLACEMENT_LATTICE:
      return *options.Given;
    default:
      break;
  }
  return transformed(from, options.Transform, turningPoint(from, options));
}

void requireModerate(const Points& targets, const std::vector<Index>& nodes, const char* property)
{
  std::vector<Index> notFinite, huge;
  for (Index i = 0; i < targets.rows(); ++i)
  {
    if (!DataCheck::IsModerate(targets.row(i)))
    {
      (targets.row(i).allFinite() ? huge : notFinite).push_back(nodes[i]);
    }
  }
  if (!notFinite.empty())
  {
    throw Error(std::string(property) +
                " moves nodes to places that are not finite (NaN or infinite): point ids " +
                morph::listIds(notFinite) + " of the input.");
  }
  if (!huge.empty())
  {
    throw Error(std::string(property) + " moves nodes beyond 1e50: point ids " +
                morph::listIds(huge) + " of the input. Move them less, or use another unit.");
  }
}
}

namespace Motion
{
Points Targets(vtkPointSet* input, const BoundaryModel& model, const Choice::Result& choice,
  const Options& options)
{
  const Points from = positions(model, choice.Moving);
  if (choice.Moving.empty())
  {
    return from;
  }
  Points targets = wholeMotion(input, model, choice, options, from);
  const char* names[] = { "Transform", "Vector", "Distance", "DisplacementArray", "Scale",
    "RadiusChange", "Target", "Handles", "Lattice" };
  requireModerate(targets, choice.Moving, names[options.Displacement]);
  if (options.ScaleFactor == 0)
  {
    return from;
  }
  if (options.ScaleFactor != 1)
  {
    targets = from + options.ScaleFactor * (targets - from);
    requireModerate(targets, choice.Moving, "ScaleFactor");
  }
  return targets;
}

std::vector<Index> TakeMissing(
  vtkPointSet* input, const Options& options, Choice::Result& choice, morph::Monitor& monitor)
{
  if (options.Displacement != vtkDisplacementAlgorithm::DISPLACEMENT_ARRAY || choice.Moving.empty())
  {
    return {};
  }
  const Points rows = arrayRows(input, Input::ArrayName(options.DisplacementArray), choice.Moving);
  vtkDataArray* mask = input->GetPointData()->GetArray(DataCheck::MaskName);
  std::vector<Index> missing, moving;
  for (Index i = 0; i < rows.rows(); ++i)
  {
    const Index node = choice.Moving[i];
    (DataCheck::IsMissing(rows.row(i), mask, node) ? missing : moving).push_back(node);
  }
  const std::string where =
    "'" + Input::ArrayName(options.DisplacementArray) + "' is NaN, or vtkValidPointMask 0, ";
  if (moving.empty())
  {
    throw Error("DisplacementArray has no value where the boundary is to move: " + where +
                "at all of its points. Give values there, or move another part.");
  }
  if (!missing.empty())
  {
    monitor.warn(std::to_string(missing.size()) + " of the " + std::to_string(rows.rows()) +
                 " nodes that are to move have no displacement (" + where +
                 "there), and are free: they are solved with the interior. Point ids " +
                 morph::listIds(missing) + " of the input.");
  }
  choice.Moving = std::move(moving);
  return missing;
}

std::optional<morph::AffineMotion> Affine(const BoundaryModel& model, const Choice::Result& choice,
  const Options& options, const Eigen::RowVector3d& center)
{
  if (choice.Moving.empty())
  {
    return {};
  }
  std::optional<morph::AffineMotion> motion =
    affineMotion(positions(model, choice.Moving), options, center);
  if (motion)
  {
    *motion *= options.ScaleFactor;
  }
  return motion;
}

Eigen::RowVector3d Center(const BoundaryModel& model, const Choice::Result& choice)
{
  if (choice.Moving.empty())
  {
    return Eigen::RowVector3d::Zero();
  }
  return centerOf(positions(model, choice.Moving));
}

std::vector<Index> Collapsed(
  const BoundaryModel& model, const Choice::Result& choice, const Points& moved)
{
  const morph::BoundaryFaces& faces = model.Faces();
  const Points after = morph::faceAreas(moved, faces);
  // No face of the boundary is larger than this, and nearly always all are larger than that part.
  const double largest = model.Size() * model.Size();
  if (after.rows() == 0 || after.rowwise().norm().minCoeff() > 1e-12 * largest)
  {
    return {};
  }
  const Points before = morph::faceAreas(model.Points(), faces);
  const auto isCollapsed = [&](Index f)
  {
    const double area = before.row(f).norm();
    return area > 0 && after.row(f).norm() <= 1e-12 * area &&
           std::all_of(faces.connectivity.begin() + faces.offsets[f],
             faces.connectivity.begin() + faces.offsets[f + 1],
             [&](Index node)
             { return std::binary_search(choice.Moving.begin(), choice.Moving.end(), node); });
  };
  std::vector<Index> cells;
  for (std::size_t p = 0; p < model.FaceOfPolygon().size(); ++p)
  {
    if (isCollapsed(model.FaceOfPolygon()[p]))
    {
      cells.push_back(model.FirstPolygon() + static_cast<Index>(p));
    }
  }
  return cells;
}
}
}
