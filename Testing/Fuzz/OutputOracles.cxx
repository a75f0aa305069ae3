// SPDX-License-Identifier: BSD-3-Clause
#include "Oracles.h"

#include "BoundaryOracles.h"
#include "Mesh/CellShape.h"
#include "Mesh/CollapsedCells.h"
#include "Mesh/HangingNodes.h"
#include "Mesh/Polyhedra.h"
#include "RandomMesh.h"
#include "Recount.h"
#include "vtkDisplacementAlgorithm.h"
#include "vtkInversionFreeMorph.h"
#include "vtkMorphAlgorithm.h"
#include "vtkMorphMesh.h"
#include "vtkMorphShapes.h"

#include <vtkCell.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkSignedCharArray.h>
#include <vtkUnsignedCharArray.h>

#include <Eigen/LU>

#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <sstream>

namespace fuzz
{
namespace
{
using morph::Index;
using Row = Eigen::RowVector3d;

std::string text(const Row& x)
{
  std::ostringstream stream;
  stream.precision(17);
  stream << "(" << x << ")";
  return stream.str();
}

bool isFloat(vtkPointSet* data)
{
  return data->GetPoints() && data->GetPoints()->GetDataType() == VTK_FLOAT;
}

double fieldValue(vtkDataObject* data, const char* name)
{
  vtkDataArray* array = data->GetFieldData()->GetArray(name);
  return array && array->GetNumberOfTuples() == 1 ? array->GetComponent(0, 0) : NAN;
}

/// Points of no cell may be anywhere.
bool haveFiniteNodes(vtkPointSet* output)
{
  const morph::Points points = pointsOf(output);
  vtkNew<vtkIdList> nodes;
  bool areFinite = true;
  for (vtkIdType cell = 0; cell < output->GetNumberOfCells(); ++cell)
  {
    output->GetCellPoints(cell, nodes);
    areFinite = areFinite && std::all_of(nodes->begin(), nodes->end(),
                               [&](vtkIdType node) { return points.row(node).allFinite(); });
  }
  return areFinite;
}

/// `written`: the point array that the filter writes; others may have come with the input.
Finding checkFinite(vtkPointSet* output, const char* written)
{
  // The adjoint passes its boundary on, whose points need not be read.
  const bool areMoved = std::string(written) != "MorphGradient";
  if (areMoved && !haveFiniteNodes(output))
  {
    return { "not finite", "points" };
  }
  vtkDataArray* array = *written ? output->GetPointData()->GetArray(written) : nullptr;
  for (vtkIdType i = 0; array && i < array->GetNumberOfValues(); ++i)
  {
    const int components = array->GetNumberOfComponents();
    if (!std::isfinite(array->GetComponent(i / components, static_cast<int>(i % components))))
    {
      return { "not finite", written };
    }
  }
  return {};
}

std::vector<std::uint8_t> ghosts(vtkDataSet* data)
{
  std::vector<std::uint8_t> skip;
  auto* array = vtkUnsignedCharArray::SafeDownCast(
    data->GetCellData()->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()));
  for (vtkIdType c = 0; array && c < array->GetNumberOfValues(); ++c)
  {
    skip.push_back(array->GetValue(c) &
                   (vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL));
  }
  return skip;
}

/// Mirrored bodies are counted, and a morph warns of them.
Finding checkMirrored(const Case& made, vtkUnstructuredGrid* output, const Run& run)
{
  const int isThere = isMirrored(made.grid.mesh);
  const double counted = fieldValue(output, "MirroredBodies");
  const bool isWarned = std::any_of(run.warnings.begin(), run.warnings.end(),
    [](const std::string& text) { return text.find("mirrored") != std::string::npos; });
  const bool isRight = isThere < 0 || (isThere == 1 ? counted > 0 : counted == 0);
  const bool isSaid = isThere != 1 || isWarned || !made.filter.isMorph;
  return isRight && isSaid ? Finding{}
                           : Finding{ "mirrored bodies", std::to_string(counted) + " counted" };
}

/// Counts of inverted cells and certificates against those of Recount.h.
Finding checkCounts(const Case& made, vtkUnstructuredGrid* output)
{
  const morph::Mesh& mesh = made.grid.mesh;
  const morph::Points points = pointsOf(output);
  if (made.grid.isShell() || made.grid.nodes.empty() || points.rows() != mesh.numberOfNodes())
  {
    return {};
  }
  const std::vector<std::uint8_t> skip = ghosts(output);
  const Recount count = recount(mesh, mesh.points, points, skip);
  const double reported =
    fieldValue(output, "InvertedCells") + fieldValue(output, "DegenerateCells");
  if (!(reported >= static_cast<double>(count.lowest) &&
        reported <= static_cast<double>(count.highest)))
  {
    return { "inverted cells", std::to_string(reported) + " reported, " +
                                 std::to_string(count.lowest) + " to " +
                                 std::to_string(count.highest) + " counted" };
  }
  vtkDataArray* quality = output->GetCellData()->GetArray("ScaledJacobian");
  for (Index c = 0; quality && c < mesh.numberOfCells(); ++c)
  {
    const double value = quality->GetComponent(c, 0);
    if ((count.bad[c] == 1 && value > 0) || (count.bad[c] == 0 && value <= 0) || value > 1 + 1e-9)
    {
      return { "scaled Jacobian",
        "of cell " + std::to_string(c) + " is " + std::to_string(value) +
          (count.bad[c] == 1 ? ", but it is inverted" : ", but it is not") };
    }
  }
  // Of linear hexahedra and wedges the scaled Jacobian says nothing about the inside.
  std::vector<signed char> isPositive(mesh.numberOfCells(), 0);
  for (Index c = 0; quality && c < mesh.numberOfCells(); ++c)
  {
    const morph::CellShape* shape = morph::cellShape(mesh.types[c]);
    const bool isQuadratic =
      shape && shape->numberOfNodes > shape->numberOfCorners && !morph::hasFaces(mesh, c);
    isPositive[c] = isQuadratic && quality->GetComponent(c, 0) > 0;
  }
  const Index wrong =
    falselyCertified(mesh, mesh.points, points, isPositive, 1e-3, made.choices.seed());
  if (wrong >= 0)
  {
    return { "scaled Jacobian", "of cell " + std::to_string(wrong) + ", which is inverted inside" };
  }
  auto* array = vtkSignedCharArray::SafeDownCast(
    output->GetCellData()->GetAbstractArray("JacobianCertificate"));
  if (array && array->GetNumberOfValues() == mesh.numberOfCells())
  {
    const std::vector<signed char> certificate(
      array->GetPointer(0), array->GetPointer(0) + array->GetNumberOfValues());
    for (Index c = 0; c < mesh.numberOfCells(); ++c)
    {
      if (count.bad[c] == 1 && certificate[c] == 1)
      {
        return { "certificate", "of cell " + std::to_string(c) + ", which is inverted" };
      }
    }
    const Index cell =
      falselyCertified(mesh, mesh.points, points, certificate, 1e-8, made.choices.seed());
    if (cell >= 0)
    {
      return { "certificate", "of cell " + std::to_string(cell) + ", which is inverted inside" };
    }
  }
  return {};
}

/// Cells and arrays are those of the input.
Finding checkCells(vtkUnstructuredGrid* input, vtkUnstructuredGrid* output)
{
  if (input->GetNumberOfPoints() != output->GetNumberOfPoints() ||
      input->GetNumberOfCells() != output->GetNumberOfCells())
  {
    return { "other cells", "numbers differ" };
  }
  for (vtkIdType c = 0; c < input->GetNumberOfCells(); ++c)
  {
    vtkIdType size, otherSize;
    const vtkIdType *ids, *otherIds;
    input->GetCells()->GetCellAtId(c, size, ids);
    const std::vector<vtkIdType> nodes(ids, ids + size);
    output->GetCells()->GetCellAtId(c, otherSize, otherIds);
    if (input->GetCellType(c) != output->GetCellType(c) ||
        nodes != std::vector<vtkIdType>(otherIds, otherIds + otherSize))
    {
      return { "other cells", "cell " + std::to_string(c) };
    }
  }
  return {};
}

bool isWhole(vtkMorphAlgorithm* filter)
{
  const std::string status = filter->GetMorphStatus();
  return status == "Valid" || status == "Inverted" || status == "SubStepped" ||
         status == "Repaired" || status == "CrossesItself";
}

/// Whether a node hangs on a face that is divided on one side alone. It follows that face, wherever
/// it is asked to go; collapsed cells of flat meshes have such nodes by chance.
bool hangs(morph::Mesh mesh, Index node)
{
  morph::Monitor monitor;
  morph::HangingNodes hanging;
  morph::recognizeCells(mesh, monitor);
  morph::boundaryFaces(mesh, hanging, monitor);
  return hanging.hangs(node);
}

/// Prescribed nodes are where the boundary puts them.
Finding checkPrescribed(const Case& made, vtkMorphAlgorithm* filter, vtkUnstructuredGrid* output)
{
  const morph::Points points = pointsOf(output);
  const double scale = filter->GetScaleFactor();
  // Coordinates of a boundary of few digits that are the undeformed ones, rounded, are these.
  const bool isOfFew = made.choices.value("boundary.float") != 0;
  const bool isRounded = isFloat(output) || isOfFew;
  // Floats below 1e-38 are multiples of one number, however small they are.
  const double subnormal =
    isRounded ? (1 + std::abs(scale)) * std::numeric_limits<float>::denorm_min() : 0;
  const Row normal = made.grid.known.faces == Known::Plane
                       ? planeOf(made.grid.mesh.points(made.grid.nodes, morph::allColumns)).second
                       : Row(Row::Zero());
  for (const auto& [node, target] : made.boundary.targets)
  {
    const Row rest = made.grid.mesh.points.row(node);
    const Row wanted = scale == 1   ? target
                       : scale == 0 ? rest
                                    : Row(rest + scale * (target - rest));
    Row x = points.row(node);
    // A plane mesh stays in its plane where the boundary does to 1e-6 of its size.
    const double off = (x - wanted).dot(normal);
    const double inPlane = normal.isZero() ? 0
                                           : (isRounded ? 1e-6 : 1e-13) *
                                               (made.grid.size + wanted.cwiseAbs().maxCoeff());
    x -= std::abs(off) <= 3e-6 * made.grid.size ? Row(off * normal) : Row(Row::Zero());
    bool isThere = true;
    for (int j = 0; j < 3; ++j)
    {
      const double rounding =
        (scale == 1 && made.boundary.isExact && !isOfFew) || scale == 0
          ? 0
          : (isRounded ? 1e-6 : 1e-14) *
                (std::abs(rest[j]) + std::abs(scale) * (std::abs(target[j]) + std::abs(rest[j]))) +
              subnormal;
      // Floats end where a coordinate's rounding, multiplied by ScaleFactor, may not.
      const double value = isFloat(output) && rounding == 0
                             ? static_cast<double>(static_cast<float>(wanted[j]))
                             : wanted[j];
      // Next to nothing may be the rounding of a boundary whose coordinates have few digits by
      // chance.
      isThere = isThere && std::abs(x[j] - value) <= rounding + inPlane + 1e-100 * made.grid.size;
    }
    if (!isThere && !hangs(made.grid.mesh, node))
    {
      return { "prescribed node",
        std::to_string(node) + " is at " + text(x) + ", not at " + text(wanted) };
    }
  }
  return {};
}

bool keepsAffineMaps(const Case& made, vtkMorphAlgorithm* filter)
{
  const Choices& choices = made.choices;
  const double tolerance = choices.value("property.Tolerance");
  return made.filter.isLinear && tolerance <= 1e-9 && !filter->GetPostSmooth() &&
         (filter->GetValidity() < vtkMorphAlgorithm::VALIDITY_SUB_STEP ||
           filter->GetValidity() == vtkMorphAlgorithm::VALIDITY_REFUSE) &&
         made.choices.value("hostile.mesh") == 0 && made.choices.value("hostile.boundary") == 0;
}

Finding checkAffine(const Case& made, vtkMorphAlgorithm* filter, vtkUnstructuredGrid* output)
{
  const morph::Mesh& mesh = made.grid.mesh;
  if (!made.boundary.isAffine || !keepsAffineMaps(made, filter) ||
      !isValid(mesh, mesh.points, 0.02))
  {
    return {};
  }
  const morph::Points points = pointsOf(output);
  const double scale = filter->GetScaleFactor();
  const double farthest = mesh.points.cwiseAbs().maxCoeff() + points.cwiseAbs().maxCoeff();
  const bool isRounded = isFloat(output) || made.choices.value("boundary.float") != 0;
  const double allowed =
    1e-6 * made.grid.size * (1 + std::abs(scale)) + (isRounded ? 1e-5 : 1e-11) * farthest;
  for (const Index n : made.grid.nodes)
  {
    const Row rest = mesh.points.row(n);
    const Row mapped = rest * made.boundary.matrix.transpose() + made.boundary.shift;
    const Row wanted = rest + scale * (mapped - rest);
    if (!((points.row(n) - wanted).norm() <= allowed))
    {
      return { "affine map", "node " + std::to_string(n) + " is at " + text(points.row(n)) +
                               ", not at " + text(wanted) };
    }
  }
  // What did not cross before does not after a map that folds nothing.
  const Eigen::Matrix3d map =
    Eigen::Matrix3d::Identity() + scale * (made.boundary.matrix - Eigen::Matrix3d::Identity());
  const Eigen::Vector3d stretches = Eigen::JacobiSVD<Eigen::Matrix3d>(map).singularValues();
  if (!isRounded && map.determinant() > 0 && stretches[2] > 0.05 * stretches[0] &&
      filter->GetCrossingFaces() > 0)
  {
    return { "crossings", std::to_string(filter->GetCrossingFaces()) + " faces of an affine map" };
  }
  return {};
}

/// After an error: a message, no counts, and the undeformed mesh or nothing.
template <typename F>
Finding checkFailed(const Case& made, F* filter, const Run& run)
{
  auto* output = vtkUnstructuredGrid::SafeDownCast(run.outputs.front());
  if (run.errors.empty() && filter->GetMorphStatus() == std::string("Failed"))
  {
    return { "silence", "a failure without a message" };
  }
  if (filter->GetInvertedCells() != -1 || filter->GetMinScaledJacobian() != -1 ||
      fieldValue(output, "InvertedCells") != -1 || fieldValue(output, "MinScaledJacobian") != -1)
  {
    return { "status", "counts after a failure" };
  }
  auto* input = vtkPointSet::SafeDownCast(made.inputs.front());
  const auto isSame = [&](const morph::Points& from, const morph::Points& to)
  {
    return from.rows() == to.rows() &&
           std::memcmp(from.data(), to.data(), from.size() * sizeof(double)) == 0; // NaN, too
  };
  if (output->GetNumberOfPoints() > 0 && !(input && isSame(pointsOf(input), pointsOf(output))))
  {
    return { "status", "a failure that moves nodes" };
  }
  return {};
}

/// Whether nothing about the case is odd: a valid mesh, and a boundary that moves moderately.
bool isPlainCase(const Case& made, vtkMorphAlgorithm* filter)
{
  for (const Choices::Choice& choice : made.choices.made())
  {
    if (choice.name.rfind("hostile", 0) == 0)
    {
      return false;
    }
  }
  return made.isRegular && made.grid.isAsMesh && !made.grid.nodes.empty() &&
         made.boundary.isRight && !made.boundary.targets.empty() &&
         filter->GetMatchTolerance() <= 1e-3 && isValid(made.grid.mesh, made.grid.mesh.points, 0.1);
}

/// All outer nodes move by one mild affine map.
bool isMildAffine(const Case& made, vtkMorphAlgorithm* filter)
{
  const Eigen::Matrix3d motion =
    filter->GetScaleFactor() * (made.boundary.matrix - Eigen::Matrix3d::Identity());
  return made.boundary.isAffine && motion.norm() < 0.5;
}

/// A plain case has a result: of linear methods always, unless inverted cells are refused or a mask
/// frees the boundary; of others where the motion is mild. Excepted are log-barrier weights outside
/// a hull, and inverted cells, where they are refused, that smoothing leaves or that quadratic
/// cells had inside before.
Finding checkAccepted(const Case& made, vtkMorphAlgorithm* filter, const Run& run)
{
  const std::string& name = made.filter.name;
  const bool mayRefuse = filter->GetValidity() > vtkMorphAlgorithm::VALIDITY_REPORT;
  const bool mayInvert = name == "SmoothingMorph" || made.choices.value("with.order") != 0;
  const bool isAlways = made.filter.isLinear && !mayRefuse && filter->GetFixUnnamedBoundary() &&
                        made.choices.value("with.mask") == 0;
  const bool isMild = isMildAffine(made, filter) && !(mayRefuse && mayInvert);
  // A curved shell encloses nothing that could be tessellated.
  const bool isShell = made.grid.isShell() && name.find("Simplex") != std::string::npos;
  const bool hasResult =
    name != "LBWarpMorph" && !isShell && (isAlways || isMild) && isPlainCase(made, filter);
  return run.errors.empty() || !hasResult ? Finding{} : Finding{ "refused", run.errors.front() };
}

/// Nodes that hang stay on their faces, images stay images, and nodes of a plane of symmetry in it.
/// `ids`: the node of each point of the output; none: all of the mesh.
Finding checkKnown(const Case& made, vtkPointSet* output, vtkDataArray* ids, const Run& run)
{
  const Known& known = made.grid.known;
  const morph::Points& rest = made.grid.mesh.points;
  if (!known.isAny() || made.grid.isShell() || !made.grid.isAsMesh || isFloat(output) ||
      !run.errors.empty() || made.choices.value("hostile.grid") != 0 ||
      made.choices.value("grid.points") == 2) // whole numbers
  {
    return {};
  }
  morph::Points moved = rest;
  const morph::Points points = pointsOf(output);
  for (Index p = 0; p < points.rows(); ++p)
  {
    moved.row(ids ? static_cast<Index>(ids->GetComponent(p, 0)) : p) = points.row(p);
  }
  const double farthest = std::max(rest.cwiseAbs().maxCoeff(), moved.cwiseAbs().maxCoeff());
  const double allowed = 1e-12 * made.grid.size + 1e-12 * farthest; // many steps round
  const auto found = [&](const char* oracle, double off)
  {
    std::ostringstream text;
    text << off / made.grid.size << " of the size, the farthest coordinate "
         << farthest / made.grid.size;
    return off > allowed ? Finding{ oracle, text.str() } : Finding{};
  };
  // Coordinates of few digits may leave the faces before.
  if (known.gap(rest) <= allowed && !ids)
  {
    if (const Finding gap = found("gap", known.gap(moved)))
    {
      return gap;
    }
  }
  const bool isDisplacement = vtkDisplacementAlgorithm::SafeDownCast(made.filter.make());
  // Roles may contradict each other, as where one of two images slides.
  if (!isDisplacement || made.choices.value("with.zones") != 0 || !run.warnings.empty() ||
      made.choices.value("with.surfaces") != 0)
  {
    return {};
  }
  if (const Finding images = found("images", known.parted(rest, moved)))
  {
    return images;
  }
  return found("plane of symmetry", known.offPlane(rest, moved));
}

/// If the middle of a hexahedron of one body is deep in a valid one of the other, faces cross. Not
/// if these are far longer than wide: then bodies are as near as if they were in contact.
Finding checkOverlap(const Case& made, vtkUnstructuredGrid* output)
{
  const std::vector<Index>& twin = made.grid.known.twin;
  const bool isCompact = !twin.empty() && made.choices.value("place.stretched") == 0;
  std::vector<vtkIdType> cells[2]; // of the bodies
  for (vtkIdType c = 0; c < output->GetNumberOfCells() && isCompact; ++c)
  {
    if (output->GetCellType(c) == VTK_HEXAHEDRON &&
        output->GetCellData()->GetArray("ScaledJacobian")->GetComponent(c, 0) > 0.2)
    {
      const vtkIdType node = output->GetCell(c)->GetPointId(0);
      cells[std::binary_search(twin.begin(), twin.end(), node)].push_back(c);
    }
  }
  for (const vtkIdType other : cells[1])
  {
    double middle[3] = { 0.5, 0.5, 0.5 }, x[3], weights[8], r[3], distance;
    int sub = 0;
    output->GetCell(other)->EvaluateLocation(sub, middle, x, weights);
    for (const vtkIdType c : cells[0])
    {
      const bool isIn =
        output->GetCell(c)->EvaluatePosition(x, nullptr, sub, r, distance, weights) == 1;
      if (isIn && std::all_of(r, r + 3, [](double at) { return at > 0.3 && at < 0.7; }) &&
          fieldValue(output, "CrossingFaces") == 0)
      {
        return { "crossings", "none, but cell " + std::to_string(c) + " has the middle of cell " +
                                std::to_string(other) + " of another body" };
      }
    }
  }
  return {};
}

bool hasAdvice(vtkAlgorithm* filter)
{
  auto* mesh = vtkMorphMesh::SafeDownCast(filter);
  return mesh && std::string(mesh->GetAdvice()) != "None";
}

/// The moved mesh of any filter that morphs one, and what it says of it.
template <typename F>
Finding checkMesh(const Case& made, F* filter, const Run& run)
{
  auto* output = vtkUnstructuredGrid::SafeDownCast(run.outputs.front());
  if (!output)
  {
    return {}; // blocks come out as blocks
  }
  const std::string status = filter->GetMorphStatus();
  if (status == "Failed" || status == "Cancelled")
  {
    return checkFailed(made, filter, run);
  }
  if (output->GetNumberOfPoints() == 0)
  {
    return status == "None" ? Finding{} : Finding{ "status", status + " without an output" };
  }
  if (hasAdvice(filter))
  {
    return {}; // nothing moves, and the boundary alone comes out
  }
  if (const Finding found = checkFinite(output, "MorphDisplacement"))
  {
    return found;
  }
  if (!made.grid.isAsMesh || filter->GetQuality() != F::QUALITY_ALL)
  {
    return {};
  }
  for (const auto& found : { checkCells(made.grid.grid(), output), checkCounts(made, output),
         checkMirrored(made, output, run), checkKnown(made, output, nullptr, run),
         checkOverlap(made, output) })
  {
    if (found)
    {
      return found;
    }
  }
  const double reported =
    fieldValue(output, "InvertedCells") + fieldValue(output, "DegenerateCells");
  const auto counted =
    static_cast<double>(filter->GetInvertedCells() + filter->GetDegenerateCells());
  if (reported != counted)
  {
    return { "status", "getters and field data differ" };
  }
  if ((status == "CrossesItself") > (fieldValue(output, "CrossingFaces") > 1))
  {
    return { "status", status + " without faces that cross" };
  }
  const bool claimsValid = status == "Valid" || status == "SubStepped" || status == "Repaired" ||
                           status == "CrossesItself";
  // Positions are valid as computed; rounding to float may undo that, and ghosts are not measured.
  const bool isRight =
    !claimsValid || isFloat(output) || made.grid.hasGhosts ||
    (filter->GetNewInvertedCells() == 0 &&
      (filter->GetInvertedBefore() > 0 || (reported == 0 && filter->GetMinScaledJacobian() > 0)));
  return isRight ? Finding{} : Finding{ "status", status + " with inverted cells" };
}

Finding checkMorph(const Case& made, vtkMorphAlgorithm* filter, const Run& run)
{
  for (const auto& found : { checkAccepted(made, filter, run), checkMesh(made, filter, run) })
  {
    if (found)
    {
      return found;
    }
  }
  auto* output = vtkUnstructuredGrid::SafeDownCast(run.outputs.front());
  // A huge tolerance lets any point stand for any node.
  if (!output || !made.grid.isAsMesh || !made.boundary.isRight || !run.errors.empty() ||
      !isWhole(filter) || filter->GetMatchTolerance() > 1e-3)
  {
    return {};
  }
  const Finding found = checkPrescribed(made, filter, output);
  return found ? found : checkAffine(made, filter, output);
}

/// The sum over the boundary is that over the mesh, since the methods keep translations.
Finding checkAdjoint(const Case& made, const Run& run)
{
  auto* output = vtkPointSet::SafeDownCast(run.outputs.front());
  auto* carrier = vtkPointSet::SafeDownCast(made.inputs[2]);
  vtkDataArray* gradient = output->GetPointData()->GetArray("MorphGradient");
  vtkDataArray* given = carrier ? carrier->GetPointData()->GetArray("Gradient") : nullptr;
  // A cell that was added may bring more nodes to the boundary, which are held.
  const bool namesAll =
    made.grid.isAsMesh && made.boundary.isAffine && made.boundary.isRight && made.isRegular;
  if (!gradient || !given || !namesAll || made.choices.value("hostile.mesh") != 0 ||
      !isValid(made.grid.mesh, made.grid.mesh.points, 0.02))
  {
    return {};
  }
  Row sum = Row::Zero(), wanted = Row::Zero();
  double sizes = 0;
  for (vtkIdType p = 0; p < gradient->GetNumberOfTuples(); ++p)
  {
    double value[3];
    gradient->GetTuple(p, value);
    sum += Row(value[0], value[1], value[2]);
  }
  std::vector<Index> moved = made.grid.nodes;
  for (const AttachedPart& part :
    made.grid.isShell() ? std::vector<AttachedPart>() : attachedParts(made.grid.mesh))
  {
    if (!part.anchors.empty())
    {
      moved.insert(moved.end(), part.nodes.begin(), part.nodes.end());
    }
  }
  for (const Index n : moved)
  {
    double value[3];
    given->GetTuple(n, value);
    wanted += Row(value[0], value[1], value[2]);
    sizes += Row(value[0], value[1], value[2]).norm();
  }
  if (made.grid.known.faces == Known::Plane)
  {
    // Derivatives are those in the plane.
    const morph::Points nodes = made.grid.mesh.points(made.grid.nodes, morph::allColumns);
    const Row normal = planeOf(nodes).second;
    wanted -= wanted.dot(normal) * normal;
    sum -= sum.dot(normal) * normal;
  }
  return (sum - wanted).norm() <= 1e-5 * sizes
           ? Finding{}
           : Finding{ "adjoint", "sums to " + text(sum) + ", not " + text(wanted) };
}
}

Finding checkOutput(const Case& made, vtkAlgorithm* filter, const Run& run)
{
  if (auto* morph = vtkMorphAlgorithm::SafeDownCast(filter))
  {
    return checkMorph(made, morph, run);
  }
  if (auto* mesh = vtkMorphMesh::SafeDownCast(filter))
  {
    return checkMesh(made, mesh, run);
  }
  if (auto* shapes = vtkMorphShapes::SafeDownCast(filter))
  {
    return checkMesh(made, shapes, run);
  }
  auto* output = vtkPointSet::SafeDownCast(run.outputs.front());
  if (!run.errors.empty() || !run.fromExecutive.empty() || !output)
  {
    return {};
  }
  static const std::map<std::string, const char*> written = { { "MorphAdjoint", "MorphGradient" },
    { "BoundaryDisplacement", "BoundaryDisplacement" }, { "ExtractMorphBoundary", "RestPosition" },
    { "ClassifyBoundary", "CurveParameter" } };
  const auto name = written.find(made.filter.name);
  const Finding notFinite = checkFinite(output, name == written.end() ? "" : name->second);
  if (notFinite)
  {
    return notFinite;
  }
  if (made.filter.name == "MorphAdjoint")
  {
    return checkAdjoint(made, run);
  }
  if (!made.grid.isAsMesh || output->GetNumberOfPoints() == 0)
  {
    return {};
  }
  if (made.filter.name == "ScaledJacobian")
  {
    auto* grid = vtkUnstructuredGrid::SafeDownCast(output);
    for (const auto& found : { checkCells(made.grid.grid(), grid), checkCounts(made, grid),
           checkMirrored(made, grid, run) })
    {
      if (found)
      {
        return found;
      }
    }
    return {};
  }
  if (made.filter.name == "ExtractMorphBoundary")
  {
    return checkExtracted(made, output);
  }
  if (made.filter.name == "ClassifyBoundary")
  {
    return checkClassified(made, output);
  }
  if (made.filter.name == "MorphBoundary")
  {
    return checkMovedBoundary(made, filter, run);
  }
  if (made.filter.name == "BoundaryDisplacement")
  {
    vtkDataArray* ids = output->GetPointData()->GetArray("MorphPointId");
    const Finding known =
      made.inputs[0] == made.grid.data && ids ? checkKnown(made, output, ids, run) : Finding{};
    return known ? known : checkDisplaced(made, output);
  }
  return {};
}
}
