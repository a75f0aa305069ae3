// SPDX-License-Identifier: BSD-3-Clause
#include "Properties.h"

#include "vtkBoundaryDisplacement.h"
#include "vtkClassifyBoundary.h"
#include "vtkCompareMorphMethods.h"
#include "vtkExtractMorphBoundary.h"
#include "vtkFEMWarpMorph.h"
#include "vtkInversionFreeMorph.h"
#include "vtkLBWarpMorph.h"
#include "vtkMorphAdjoint.h"
#include "vtkMorphBoundary.h"
#include "vtkMorphMesh.h"
#include "vtkMorphShapes.h"
#include "vtkRadialBasisMorph.h"
#include "vtkScaledJacobian.h"
#include "vtkSimplexLinearMorph.h"
#include "vtkSimplexNaturalNeighborMorph.h"
#include "vtkSmoothingMorph.h"
#include "vtkWeightedResidualMorph.h"

#include <vtkCallbackCommand.h>
#include <vtkNew.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace fuzz
{
namespace
{
using Table = std::vector<Property>;

template <typename F>
Property real(const char* name, void (F::*set)(double), double plain, double low, double high)
{
  return { name, plain, low, high, false,
    [set](vtkAlgorithm* filter, double value) { (F::SafeDownCast(filter)->*set)(value); } };
}

template <typename F>
Property whole(const char* name, void (F::*set)(int), int plain, int low, int high)
{
  return { name, static_cast<double>(plain), static_cast<double>(low), static_cast<double>(high),
    true, [set](vtkAlgorithm* filter, double value) {
      (F::SafeDownCast(filter)->*set)(static_cast<int>(value));
    } };
}

template <typename F>
Property flag(const char* name, void (F::*set)(bool), bool plain)
{
  return { name, plain ? 1.0 : 0.0, 0, 1, true,
    [set](vtkAlgorithm* filter, double value) { (F::SafeDownCast(filter)->*set)(value != 0); } };
}

template <typename F>
Property threads()
{
  return whole<F>("NumberOfThreads", &F::SetNumberOfThreads, 1, 1, 3);
}

/// In units of the mesh's size.
Property length(const char* name, std::function<void(vtkAlgorithm*, double)> set)
{
  Property property = { name, 0, -0.2, 0.2, false, std::move(set) };
  property.isLength = true;
  return property;
}

Table joined(Table first, const Table& second)
{
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

/// Those of vtkMorphAlgorithm.
Table ofMorph(bool certify = false)
{
  using F = vtkMorphAlgorithm;
  return { threads<F>(), real<F>("ScaleFactor", &F::SetScaleFactor, 1, -0.5, 1.5),
    whole<F>("NumberOfSteps", &F::SetNumberOfSteps, 0, 0, 3),
    whole<F>("Stepping", &F::SetStepping, 0, 0, 1),
    real<F>("StepMemoryLimit", &F::SetStepMemoryLimit, 1000, 0, 0.01),
    real<F>("MatchTolerance", &F::SetMatchTolerance, 1e-6, 0, 1),
    flag<F>("FixUnnamedBoundary", &F::SetFixUnnamedBoundary, true),
    whole<F>("Validity", &F::SetValidity, F::VALIDITY_REPORT, 0, 5),
    flag<F>("Certify", &F::SetCertify, certify),
    flag<F>("FeatureLines", &F::SetFeatureLines, false),
    whole<F>("CoincidentPoints", &F::SetCoincidentPoints, 0, 0, 2),
    whole<F>("MaximumSubSteps", &F::SetMaximumSubSteps, 64, 1, 20),
    flag<F>("PostSmooth", &F::SetPostSmooth, false),
    whole<F>("PostSmoothIterations", &F::SetPostSmoothIterations, 20, 1, 40),
    real<F>("RestTime", &F::SetRestTime, -1e300, -1, 1),
    whole<F>("OutputPointsPrecision", &F::SetOutputPointsPrecision, F::DEFAULT_PRECISION, 0, 2) };
}

Table ofFEMWarp()
{
  using F = vtkFEMWarpMorph;
  return joined(ofMorph(), { real<F>("Tolerance", &F::SetTolerance, 1e-10, 1e-15, 0.999),
                             whole<F>("Stiffness", &F::SetStiffness, 0, 0, 2),
                             real<F>("StiffnessExponent", &F::SetStiffnessExponent, 1, 0, 2) });
}

Table ofLBWarp()
{
  using F = vtkLBWarpMorph;
  return joined(ofMorph(), { real<F>("Tolerance", &F::SetTolerance, 1e-10, 1e-15, 0.999),
                             whole<F>("OutsideHull", &F::SetOutsideHull, 0, 0, 1) });
}

Table ofInversionFree()
{
  using F = vtkInversionFreeMorph;
  return { whole<F>("Effort", &F::SetEffort, F::EFFORT_DEFAULT, 0, 2) };
}

Table ofSmoothing()
{
  using F = vtkSmoothingMorph;
  return { whole<F>("TargetShape", &F::SetTargetShape, F::TARGET_SHAPE_IDEAL, 0, 1),
    whole<F>("Objective", &F::SetObjective, F::OBJECTIVE_ADAPTIVE, 0, 2),
    whole<F>("IterationLimit", &F::SetIterationLimit, 50, 1, 100),
    real<F>("StopMove", &F::SetStopMove, 1e-3, 1e-12, 1) };
}

Table ofMorphBoundary()
{
  using F = vtkMorphBoundary;
  return { threads<F>(), whole<F>("PrescribedDimension", &F::SetPrescribedDimension, 1, 0, 2),
    whole<F>("SurfaceMethod", &F::SetSurfaceMethod, 0, 0, 2),
    whole<F>("NumberOfNeighbors", &F::SetNumberOfNeighbors, 20, 1, 40),
    whole<F>("UnattachedMotion", &F::SetUnattachedMotion, 0, 0, 2),
    real<F>("FeatureAngle", &F::SetFeatureAngle, 25, 0, 180),
    real<F>("CornerAngle", &F::SetCornerAngle, 45, 0, 180),
    flag<F>("UseGeometryArrays", &F::SetUseGeometryArrays, true),
    flag<F>("FeaturesInside", &F::SetFeaturesInside, false),
    real<F>("ScaleFactor", &F::SetScaleFactor, 1, -0.5, 1.5),
    real<F>("MatchTolerance", &F::SetMatchTolerance, 1e-6, 0, 1),
    real<F>("TargetReach", &F::SetTargetReach, 0.1, 0, 10),
    real<F>("TargetAngle", &F::SetTargetAngle, 60, 0, 180),
    real<F>("RestTime", &F::SetRestTime, -1e300, -1, 1),
    whole<F>("OutputPointsPrecision", &F::SetOutputPointsPrecision, F::DEFAULT_PRECISION, 0, 2) };
}

/// Those of vtkDisplacementAlgorithm.
Table ofDisplacement()
{
  using F = vtkDisplacementAlgorithm;
  return { threads<F>(),
    length("Vector", [](vtkAlgorithm* filter, double value)
      { F::SafeDownCast(filter)->SetVector(value, -0.3 * value, 0.3 * value); }),
    length("Translation", [](vtkAlgorithm* filter, double value)
      { F::SafeDownCast(filter)->SetTranslation(0, value, 0.1 * value); }),
    { "Rotation", 0, -40, 40, false,
      [](vtkAlgorithm* filter, double value)
      { F::SafeDownCast(filter)->SetRotation(0.2 * value, 0, value); } },
    { "Scale", 1, 0.8, 1.2, false,
      [](vtkAlgorithm* filter, double value)
      { F::SafeDownCast(filter)->SetScale(value, 1, 1 / value); } },
    length("Distance",
      [](vtkAlgorithm* filter, double value) { F::SafeDownCast(filter)->SetDistance(value); }),
    length("RadiusChange",
      [](vtkAlgorithm* filter, double value) { F::SafeDownCast(filter)->SetRadiusChange(value); }),
    flag<F>("AutoCenter", &F::SetAutoCenter, true),
    flag<F>("TransformAboutCenter", &F::SetTransformAboutCenter, false),
    flag<F>("AlignTarget", &F::SetAlignTarget, false),
    real<F>("TargetReach", &F::SetTargetReach, 0.2, 0, 10),
    real<F>("TargetAngle", &F::SetTargetAngle, 60, 0, 180),
    whole<F>("ProjectAlong", &F::SetProjectAlong, F::PROJECT_ALONG_CLOSEST_POINT, 0,
      F::PROJECT_ALONG_VECTOR),
    flag<F>("SelectedHandles", &F::SetSelectedHandles, false),
    whole<F>("LatticeBasis", &F::SetLatticeBasis, 0, 0, 1),
    flag<F>("AutoLattice", &F::SetAutoLattice, true),
    real<F>("ScaleFactor", &F::SetScaleFactor, 1, -0.5, 1.5),
    whole<F>("Surroundings", &F::SetSurroundings, 1, 0, 3),
    real<F>("FalloffRadius", &F::SetFalloffRadius, 0.1, 0, 10),
    whole<F>("SlideRounds", &F::SetSlideRounds, 0, 0, 3),
    whole<F>("KeepLayers", &F::SetKeepLayers, 0, 0, 2),
    whole<F>("CoincidentPoints", &F::SetCoincidentPoints, 0, 0, 2),
    whole<F>("SurfaceMethod", &F::SetSurfaceMethod, 0, 0, 2),
    real<F>("FeatureAngle", &F::SetFeatureAngle, 25, 0, 180),
    real<F>("CornerAngle", &F::SetCornerAngle, 45, 0, 180),
    flag<F>("UseGeometryArrays", &F::SetUseGeometryArrays, true),
    whole<F>("OutputPointsPrecision", &F::SetOutputPointsPrecision, F::DEFAULT_PRECISION, 0, 2) };
}

Table ofBoundaryDisplacement()
{
  using F = vtkBoundaryDisplacement;
  return { whole<F>("Moving", &F::SetMoving, 0, 0, 5), whole<F>("Motion", &F::SetMotion, 0, 0, 8),
    whole<F>("UnattachedMotion", &F::SetUnattachedMotion, 0, 0, 2) };
}

/// `moving`, `displacement`: plain values.
Table ofMorphMesh(int moving, int displacement)
{
  using F = vtkMorphMesh;
  return { whole<F>("Moving", &F::SetMoving, moving, 0, 4),
    whole<F>("Displacement", &F::SetDisplacement, displacement, 0, 8),
    whole<F>("Method", &F::SetMethod, 0, 0, 7),
    whole<F>("Validity", &F::SetValidity, vtkMorphAlgorithm::VALIDITY_REPAIR, 0, 5),
    whole<F>("Stiffness", &F::SetStiffness, 0, 0, 2),
    real<F>("StiffnessExponent", &F::SetStiffnessExponent, 1, 0, 2),
    real<F>("SoftStiffness", &F::SetSoftStiffness, 0.01, 1e-6, 1),
    whole<F>("Quality", &F::SetQuality, 0, 0, 1),
    flag<F>("FeatureLines", &F::SetFeatureLines, false), flag<F>("Live", &F::SetLive, false),
    whole<F>("NumberOfSteps", &F::SetNumberOfSteps, 0, 0, 3),
    whole<F>("Stepping", &F::SetStepping, 0, 0, 1),
    real<F>("RestTime", &F::SetRestTime, -1e300, -1, 1) };
}

template <int Shape>
Property weight(const char* name, double plain)
{
  return { name, plain, -1.5, 1.5, false, [](vtkAlgorithm* filter, double value) {
            vtkMorphShapes::SafeDownCast(filter)->SetWeight(Shape, value);
          } };
}

Table ofMorphShapes()
{
  using F = vtkMorphShapes;
  return { threads<F>(), weight<0>("Weight0", 1), weight<1>("Weight1", 0), weight<2>("Weight2", 0),
    whole<F>("Method", &F::SetMethod, 0, 0, 5),
    real<F>("Tolerance", &F::SetTolerance, 1e-10, 1e-15, 0.999),
    flag<F>("FindValidRanges", &F::SetFindValidRanges, true),
    real<F>("MatchTolerance", &F::SetMatchTolerance, 1e-6, 0, 1),
    flag<F>("FixUnnamedBoundary", &F::SetFixUnnamedBoundary, true),
    whole<F>("Quality", &F::SetQuality, 0, 0, 1),
    flag<F>("FeatureLines", &F::SetFeatureLines, false),
    whole<F>("CoincidentPoints", &F::SetCoincidentPoints, 0, 0, 2),
    whole<F>("OutputPointsPrecision", &F::SetOutputPointsPrecision, F::DEFAULT_PRECISION, 0, 2) };
}

Table ofClassify()
{
  using F = vtkClassifyBoundary;
  return { threads<F>(), real<F>("FeatureAngle", &F::SetFeatureAngle, 25, 0, 180),
    real<F>("CornerAngle", &F::SetCornerAngle, 45, 0, 180),
    flag<F>("UseGeometryArrays", &F::SetUseGeometryArrays, true),
    flag<F>("FeaturesInside", &F::SetFeaturesInside, false) };
}

Table ofCompare()
{
  using F = vtkCompareMorphMethods;
  // Plain: one method, one step. All of them would take too long.
  return { threads<F>(), flag<F>("Smoothing", &F::SetSmoothing, false),
    flag<F>("WeightedResidual", &F::SetWeightedResidual, false),
    flag<F>("SimplexLinear", &F::SetSimplexLinear, false),
    flag<F>("SimplexNaturalNeighbor", &F::SetSimplexNaturalNeighbor, false),
    flag<F>("RadialBasis", &F::SetRadialBasis, false), flag<F>("FEMWARP", &F::SetFEMWARP, true),
    flag<F>("LBWARP", &F::SetLBWARP, false), flag<F>("InversionFree", &F::SetInversionFree, false),
    flag<F>("Absolute", &F::SetAbsolute, true), flag<F>("Relative", &F::SetRelative, false),
    whole<F>("NumberOfSteps", &F::SetNumberOfSteps, 1, 1, 3),
    real<F>("Percentile", &F::SetPercentile, 1, 0, 100),
    real<F>("ScaleFactor", &F::SetScaleFactor, 1, -0.5, 1.5),
    real<F>("MatchTolerance", &F::SetMatchTolerance, 1e-6, 0, 1),
    flag<F>("FixUnnamedBoundary", &F::SetFixUnnamedBoundary, true),
    real<F>("RestTime", &F::SetRestTime, -1e300, -1, 1) };
}

template <typename F>
std::function<vtkSmartPointer<vtkAlgorithm>()> maker()
{
  return [] { return vtkSmartPointer<vtkAlgorithm>(vtkSmartPointer<F>::New()); };
}

/// Out of range, or at its ends.
double wildValue(const Property& property, Random& random)
{
  if (property.isWhole)
  {
    constexpr int values[] = { -1, std::numeric_limits<int>::max(), std::numeric_limits<int>::min(),
      1000, 0 };
    return values[random.below(5)];
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr double values[] = { std::numeric_limits<double>::quiet_NaN(), infinity, -infinity,
    1e300, -1e300, 1e78, 1e40, -1, 0, 1e-300, std::numeric_limits<double>::quiet_NaN() };
  return values[random.below(11)];
}

/// Whether a value asks for a long run, which is not an endless one.
bool isTooLong(const Property& property, double value)
{
  return (property.name == "NumberOfSteps" && value > 50) ||
         (property.name == "PostSmoothIterations" && value > 1000) ||
         (property.name == "IterationLimit" && value > 1000);
}
}

const std::vector<Filter>& filters()
{
  static const std::vector<Filter> all = {
    { "FEMWarpMorph", 3, true, true, maker<vtkFEMWarpMorph>(), ofFEMWarp() },
    { "LBWarpMorph", 3, true, true, maker<vtkLBWarpMorph>(), ofLBWarp() },
    { "WeightedResidualMorph", 3, true, true, maker<vtkWeightedResidualMorph>(),
      joined(ofMorph(), { whole<vtkWeightedResidualMorph>("NumberOfNeighbors",
                          &vtkWeightedResidualMorph::SetNumberOfNeighbors, 80, 1, 100) }) },
    { "RadialBasisMorph", 3, true, true, maker<vtkRadialBasisMorph>(),
      joined(
        ofMorph(), { whole<vtkRadialBasisMorph>("Kernel", &vtkRadialBasisMorph::SetKernel, 0, 0, 2),
                     real<vtkRadialBasisMorph>(
                       "SupportRadius", &vtkRadialBasisMorph::SetSupportRadius, 1, 0.1, 3),
                     whole<vtkRadialBasisMorph>(
                       "NumberOfCenters", &vtkRadialBasisMorph::SetNumberOfCenters, 0, 0, 100) }) },
    { "SimplexLinearMorph", 3, true, true, maker<vtkSimplexLinearMorph>(), ofMorph() },
    { "SimplexNaturalNeighborMorph", 3, true, true, maker<vtkSimplexNaturalNeighborMorph>(),
      joined(ofMorph(), { real<vtkSimplexNaturalNeighborMorph>("MemoryLimit",
                          &vtkSimplexNaturalNeighborMorph::SetMemoryLimit, 4000, 0, 0.01) }) },
    { "InversionFreeMorph", 3, true, false, maker<vtkInversionFreeMorph>(),
      joined(ofMorph(true), ofInversionFree()) },
    { "SmoothingMorph", 3, true, false, maker<vtkSmoothingMorph>(),
      joined(ofMorph(), ofSmoothing()) },
    { "ScaledJacobian", 3, false, false, maker<vtkScaledJacobian>(),
      { threads<vtkScaledJacobian>(),
        flag<vtkScaledJacobian>("Certify", &vtkScaledJacobian::SetCertify, false) } },
    { "ClassifyBoundary", 3, false, false, maker<vtkClassifyBoundary>(), ofClassify() },
    { "ExtractMorphBoundary", 2, false, false, maker<vtkExtractMorphBoundary>(),
      { threads<vtkExtractMorphBoundary>() } },
    { "MorphBoundary", 3, false, false, maker<vtkMorphBoundary>(), ofMorphBoundary() },
    { "BoundaryDisplacement", 3, false, false, maker<vtkBoundaryDisplacement>(),
      joined(ofDisplacement(), ofBoundaryDisplacement()) },
    { "MorphMesh", 4, false, false, maker<vtkMorphMesh>(),
      joined(ofDisplacement(), ofMorphMesh(vtkMorphMesh::MOVING_EVERYTHING, 0)) },
    { "FitToSurface", 2, false, false, maker<vtkMorphMesh>(),
      joined(ofDisplacement(),
        ofMorphMesh(vtkMorphMesh::MOVING_SURFACES, vtkMorphMesh::DISPLACEMENT_TARGET)) },
    { "MorphShapes", 3, false, false, maker<vtkMorphShapes>(), ofMorphShapes() },
    { "CompareMorphMethods", 1, false, false, maker<vtkCompareMorphMethods>(), ofCompare() },
    { "MorphAdjoint", 2, false, false, maker<vtkMorphAdjoint>(), {} },
  };
  return all;
}

const Filter& filterOf(std::uint64_t seed)
{
  int shares = 0;
  for (const Filter& filter : filters())
  {
    shares += filter.share;
  }
  auto at = static_cast<int>(seed % static_cast<std::uint64_t>(shares));
  const Filter* found = filters().data();
  while (at >= found->share)
  {
    at -= found->share;
    ++found;
  }
  return *found;
}

PropertiesSet setProperties(
  Choices& choices, const Filter& filter, double size, vtkAlgorithm* algorithm)
{
  const bool hostile = choices.chance("hostile.properties", 0.09);
  // Of many properties fewer, so that most cases have a result.
  const double part = hostile ? 0.3 : filter.properties.size() > 15 ? 0.12 : 0.25;
  PropertiesSet result;
  bool isRefused = false;
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(&isRefused);
  command->SetCallback(
    [](vtkObject*, unsigned long, void* heard, void*) { *static_cast<bool*>(heard) = true; });
  const unsigned long tag = algorithm->AddObserver(vtkCommand::ErrorEvent, command);
  for (const Property& property : filter.properties)
  {
    const auto draw = [&](Random& random)
    {
      if (!random.happens(part))
      {
        return property.plain;
      }
      double value = random.between(property.low, property.high);
      if (property.isWhole)
      {
        const int last = static_cast<int>(property.high - property.low);
        value = property.low + random.below(last + 1);
      }
      const bool isScale = property.name == "ScaleFactor" || property.name == "Weight0";
      if (isScale && random.happens(0.4))
      {
        value = random.happens(0.5) ? 0 : Tiny; // see checkNothing()
      }
      if (hostile && random.happens(0.5))
      {
        const double wild = wildValue(property, random);
        value = isTooLong(property, wild) ? value : wild;
      }
      return value;
    };
    const double value = choices.number("property." + property.name, property.plain, draw);
    // What is plain here need not be the filter's default.
    isRefused = false;
    property.set(algorithm, property.isLength ? value * size : value);
    if (!std::isfinite(value) && !isRefused && result.accepted.empty())
    {
      result.accepted = property.name;
    }
    const bool isUsual = value >= property.low && value <= property.high;
    result.areRegular = result.areRegular && (value == property.plain || isUsual);
  }
  algorithm->RemoveObserver(tag);
  return result;
}
}
