// SPDX-License-Identifier: BSD-3-Clause
#include "MotionOracles.h"

#include "Mesh/FaceTable.h"
#include "RandomMesh.h"
#include "Recount.h"
#include "SameData.h"
#include "vtkBoundaryDisplacement.h"
#include "vtkDisplacementAlgorithm.h"
#include "vtkLBWarpMorph.h"
#include "vtkMorphAlgorithm.h"
#include "vtkMorphBoundary.h"
#include "vtkMorphMesh.h"
#include "vtkMorphShapes.h"
#include "vtkSimplexLinearMorph.h"
#include "vtkSimplexNaturalNeighborMorph.h"

#include <vtkCellData.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <sstream>

namespace fuzz
{
namespace
{
using morph::Index;
using Row = Eigen::RowVector3d;

constexpr double Infinity = std::numeric_limits<double>::infinity();

std::string text(double value)
{
  std::ostringstream stream;
  stream << value;
  return stream.str();
}

bool isOfType(vtkPointSet* data, int type)
{
  return data->GetPoints() && data->GetPoints()->GetDataType() == type;
}

bool isFloat(vtkPointSet* data)
{
  return isOfType(data, VTK_FLOAT);
}

/// What coordinates lose, in their unit.
double rounding(const morph::Points& x, bool isSingle)
{
  // Floats below 1e-38 are multiples of one number, however small they are.
  const double subnormal = isSingle ? 2 * std::numeric_limits<float>::denorm_min() : 0;
  const double unit = isSingle ? 1.2e-7 : 4.5e-16;
  return x.size() == 0 ? 0 : unit * x.cwiseAbs().maxCoeff() + subnormal;
}

/// By how much a case moves the boundary, at most, in sizes of the mesh; infinite if that is not
/// known.
double motionOf(const Case& made, vtkAlgorithm* filter)
{
  const Choices& choices = made.choices;
  double scale = std::abs(choices.value("property.ScaleFactor"));
  if (vtkDisplacementAlgorithm::SafeDownCast(filter))
  {
    // A turn about the origin moves a mesh the more, the farther it is from there.
    const bool isNear = made.grid.mesh.points.lpNorm<Eigen::Infinity>() <= 50 * made.grid.size;
    return made.isRegular && scale <= Tiny && isNear ? scale : Infinity;
  }
  if (!vtkMorphAlgorithm::SafeDownCast(filter) && !vtkMorphShapes::SafeDownCast(filter) &&
      !vtkMorphBoundary::SafeDownCast(filter))
  {
    return Infinity;
  }
  if (vtkMorphShapes::SafeDownCast(filter))
  {
    const int shapes = static_cast<int>(made.inputs.size()) - 1;
    scale = 0;
    for (int i = 0; i < shapes; ++i)
    {
      scale += std::abs(choices.value("property.Weight" + std::to_string(i)));
    }
    if (shapes > 1 && scale > 0)
    {
      return Infinity;
    }
  }
  const bool isKnown = made.boundary.isRight || vtkCompositeDataSet::SafeDownCast(made.grid.data);
  const bool isMatched = choices.value("property.MatchTolerance") <= 1e-3;
  if (!isKnown || !isMatched || !std::isfinite(scale) || !made.inputs[1] ||
      (vtkMorphBoundary::SafeDownCast(filter) && made.inputs[2]))
  {
    return Infinity;
  }
  if (made.boundary.isNothing || scale == 0)
  {
    return 0;
  }
  double most = made.boundary.isRight ? 0 : Infinity;
  for (const auto& [node, target] : made.boundary.targets)
  {
    most = std::max(most, (target - made.grid.mesh.points.row(node)).norm());
  }
  return scale * most / made.grid.size;
}

/// Whether a case may move nodes though its motion is that small: methods that improve any mesh.
bool mayImprove(const Case& made, double motion)
{
  const auto value = [&](const char* name)
  { return made.choices.value(std::string("property.") + name); };
  const bool isMesh = made.filter.name == "MorphMesh" || made.filter.name == "FitToSurface";
  const double method = isMesh ? value("Method") : -1;
  const bool isInversionFree =
    made.filter.name == "InversionFreeMorph" || method == vtkMorphMesh::METHOD_INVERSION_FREE;
  const morph::Mesh& mesh = made.grid.mesh;
  return made.filter.name == "SmoothingMorph" || method == vtkMorphMesh::METHOD_SMOOTHING ||
         value("PostSmooth") != 0 || value("Validity") >= vtkMorphAlgorithm::VALIDITY_REPAIR_ALL ||
         (isInversionFree &&
           (motion > 0 || !made.grid.isAsMesh || made.choices.value("with.order") != 0 ||
             !isValid(mesh, mesh.points, 0)));
}

/// The largest motion of a point of output 0.
double farthest(const Case& made, const Run& run, double& rounded)
{
  const bool isBoundary =
    made.filter.name == "MorphBoundary" || made.filter.name == "BoundaryDisplacement";
  const std::vector<vtkDataObject*> outputs = leaves(run.outputs.front()),
                                    inputs = leaves(made.inputs.front());
  double most = 0;
  for (std::size_t i = 0; i < std::min(outputs.size(), inputs.size()); ++i)
  {
    auto *output = vtkPointSet::SafeDownCast(outputs[i]),
         *input = vtkPointSet::SafeDownCast(inputs[i]);
    if (!output || !input || (isBoundary && !made.grid.isAsMesh))
    {
      continue;
    }
    const morph::Points x = pointsOf(output);
    morph::Points rest = pointsOf(input);
    if (isBoundary)
    {
      vtkDataArray* ids = output->GetPointData()->GetArray("MorphPointId");
      rest.resize(x.rows(), 3);
      for (Index p = 0; p < x.rows(); ++p)
      {
        const auto node = static_cast<Index>(ids->GetComponent(p, 0));
        const bool isImage = node >= made.grid.mesh.numberOfNodes(); // across a shell
        rest.row(p) = isImage ? x.row(p) : made.grid.mesh.points.row(node);
      }
    }
    if (rest.rows() == x.rows() && x.rows() > 0)
    {
      const double motion = (x - rest).rowwise().norm().maxCoeff();
      most = motion <= most ? most : motion; // not a number: kept
      rounded = std::max(rounded, rounding(rest, isFloat(output)));
    }
  }
  return most;
}

/// A map of space under which a morph is to stay what it is.
struct Frame
{
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  Row shift = Row::Zero();

  Row point(const Row& x) const { return x * this->matrix.transpose() + this->shift; }
  Row vector(const Row& x) const { return x * this->matrix.transpose(); }
};

constexpr int Origin = 2;     ///< far away
constexpr int Reflection = 4; ///< the last kind of frame

Frame randomFrame(Choices& choices, int kind, double size)
{
  Random random = choices.stream("frame");
  Frame frame;
  switch (kind)
  {
    case 1:
      frame.matrix *= random.power(-9, 6);
      break;
    case 2:
      frame.shift = 1e6 * size * Row(1, -0.7, 0.3);
      break;
    case 3:
      frame.matrix = Eigen::AngleAxisd(std::acos(0.), Eigen::Vector3d::Unit(random.below(3)))
                       .toRotationMatrix()
                       .array()
                       .round();
      break;
    default:
      frame.matrix.col(random.below(3)) *= -1;
      break;
  }
  return frame;
}

vtkSmartPointer<vtkDataObject> inFrame(vtkDataObject* data, const Frame& frame)
{
  vtkSmartPointer<vtkDataObject> copy = deepCopy(data);
  auto* points = vtkPointSet::SafeDownCast(copy);
  for (vtkIdType p = 0; points && p < points->GetNumberOfPoints(); ++p)
  {
    const Row x =
      frame.point(Row(points->GetPoint(p)[0], points->GetPoint(p)[1], points->GetPoint(p)[2]));
    points->GetPoints()->SetPoint(p, x.data());
    for (const char* name : { "RestPosition", "MyDisplacement" })
    {
      vtkDataArray* array = points->GetPointData()->GetArray(name);
      double value[9];
      if (array)
      {
        array->GetTuple(p, value);
        const Row from(value[0], value[1], value[2]);
        const Row to = *name == 'R' ? frame.point(from) : frame.vector(from);
        std::copy_n(to.data(), 3, value);
        array->SetTuple(p, value);
      }
    }
  }
  return copy;
}

/// Whether a result is to be the same to rounding: else counts and qualities are. Of centers that
/// are equally far some are chosen by their places. The iterations that improve surfaces end at
/// thresholds of their own.
bool isExact(const Case& made, vtkAlgorithm* filter)
{
  auto* morph = vtkMorphAlgorithm::SafeDownCast(filter);
  auto* boundary = vtkMorphBoundary::SafeDownCast(filter);
  if (boundary)
  {
    return boundary->GetSurfaceMethod() == vtkMorphBoundary::SURFACE_METHOD_WEIGHTED_RESIDUAL;
  }
  return !morph || (made.filter.isLinear && !morph->GetPostSmooth() &&
                     made.choices.value("property.NumberOfCenters") == 0 &&
                     (std::string(morph->GetMorphStatus()) == "Valid" ||
                       std::string(morph->GetMorphStatus()) == "CrossesItself" ||
                       std::string(morph->GetMorphStatus()) == "Inverted"));
}

/// All outer nodes are prescribed.
bool isHeld(const Case& made)
{
  return made.choices.value("property.FixUnnamedBoundary") != 0 &&
         made.choices.value("with.mask") == 0;
}

/// Whether rounding decides if free nodes in a flat side, or of a plane mesh, lie in the hull of
/// their neighbors.
bool isOnHull(const Case& made, vtkAlgorithm* filter)
{
  auto* shapes = vtkMorphShapes::SafeDownCast(filter);
  const bool isFlat = !isHeld(made) || made.grid.isShell();
  return isFlat && (vtkLBWarpMorph::SafeDownCast(filter) ||
                     (shapes && shapes->GetMethod() == vtkMorphShapes::METHOD_LBWARP));
}

/// Whether rounding decides which of a target's places is nearest, or which simplex extrapolates to
/// a node outside all.
bool isUndecided(const Case& made, vtkAlgorithm* filter)
{
  const auto extrapolates = [](auto* morph) { return morph && morph->GetExtrapolatedNodes() > 0; };
  auto* shapes = vtkMorphShapes::SafeDownCast(filter);
  return (vtkMorphBoundary::SafeDownCast(filter) && made.inputs[2]) ||
         (shapes && !isHeld(made) &&
           (shapes->GetMethod() == vtkMorphShapes::METHOD_SIMPLEX_LINEAR ||
             shapes->GetMethod() == vtkMorphShapes::METHOD_SIMPLEX_NATURAL_NEIGHBOR)) ||
         extrapolates(vtkSimplexLinearMorph::SafeDownCast(filter)) ||
         extrapolates(vtkSimplexNaturalNeighborMorph::SafeDownCast(filter));
}

struct Quality
{
  double bad;
  double least; ///< NaN if nothing is measured, as of ghosts, or if cells were inverted before
};

Quality qualityOf(vtkAlgorithm* filter)
{
  if (auto* boundary = vtkMorphBoundary::SafeDownCast(filter))
  {
    return { static_cast<double>(boundary->GetFoldedFaces()), boundary->GetMinScaledJacobian() };
  }
  auto* morph = vtkMorphAlgorithm::SafeDownCast(filter);
  if (morph->GetInvertedBefore() > 0) // a repair may mend these by the way, or not
  {
    return { static_cast<double>(morph->GetNewInvertedCells()), NAN };
  }
  return { static_cast<double>(morph->GetInvertedCells() + morph->GetDegenerateCells()),
    morph->GetMinScaledJacobian() };
}

/// Whether two minima are the same within 2 %, or 0.0002. A search ends by its energy, and leaves
/// nodes in their places to a part of an edge, however near the minimum is to 0. Where inverted
/// cells remain in both, the objective has no bound or many minima, and rounding decides at which a
/// search ends.
bool areAlike(const Quality& one, const Quality& other)
{
  if (one.bad > 0 || other.bad > 0)
  {
    return one.bad > 0 && other.bad > 0;
  }
  const double size = std::max({ std::abs(one.least), std::abs(other.least), 0.01 });
  return (std::isnan(one.least) && std::isnan(other.least)) ||
         std::abs(one.least - other.least) <= 0.02 * size;
}

bool isPlain(const Case& made)
{
  const std::vector<Choices::Choice>& choices = made.choices.made();
  const bool isHostile = std::any_of(choices.begin(), choices.end(),
    [](const Choices::Choice& choice) { return choice.name.rfind("hostile", 0) == 0; });
  return !isHostile && made.isRegular && made.grid.isAsMesh && made.boundary.isRight &&
         !made.varying && isValid(made.grid.mesh, made.grid.mesh.points, 0.1);
}
}

Finding checkNothing(const Case& made, vtkAlgorithm* filter, const Run& run)
{
  const double motion = motionOf(made, filter);
  const bool isPoor = motion > 0 && !isPlain(made);
  if (!(motion <= Tiny) || isPoor || !std::isfinite(made.grid.size) || !run.errors.empty() ||
      !run.fromExecutive.empty() || mayImprove(made, motion))
  {
    return {};
  }
  double rounded = 0;
  const double most = farthest(made, run, rounded);
  const double allowed = (motion == 0 ? 1e-12 : 1e-7) * made.grid.size + rounded;
  return most <= allowed
           ? Finding{}
           : Finding{ motion == 0 ? "nothing asked" : "next to nothing asked",
               "a node moves by " + text(most / made.grid.size) + " sizes, for " + text(motion) };
}

Finding checkFrame(Case& made, vtkAlgorithm* filter, const Run& first)
{
  const bool isOfData = vtkMorphAlgorithm::SafeDownCast(filter) ||
                        vtkMorphShapes::SafeDownCast(filter) ||
                        vtkMorphBoundary::SafeDownCast(filter);
  const int kind =
    isOfData ? made.choices.pick("with.frame",
                 { "none", "unit", "origin", "quarter turn", "reflection" }, { 8, 1, 1, 1, 1 })
             : 0;
  const double tolerance = made.choices.value("property.Tolerance");
  const bool isMatched = made.choices.value("property.MatchTolerance") <= 1e-3;
  auto* output = vtkPointSet::SafeDownCast(first.outputs.front());
  auto* input = vtkPointSet::SafeDownCast(made.inputs.front());
  if (kind == 0 || !isPlain(made) || tolerance > 1e-10 || !isMatched || !output || !input ||
      !isOfType(output, VTK_DOUBLE) || !isOfType(input, VTK_DOUBLE) ||
      made.choices.value("boundary.float") != 0 || isUndecided(made, filter) ||
      (kind == Origin && isOnHull(made, filter)) || // digits are lost far away
      // Of nodes that are equally far the first by place is a center.
      (kind > Origin && made.choices.value("property.NumberOfCenters") != 0) ||
      // The images across a shell are on the side from which its cells are wound clockwise.
      (kind == Reflection && (made.grid.isShell() || isInvertedByMirror(made.grid.mesh))))
  {
    return {};
  }
  const Frame frame = randomFrame(made.choices, kind, made.grid.size);
  std::vector<vtkSmartPointer<vtkDataObject>> data;
  for (const auto& given : made.inputs)
  {
    data.push_back(given ? inFrame(given, frame) : nullptr);
  }
  const auto other = made.makeFilter(data, 0);
  const Run second = execute(other, made.time);
  if (first.errors.empty() != second.errors.empty())
  {
    return { "frame",
      "an error in one of them: " + (first.errors.empty() ? second.errors : first.errors).front() };
  }
  auto* moved = vtkPointSet::SafeDownCast(second.outputs.front());
  if (!first.errors.empty() || output->GetNumberOfPoints() == 0)
  {
    return {};
  }
  if (moved->GetNumberOfPoints() != output->GetNumberOfPoints())
  {
    return { "frame", "other numbers of points" };
  }
  const double unit = std::cbrt(std::abs(frame.matrix.determinant()));
  const morph::Points x = pointsOf(moved);
  const morph::Points y = pointsOf(output);
  const double lost = std::max(rounding(x, false) / unit, rounding(y, false));
  if (isExact(made, filter) && isExact(made, other))
  {
    std::pair<double, Index> most = { 0, -1 };
    for (Index p = 0; p < x.rows(); ++p)
    {
      most = std::max(most, { (x.row(p) - frame.point(y.row(p))).norm() / unit, p });
    }
    return most.first <= 1e-9 * made.grid.size + 1e3 * lost
             ? Finding{}
             : Finding{ "frame", "point " + std::to_string(most.second) + " is " +
                                   text(most.first / made.grid.size) + " sizes off" };
  }
  // A motion that the other frame's digits do not show is none there, and leaves a valid mesh.
  const double motion = motionOf(made, filter) * made.grid.size;
  if (motion > 0 && motion <= 10 * lost)
  {
    return {};
  }
  const Quality own = qualityOf(filter), others = qualityOf(other);
  return areAlike(own, others)
           ? Finding{}
           : Finding{ "frame", text(own.bad) + " and " + text(others.bad) + " inverted, minimum " +
                                 text(own.least) + " and " + text(others.least) };
}

Finding checkAttached(const Case& made, vtkAlgorithm* filter, const Run& run)
{
  auto* output = vtkPointSet::SafeDownCast(run.outputs.front());
  const bool isMorph =
    vtkMorphAlgorithm::SafeDownCast(filter) || vtkMorphShapes::SafeDownCast(filter);
  if (!isMorph || !run.errors.empty() || !run.fromExecutive.empty() || !made.grid.isAsMesh ||
      made.grid.hasGhosts || !made.boundary.isRight || !output || !isOfType(output, VTK_DOUBLE) ||
      output->GetNumberOfPoints() != made.grid.mesh.numberOfNodes())
  {
    return {};
  }
  const morph::Points& rest = made.grid.mesh.points;
  const morph::Points x = pointsOf(output);
  const double allowed = 1e3 * (rounding(x, false) + rounding(rest, false));
  for (const AttachedPart& part :
    made.grid.isShell() ? std::vector<AttachedPart>() : attachedParts(made.grid.mesh))
  {
    for (std::size_t i = 0; i < part.nodes.size() && part.anchors.size() < 2; ++i)
    {
      const Index node = part.nodes[i];
      const Index other = i > 0                  ? part.nodes[i - 1]
                          : part.anchors.empty() ? node
                                                 : part.anchors.front();
      const double off = part.anchors.empty() ? (x.row(node) - rest.row(node)).norm()
                                              : std::abs((x.row(node) - x.row(other)).norm() -
                                                         (rest.row(node) - rest.row(other)).norm());
      if (!(off <= (part.anchors.empty() ? 0 : allowed)))
      {
        return { "attached", "node " + std::to_string(node) + " is off by " + text(off) };
      }
    }
  }
  return {};
}

Finding checkBetween(const Case& made, vtkAlgorithm* filter, const Run& run)
{
  auto* output = vtkPointSet::SafeDownCast(run.outputs.front());
  const Known& known = made.grid.known;
  if (known.between.empty() || !vtkMorphAlgorithm::SafeDownCast(filter) || !run.errors.empty() ||
      !run.fromExecutive.empty() || !isExact(made, filter) || !made.grid.isAsMesh ||
      made.grid.hasGhosts || !made.boundary.isRight || !output || !isOfType(output, VTK_DOUBLE) ||
      made.choices.value("grid.points") == 2 ||
      output->GetNumberOfPoints() != made.grid.mesh.numberOfNodes())
  {
    return {};
  }
  std::set<Index> given;
  for (const auto& [node, target] : made.boundary.targets)
  {
    given.insert(node);
  }
  const morph::Points& rest = made.grid.mesh.points;
  const morph::Points x = pointsOf(output), moved = x - rest;
  const bool isSingle = made.choices.value("grid.points") == 1; // nodes leave the line
  const double allowed = 1e-9 * made.grid.size +
                         1e3 * (rounding(x, false) + rounding(rest, false)) +
                         10 * rounding(rest, isSingle);
  for (const Known::Between& own : known.between)
  {
    const Row wanted = (1 - own.at) * moved.row(own.ends[0]) + own.at * moved.row(own.ends[1]);
    const double off = (moved.row(own.node) - wanted).norm();
    if (given.count(own.node) == 0 && !(off <= allowed))
    {
      return { "between", "node " + std::to_string(own.node) + " is off by " +
                            text(off / made.grid.size) + " sizes" };
    }
  }
  return {};
}

namespace
{
/// The least distance, above 0, of nodes that follow one another in a cell.
double shortestEdge(const morph::Mesh& mesh)
{
  double least = std::numeric_limits<double>::infinity();
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    for (Index k = 1; k < mesh.cellSize(c); ++k)
    {
      const double length =
        (mesh.points.row(mesh.cell(c)[k]) - mesh.points.row(mesh.cell(c)[k - 1])).norm();
      least = length > 0 ? std::min(least, length) : least;
    }
  }
  return least;
}
}

Finding checkRanges(Case& made, vtkAlgorithm* filter, const Run& run)
{
  auto* shapes = vtkMorphShapes::SafeDownCast(filter);
  auto* output = vtkPointSet::SafeDownCast(run.outputs.front());
  if (!shapes || !run.errors.empty() || !made.grid.isAsMesh || made.grid.hasGhosts || !output ||
      output->GetNumberOfPoints() == 0 || isFloat(output) ||
      shapes->GetQuality() != vtkMorphShapes::QUALITY_ALL || !shapes->GetFindValidRanges() ||
      !made.choices.chance("with.ranges", 0.3))
  {
    return {};
  }
  constexpr double Inside = 1 - 1e-6;
  std::vector<std::vector<double>> tries;
  std::vector<double> weights;
  for (int i = 0; i < shapes->GetNumberOfShapes(); ++i)
  {
    weights.push_back(shapes->GetWeight(i));
  }
  for (int i = 0; i < shapes->GetNumberOfShapes(); ++i)
  {
    for (const double end : { shapes->GetLowestWeight(i), shapes->GetHighestWeight(i) })
    {
      if (std::isfinite(end) && end != 0) // the range is open
      {
        tries.push_back(weights);
        tries.back()[i] = Inside * end;
      }
    }
  }
  if (std::isfinite(shapes->GetLargestFactor()) && shapes->GetLargestFactor() != 0)
  {
    tries.push_back(weights);
    for (double& weight : tries.back())
    {
      weight *= Inside * shapes->GetLargestFactor();
    }
  }
  for (const std::vector<double>& tried : tries)
  {
    for (std::size_t i = 0; i < tried.size(); ++i)
    {
      shapes->SetWeight(static_cast<int>(i), tried[i]);
    }
    const Run again = execute(shapes, made.time);
    // Of places that are too far, and of cells without volume, the determinants are rounding.
    const morph::Points places = pointsOf(vtkPointSet::SafeDownCast(again.outputs.front()));
    const bool isFar = places.cwiseAbs().maxCoeff() > 1e4 * made.grid.size ||
                       rounding(places, false) > 1e-6 * shortestEdge(made.grid.mesh);
    const double least = 10 * rounding(places, false) / shortestEdge(made.grid.mesh);
    if (again.errors.empty() && !isFar && shapes->GetNewInvertedCells() > 0 &&
        shapes->GetMinScaledJacobian() < -std::max(1e-12, least))
    {
      std::string list;
      for (const double weight : tried)
      {
        list += " " + text(weight);
      }
      return { "valid range", text(shapes->GetMinScaledJacobian()) + " at weights" + list };
    }
  }
  return {};
}

namespace
{
/// The names and sizes of surfaces, and where they are.
std::vector<std::string> listed(vtkDisplacementAlgorithm* filter)
{
  filter->UpdateInformation();
  std::vector<std::string> texts;
  vtkStringArray* sizes = filter->GetSurfaceSizes();
  for (vtkIdType i = 0; i < sizes->GetNumberOfValues(); ++i)
  {
    texts.push_back(sizes->GetValue(i));
  }
  return texts;
}

template <typename F>
void forgetNames(vtkAlgorithm* algorithm)
{
  if (auto* filter = F::SafeDownCast(algorithm))
  {
    filter->RemoveAllSurfaces();
    filter->RemoveAllFixedSurfaces();
    filter->RemoveAllSlidingSurfaces();
    filter->RemoveAllFreeSurfaces();
  }
}

/// How many faces are of one cell of each part, and of no other cell.
Index countBetween(const RandomGrid& grid)
{
  const morph::Mesh& mesh = grid.mesh;
  morph::Monitor monitor;
  const morph::FaceTable table = morph::faceTable(mesh, monitor);
  vtkDataArray* parts[] = { grid.grid()->GetCellData()->GetArray("Left"),
    grid.grid()->GetCellData()->GetArray("Right") };
  std::map<Index, std::vector<Index>> cellsOf;
  for (Index c = 0; c < mesh.numberOfCells(); ++c)
  {
    for (Index f = table.start[c]; f < table.start[c + 1]; ++f)
    {
      cellsOf[table.first[f]].push_back(c);
    }
  }
  Index count = 0;
  for (const auto& [face, cells] : cellsOf)
  {
    const auto is = [&, all = &cells](int part, int cell)
    { return parts[part]->GetComponent((*all)[cell], 0) != 0; };
    count += cells.size() == 2 && ((is(0, 0) && is(1, 1)) || (is(0, 1) && is(1, 0)));
  }
  return count;
}
}

Finding checkParts(Case& made, vtkAlgorithm* algorithm)
{
  auto* filter = vtkDisplacementAlgorithm::SafeDownCast(algorithm);
  if (!filter || !made.grid.hasParts || made.inputs.front() != made.grid.data ||
      !made.grid.isAsMesh || made.grid.nodes.empty())
  {
    return {};
  }
  const std::vector<std::string> asked = listed(filter);
  auto other = made.makeFilter();
  forgetNames<vtkBoundaryDisplacement>(other);
  forgetNames<vtkMorphMesh>(other);
  const std::vector<std::string> all = listed(vtkDisplacementAlgorithm::SafeDownCast(other));
  if (asked != all)
  {
    return { "parts", "the list of surfaces depends on what is asked for" };
  }
  const auto found = std::find(all.begin(), all.end(), "Left | Right");
  const Index count = all.empty() ? 0 : countBetween(made.grid);
  const std::string wanted = count > 0 ? text(static_cast<double>(count)) + " inner" : "";
  const std::string given = found == all.end() ? "" : *(found + 1);
  return given == wanted ? Finding{} : Finding{ "parts", "'" + given + "', not '" + wanted + "'" };
}
}
