// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryOracles.h"

#include "Mesh/Topology.h"
#include "RandomMesh.h"
#include "Recount.h"
#include "Support/UnionFind.h"
#include "vtkBoundaryDisplacement.h"
#include "vtkMorphBoundary.h"

#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <tuple>

namespace fuzz
{
namespace
{
using morph::Index;
using Row = Eigen::RowVector3d;

std::string nodeText(Index node)
{
  return "node " + std::to_string(node);
}

std::string offText(const Row& x, const Row& wanted, const Case& made)
{
  std::ostringstream text;
  text << (x - wanted).norm() / made.grid.size << " sizes off";
  return text.str();
}

/// The point array, or null where it is not as long as the output.
vtkDataArray* arrayOf(vtkPointSet* output, const char* name)
{
  vtkDataArray* array = output->GetPointData()->GetArray(name);
  return array && array->GetNumberOfTuples() == output->GetNumberOfPoints() ? array : nullptr;
}

/// Whether the known points tell an affine map at all others: along each of their principal
/// directions these are no farther out than three of their extents.
bool areDetermined(const std::vector<Row>& known, const std::vector<Row>& others)
{
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  Row center = Row::Zero();
  const auto share = 1 / static_cast<double>(known.size());
  for (const Row& x : known)
  {
    center += share * x;
  }
  for (const Row& x : known)
  {
    spread += share * (x - center).transpose() * (x - center);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
  const Row extent = solver.eigenvalues().cwiseMax(0).cwiseSqrt().transpose();
  return std::all_of(others.begin(), others.end(),
    [&](const Row& x)
    {
      const Row arm = (x - center) * solver.eigenvectors();
      return ((arm.cwiseAbs() - 3 * extent).array() <= 1e-7 * extent[2]).all();
    });
}

/// The points of surfaces on which the nodes that others follow do not tell an affine map.
/// `isKnown`: #points of the output.
std::set<vtkIdType> undetermined(
  const morph::Points& rest, vtkPolyData* output, const std::vector<bool>& isKnown)
{
  vtkDataArray* ids = arrayOf(output, "MorphPointId");
  vtkDataArray* surfaces = output->GetCellData()->GetArray("GeometryId");
  // A surface is what hangs together by edges, of two faces each.
  std::map<std::tuple<double, vtkIdType, vtkIdType>, std::vector<vtkIdType>> cellsOfEdge;
  for (vtkIdType cell = 0; cell < output->GetNumberOfCells(); ++cell)
  {
    const double surface = surfaces->GetComponent(cell, 0);
    vtkIdList* points = output->GetCell(cell)->GetPointIds();
    for (vtkIdType k = 0; k < points->GetNumberOfIds(); ++k)
    {
      const auto [low, high] =
        std::minmax({ points->GetId(k), points->GetId((k + 1) % points->GetNumberOfIds()) });
      cellsOfEdge[{ surface, low, high }].push_back(cell);
    }
  }
  morph::UnionFind<vtkIdType> parts(output->GetNumberOfCells());
  for (const auto& [edge, cells] : cellsOfEdge)
  {
    if (cells.size() == 2)
    {
      parts.join(cells[0], cells[1]);
    }
  }
  std::map<vtkIdType, std::set<vtkIdType>> pointsOf;
  for (vtkIdType cell = 0; cell < output->GetNumberOfCells(); ++cell)
  {
    vtkIdList* points = output->GetCell(cell)->GetPointIds();
    pointsOf[parts.root(cell)].insert(points->begin(), points->end());
  }
  std::set<vtkIdType> result;
  for (const auto& [part, points] : pointsOf)
  {
    std::vector<Row> known, others;
    for (const vtkIdType p : points)
    {
      const Row x = rest.row(static_cast<Index>(ids->GetComponent(p, 0)));
      (isKnown[p] ? known : others).push_back(x);
    }
    if (!areDetermined(known, others))
    {
      result.insert(points.begin(), points.end());
    }
  }
  return result;
}

double roundingOf(vtkPointSet* output, const Row& x)
{
  const bool isFloat = output->GetPoints()->GetDataType() == VTK_FLOAT;
  return (isFloat ? 1e-6 : 1e-13) * x.cwiseAbs().maxCoeff() + (isFloat ? 1e-37 : 0);
}
}

Finding checkExtracted(const Case& made, vtkPointSet* output)
{
  vtkDataArray* ids = arrayOf(output, "MorphPointId");
  std::vector<Index> nodes;
  for (vtkIdType p = 0; ids && p < ids->GetNumberOfTuples(); ++p)
  {
    const auto node = static_cast<Index>(ids->GetComponent(p, 0));
    if (node < made.grid.mesh.numberOfNodes()) // others are images across a shell
    {
      nodes.push_back(node);
    }
  }
  return nodes == made.grid.outer
           ? Finding{}
           : Finding{ "boundary nodes", std::to_string(nodes.size()) + " found, " +
                                          std::to_string(made.grid.outer.size()) + " counted" };
}

Finding checkClassified(const Case& made, vtkPointSet* output)
{
  vtkDataArray* dimensions = arrayOf(output, "GeometryDimension");
  if (!dimensions)
  {
    return { "geometry", "no GeometryDimension" };
  }
  const std::set<Index> outer(made.grid.outer.begin(), made.grid.outer.end());
  const std::vector<Index> all = cellNodes(made.grid.mesh, {});
  const std::set<Index> inVolume(all.begin(), all.end());
  if (all.empty())
  {
    return {}; // faces alone are a shell, which has a boundary of edges
  }
  for (Index n = 0; n < output->GetNumberOfPoints(); ++n)
  {
    const double dimension = dimensions->GetComponent(n, 0);
    const bool isRight =
      outer.count(n) ? dimension >= 0 && dimension <= 2 : dimension == (inVolume.count(n) ? 3 : -1);
    if (!isRight)
    {
      return { "geometry", nodeText(n) + " has the dimension " + std::to_string(dimension) };
    }
  }
  return {};
}

Finding checkMovedBoundary(const Case& made, vtkAlgorithm* algorithm, const Run& run)
{
  auto* filter = vtkMorphBoundary::SafeDownCast(algorithm);
  auto* output = vtkPolyData::SafeDownCast(run.outputs.front());
  vtkDataArray* ids = arrayOf(output, "MorphPointId");
  vtkDataArray* dimensions = arrayOf(output, "GeometryDimension");
  if (!ids || !dimensions)
  {
    return { "moved boundary", "no ids or no GeometryDimension" };
  }
  if (!made.boundary.isRight || !made.isRegular || filter->GetMatchTolerance() > 1e-3)
  {
    return {};
  }
  const std::map<Index, Row> targets(made.boundary.targets.begin(), made.boundary.targets.end());
  const double scale = filter->GetScaleFactor();
  // Where curves bound all surfaces. A motion that flattens or reflects a surface draws a warning,
  // and smoothing improves faces that a strong one distorts.
  const bool isAffine =
    !made.grid.isShell() && made.boundary.isAffine && !made.inputs[2] && run.warnings.empty() &&
    filter->GetSurfaceMethod() == vtkMorphBoundary::SURFACE_METHOD_WEIGHTED_RESIDUAL &&
    made.choices.value("property.FeatureAngle") < 60 &&
    filter->GetUnattachedMotion() == vtkMorphBoundary::UNATTACHED_MOTION_FOLLOW_AFFINELY &&
    made.choices.value("hostile.mesh") == 0 && isValid(made.grid.mesh, made.grid.mesh.points, 0.02);
  const auto isGivenPoint = [&](vtkIdType p)
  {
    return targets.count(static_cast<Index>(ids->GetComponent(p, 0))) > 0 &&
           dimensions->GetComponent(p, 0) <= filter->GetPrescribedDimension();
  };
  std::vector<bool> isFollowed;
  for (vtkIdType p = 0; p < output->GetNumberOfPoints(); ++p)
  {
    isFollowed.push_back(dimensions->GetComponent(p, 0) < 2 || isGivenPoint(p));
  }
  const std::set<vtkIdType> unknown =
    isAffine ? undetermined(made.grid.mesh.points, output, isFollowed) : std::set<vtkIdType>();
  for (vtkIdType p = 0; p < output->GetNumberOfPoints(); ++p)
  {
    const auto node = static_cast<Index>(ids->GetComponent(p, 0));
    const double dimension = dimensions->GetComponent(p, 0);
    if (node >= made.grid.mesh.numberOfNodes())
    {
      continue; // an image across a shell
    }
    const auto target = targets.find(node);
    const Row rest = made.grid.mesh.points.row(node);
    Row x;
    output->GetPoint(p, x.data());
    const bool isGiven = isGivenPoint(p);
    const Row wanted = isGiven ? Row(rest + scale * (target->second - rest)) : rest;
    // Below 1e-38 floats are multiples of one number.
    const double rounding = made.choices.value("boundary.float") == 0
                              ? 0
                              : 1e-5 * made.grid.mesh.points.cwiseAbs().maxCoeff() +
                                  std::numeric_limits<float>::denorm_min();
    const bool isKnown = isGiven || dimension == 0;
    if (isKnown && !((x - wanted).cwiseAbs().maxCoeff() <=
                     10 * roundingOf(output, wanted) + 1e-12 * made.grid.size + rounding))
    {
      return { "given node", nodeText(node) + " is " + offText(x, wanted, made) };
    }
    const Row mapped = rest * made.boundary.matrix.transpose() + made.boundary.shift;
    const Row image = rest + scale * (mapped - rest);
    const double allowed = 1e-6 * made.grid.size * (1 + std::abs(scale)) + rounding +
                           100 * roundingOf(output, image) + 100 * roundingOf(output, rest);
    if (isAffine && (dimension < 2 || unknown.count(p) == 0) && !((x - image).norm() <= allowed))
    {
      return { "affine map of the boundary", nodeText(node) + " of dimension " +
                                               std::to_string(static_cast<int>(dimension)) +
                                               " is " + offText(x, image, made) };
    }
  }
  return {};
}

namespace
{
/// A body in which nothing moves or is free stays, unless contact or a sliding surface takes it
/// along.
Finding checkBodies(const Case& made, vtkPointSet* output, vtkDataArray* roles, vtkDataArray* ids)
{
  if (made.choices.value("property.ContactDistance") != 0 ||
      made.choices.value("property.SlideRounds") != 0)
  {
    return {};
  }
  if (made.grid.isShell())
  {
    return {};
  }
  const morph::Mesh& mesh = made.grid.mesh;
  const std::vector<Index> bodyOf = morph::bodyOfNodes(mesh, morph::connectedComponents(mesh));
  std::set<Index> moving;
  const auto bodyAt = [&](vtkIdType p)
  { return bodyOf[static_cast<Index>(ids->GetComponent(p, 0))]; };
  for (vtkIdType p = 0; p < output->GetNumberOfPoints(); ++p)
  {
    const double role = roles->GetComponent(p, 0);
    if (role == 1 || role > 3)
    {
      moving.insert(bodyAt(p));
    }
  }
  for (vtkIdType p = 0; p < output->GetNumberOfPoints(); ++p)
  {
    const auto node = static_cast<Index>(ids->GetComponent(p, 0));
    const Row rest = mesh.points.row(node);
    Row x;
    output->GetPoint(p, x.data());
    if (moving.count(bodyAt(p)) == 0 && (x - rest).cwiseAbs().maxCoeff() > roundingOf(output, rest))
    {
      return { "bodies", nodeText(node) + " moves in a body of which nothing is asked" };
    }
  }
  return {};
}

/// The sides of a slit part only if one of them is held, free, in a zone or a layer, or slides,
/// which wins over what it is to do.
Finding checkSlit(const Case& made, vtkPointSet* output, vtkDataArray* roles, vtkDataArray* ids)
{
  std::map<Index, vtkIdType> pointOf;
  for (vtkIdType p = 0; p < output->GetNumberOfPoints(); ++p)
  {
    pointOf[static_cast<Index>(ids->GetComponent(p, 0))] = p;
  }
  for (const auto& [node, copy] : made.grid.known.slit)
  {
    if (pointOf.count(node) + pointOf.count(copy) < 2)
    {
      continue; // ghosts
    }
    const double role = roles->GetComponent(pointOf.at(node), 0);
    const double other = roles->GetComponent(pointOf.at(copy), 0);
    Row x, y;
    output->GetPoint(pointOf.at(node), x.data());
    output->GetPoint(pointOf.at(copy), y.data());
    const auto isMoved = [](double r) { return r == 1 || r == 3; };
    const bool maySlide = made.choices.value("property.SlideRounds") != 0 ||
                          (made.choices.value("with.surfaces") != 0 && role + other != 6);
    if (isMoved(role) && isMoved(other) && !maySlide &&
        (x - y).cwiseAbs().maxCoeff() > 10 * roundingOf(output, x))
    {
      return { "slit", nodeText(node) + " parts from node " + std::to_string(copy) };
    }
  }
  return {};
}
}

Finding checkDisplaced(const Case& made, vtkPointSet* output)
{
  vtkDataArray* roles = arrayOf(output, "Role");
  vtkDataArray* ids = arrayOf(output, "MorphPointId");
  if (!roles || !ids)
  {
    return { "displaced boundary", "no Role or no ids" };
  }
  const bool isGrid = made.inputs[0] == made.grid.data;
  for (vtkIdType p = 0; isGrid && p < output->GetNumberOfPoints(); ++p)
  {
    const double role = roles->GetComponent(p, 0);
    const auto node = static_cast<Index>(ids->GetComponent(p, 0));
    if (node >= made.grid.mesh.numberOfNodes())
    {
      continue; // an image across a shell
    }
    const Row rest = made.grid.mesh.points.row(node);
    Row x;
    output->GetPoint(p, x.data());
    if (!(role >= 0 && role <= 6))
    {
      return { "displaced boundary", "a Role of " + std::to_string(role) };
    }
    if ((role == 0 || role == 2) && (x - rest).cwiseAbs().maxCoeff() > roundingOf(output, rest))
    {
      return { "displaced boundary", nodeText(node) + " is to stay, and moves" };
    }
  }
  if (!isGrid || !made.grid.isAsMesh)
  {
    return {};
  }
  const Finding parted = checkSlit(made, output, roles, ids);
  return parted ? parted : checkBodies(made, output, roles, ids);
}
}
