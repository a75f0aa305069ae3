// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Displace/Motion.h"
#include "Private/Pipeline/Input.h"

#include "BoundaryMover/Dimension.h"
#include "Mesh/Mesh.h"
#include "Private/Data/DataCheck.h"
#include "Support/Error.h"
#include "vtkDisplacementAlgorithm.h"

#include <vtkAbstractTransform.h>
#include <vtkDataArray.h>
#include <vtkLinearTransform.h>
#include <vtkMatrix4x4.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>

#include <algorithm>
#include <limits>
#include <utility>

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
    throw Error(
      "No array is named that holds the displacements: set `DisplacementArray` to a point "
      "vector array of the input.");
  }
  vtkAbstractArray* any = input->GetPointData()->GetAbstractArray(name.c_str());
  const std::string what = problem(any, input->GetNumberOfPoints());
  if (!what.empty())
  {
    throw Error("`DisplacementArray` names '" + name + "', " + what + ".");
  }
  auto* array = vtkDataArray::SafeDownCast(any);
  Points rows(static_cast<Index>(nodes.size()), 3);
  for (Index i = 0; i < rows.rows(); ++i)
  {
    array->GetTuple(nodes[i], rows.row(i).data());
  }
  return rows;
}

/// The center that the panel's numbers are about.
Eigen::RowVector3d centerOf(
  const BoundaryModel& model, const Choice& choice, const Motion::Options& options)
{
  return options.AutoCenter
           ? morph::centerOfMoving(model, choice)
           : Eigen::RowVector3d(options.Center[0], options.Center[1], options.Center[2]);
}

/// The point that is the origin of the transform.
Eigen::RowVector3d turningPoint(
  const BoundaryModel& model, const Choice& choice, const Motion::Options& options)
{
  if (options.Displacement == vtkDisplacementAlgorithm::DISPLACEMENT_TRANSFORM &&
      !options.TransformAboutCenter)
  {
    return Eigen::RowVector3d::Zero();
  }
  return centerOf(model, choice, options);
}

/// With ScaleFactor.
morph::Placement placementOf(const Motion::Options& options)
{
  morph::Placement part = { options.Translation, options.Rotation, options.Scale };
  const double factor = options.ScaleFactor;
  for (std::size_t i = 0; factor != 1 && i < 3; ++i)
  {
    part.translation[i] *= factor;
    part.rotation[i] *= factor;
    part.scale[i] = 1 + factor * (part.scale[i] - 1);
  }
  return part;
}

Points positions(const BoundaryModel& model, const std::vector<Index>& nodes)
{
  return model.points()(nodes, morph::allColumns);
}

/// The displacement with ScaleFactor about its turning point; nothing where it is not affine.
std::optional<morph::AffineMotion> affineMotion(
  const BoundaryModel& model, const Choice& choice, const Motion::Options& options)
{
  switch (options.Displacement)
  {
    case vtkDisplacementAlgorithm::DISPLACEMENT_VECTOR:
    {
      morph::AffineMotion motion = morph::AffineMotion::Zero();
      motion.col(0) = options.ScaleFactor * Eigen::Vector3d::Map(options.Vector.data());
      return motion;
    }
    case vtkDisplacementAlgorithm::DISPLACEMENT_TRANSLATE_ROTATE_SCALE:
      return morph::affineMotion(placementOf(options));
    case vtkDisplacementAlgorithm::DISPLACEMENT_TRANSFORM:
    {
      std::optional<morph::AffineMotion> motion = Motion::OfTransform(options.Transform);
      if (motion && options.ScaleFactor != 1)
      {
        motion = morph::partOf(*motion,
          centerOf(model, choice, options) - turningPoint(model, choice, options),
          options.ScaleFactor);
      }
      return motion;
    }
    default:
      return {};
  }
}

Points moved(
  const Points& from, const morph::AffineMotion& motion, const Eigen::RowVector3d& center)
{
  const Points turned = (from.rowwise() - center) * motion.rightCols<3>().transpose();
  return from + (turned.rowwise() + motion.col(0).transpose());
}

/// With a factor of 1, but for a dimension.
Points wholeMotion(const BoundaryModel& model, const Choice& choice, const Motion::Options& options,
  const Points& from, double* presentDimension)
{
  switch (options.Displacement)
  {
    case vtkDisplacementAlgorithm::DISPLACEMENT_VECTOR:
      return from.rowwise() +
             Eigen::RowVector3d(options.Vector[0], options.Vector[1], options.Vector[2]);
    case vtkDisplacementAlgorithm::DISPLACEMENT_ALONG_NORMALS:
      return morph::movedAlongNormals(model, choice, options.Distance);
    case vtkDisplacementAlgorithm::DISPLACEMENT_TRANSLATE_ROTATE_SCALE:
    {
      Motion::Options whole = options;
      whole.ScaleFactor = 1;
      return moved(
        from, morph::affineMotion(placementOf(whole)), turningPoint(model, choice, options));
    }
    case vtkDisplacementAlgorithm::DISPLACEMENT_RADIUS:
      return morph::movedByRadius(model, choice, options.RadiusChange);
    case vtkDisplacementAlgorithm::DISPLACEMENT_DIMENSION:
      return morph::movedToDimension(model, choice, options.Dimension,
        static_cast<morph::DimensionSide>(options.DimensionSide), options.ScaleFactor,
        presentDimension);
    case vtkDisplacementAlgorithm::DISPLACEMENT_ARRAY:
    case vtkDisplacementAlgorithm::DISPLACEMENT_FIELD:
    case vtkDisplacementAlgorithm::DISPLACEMENT_TARGET:
    case vtkDisplacementAlgorithm::DISPLACEMENT_HANDLES:
    case vtkDisplacementAlgorithm::DISPLACEMENT_LATTICE:
      return *options.Given;
    default:
      break;
  }
  return transformed(from, options.Transform, turningPoint(model, choice, options));
}

void requireModerate(const Points& targets, const std::vector<Index>& nodes, const char* property)
{
  std::vector<Index> notFinite, huge;
  for (Index i = 0; i < targets.rows(); ++i)
  {
    if (!morph::isModerate(targets.row(i)))
    {
      (targets.row(i).allFinite() ? huge : notFinite).push_back(nodes[i]);
    }
  }
  if (!notFinite.empty())
  {
    throw Error("`" + std::string(property) +
                "` moves nodes to places that are not finite (NaN or infinite): point ids " +
                morph::listIds(notFinite) + " of the input.");
  }
  if (!huge.empty())
  {
    throw Error("`" + std::string(property) + "` moves nodes beyond 1e50: point ids " +
                morph::listIds(huge) + " of the input. Move them less, or use another unit.");
  }
}
}

namespace Motion
{
std::optional<morph::AffineMotion> OfTransform(vtkAbstractTransform* transform)
{
  auto* linear = vtkLinearTransform::SafeDownCast(transform);
  if (!linear)
  {
    return {};
  }
  linear->Update();
  morph::AffineMotion motion;
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      motion(i, 1 + j) = linear->GetMatrix()->GetElement(i, j) - (i == j);
    }
    motion(i, 0) = linear->GetMatrix()->GetElement(i, 3);
  }
  return motion;
}

Points Targets(const BoundaryModel& model, const Choice& choice, const Options& options,
  double* presentDimension)
{
  const Points from = positions(model, choice.moving);
  if (choice.moving.empty())
  {
    return from;
  }
  Points targets = wholeMotion(model, choice, options, from, presentDimension);
  const char* names[] = { "Transform", "Vector", "Distance", "DisplacementArray",
    "Translation`, `Rotation` or `Scale", "RadiusChange", "Target", "Handles", "Lattice",
    "FieldArray", "Dimension" };
  requireModerate(targets, choice.moving, names[options.Displacement]);
  if (options.ScaleFactor == 0)
  {
    return from;
  }
  if (options.ScaleFactor != 1)
  {
    if (const auto affine = affineMotion(model, choice, options))
    {
      targets = moved(from, *affine, turningPoint(model, choice, options));
    }
    else if (options.Displacement != vtkDisplacementAlgorithm::DISPLACEMENT_DIMENSION)
    {
      targets = from + options.ScaleFactor * (targets - from);
    }
    requireModerate(targets, choice.moving, "ScaleFactor");
  }
  return targets;
}

Points OfArray(vtkPointSet* input, const Options& options, const Choice& choice)
{
  Points rows = arrayRows(input, options.DisplacementArray, choice.moving);
  vtkDataArray* mask = input->GetPointData()->GetArray(DataCheck::MaskName);
  for (Index i = 0; i < rows.rows(); ++i)
  {
    if (DataCheck::IsMissing(rows.row(i), mask, choice.moving[i]))
    {
      rows.row(i).setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
  return rows;
}

std::vector<Index> TakeMissing(
  Points& displacements, const Options& options, Choice& choice, morph::Monitor& monitor)
{
  std::vector<Index> missing, moving, rows;
  for (Index i = 0; i < displacements.rows(); ++i)
  {
    const bool isMissing = displacements.row(i).hasNaN();
    (isMissing ? missing : moving).push_back(choice.moving[i]);
    if (!isMissing)
    {
      rows.push_back(i);
    }
  }
  if (missing.empty())
  {
    return {};
  }
  const bool byField = options.Displacement == vtkDisplacementAlgorithm::DISPLACEMENT_FIELD;
  const std::string property = byField ? "`Field`" : "`DisplacementArray`";
  const std::string why = byField ? "they are farther than `FieldDistance` from the field, or it"
                                  : "'" + options.DisplacementArray + "'";
  if (moving.empty())
  {
    throw Error(property + " has no value where the boundary is to move: at all of its nodes " +
                why + " is NaN, or vtkValidPointMask 0. Give values there, or move another part.");
  }
  const bool stay = options.MissingValues == vtkDisplacementAlgorithm::MISSING_VALUES_STAY;
  monitor.warn(std::to_string(missing.size()) + " of the " + std::to_string(displacements.rows()) +
               " nodes that are to move have no displacement (" + why +
               " is NaN, or vtkValidPointMask 0, there), and " +
               (stay ? "stay" : "are free: they are solved with the interior") + ". Point ids " +
               morph::listIds(missing) + " of the input.");
  displacements = Points(displacements(rows, morph::allColumns));
  choice.moving = std::move(moving);
  if (!stay)
  {
    return missing;
  }
  const auto old = static_cast<std::ptrdiff_t>(choice.held.size());
  choice.held.insert(choice.held.end(), missing.begin(), missing.end());
  std::inplace_merge(choice.held.begin(), choice.held.begin() + old, choice.held.end());
  return {};
}

std::optional<morph::AffineMotion> Affine(const BoundaryModel& model, const Choice& choice,
  const Options& options, const Eigen::RowVector3d& center)
{
  if (choice.moving.empty())
  {
    return {};
  }
  std::optional<morph::AffineMotion> motion = affineMotion(model, choice, options);
  if (motion)
  {
    motion->col(0) +=
      motion->rightCols<3>() * (center - turningPoint(model, choice, options)).transpose();
  }
  return motion;
}
}
}
