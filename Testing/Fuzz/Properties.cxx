// SPDX-License-Identifier: BSD-3-Clause
#include "Properties.h"

#include "PropertyRows.h"
#include "vtkMorphAdjoint.h"
#include "vtkSimplexLinearMorph.h"

#include <vtkCallbackCommand.h>
#include <vtkNew.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

namespace fuzz
{
namespace
{
using Table = std::vector<Property>;

/// Values that a user may want, where a property's own range is wider or takes too long.
struct Usual
{
  const char* name;
  double low, high;
};
constexpr Usual Usuals[] = { { "NumberOfThreads", 1, 3 }, { "ScaleFactor", -0.5, 1.5 },
  { "NumberOfSteps", 0, 3 }, { "StepMemoryLimit", 0, 0.01 }, { "MemoryLimit", 0, 0.01 },
  { "MaximumSubSteps", 1, 20 }, { "PostSmoothIterations", 1, 40 }, { "RestTime", -1, 1 },
  { "StiffnessExponent", 0, 2 }, { "IterationLimit", 1, 100 }, { "NumberOfNeighbors", 1, 100 },
  { "SupportRadius", 0.1, 3 }, { "NumberOfCenters", 0, 100 }, { "SlideRounds", 0, 3 },
  { "KeepLayers", 0, 2 }, { "Distance", -0.2, 0.2 }, { "RadiusChange", -0.2, 0.2 },
  { "HandleRadius", 0, 0.2 } };

/// All properties of a class that are one number. `plain`: values that are plain here in place of
/// the defaults.
Table ofTable(const std::string& filter, const std::map<std::string, double>& plain = {})
{
  Table table;
  for (const property_rows::Row& row : property_rows::Rows)
  {
    if ("vtk" + filter != row.filter)
    {
      continue;
    }
    Property property{ row.name, row.usual, row.least, row.most,
      row.kind != property_rows::Kind::Number, row.set };
    const auto usual = std::find_if(std::begin(Usuals), std::end(Usuals),
      [&](const Usual& one) { return property.name == one.name; });
    if (usual != std::end(Usuals))
    {
      property.low = std::max(usual->low, row.least);
      property.high = usual->high;
    }
    property.plain = property.name == "NumberOfThreads" ? 1 : row.usual;
    const auto own = plain.find(property.name);
    property.plain = own == plain.end() ? property.plain : own->second;
    property.isLength = property.name == "Distance" || property.name == "RadiusChange" ||
                        property.name == "HandleRadius";
    table.push_back(property);
  }
  return table;
}

/// In units of the mesh's size.
Property length(const char* name, std::function<void(vtkAlgorithm*, double)> set)
{
  return { name, 0, -0.2, 0.2, false, std::move(set), true };
}

Table joined(Table first, const Table& second)
{
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

/// The vectors of vtkDisplacementAlgorithm, each by one number.
Table vectors()
{
  using F = vtkDisplacementAlgorithm;
  return { length("Vector", [](vtkAlgorithm* filter, double value)
             { F::SafeDownCast(filter)->SetVector(value, -0.3 * value, 0.3 * value); }),
    length("Translation", [](vtkAlgorithm* filter, double value)
      { F::SafeDownCast(filter)->SetTranslation(0, value, 0.1 * value); }),
    { "Rotation", 0, -40, 40, false,
      [](vtkAlgorithm* filter, double value)
      { F::SafeDownCast(filter)->SetRotation(0.2 * value, 0, value); } },
    { "Scale", 1, 0.8, 1.2, false, [](vtkAlgorithm* filter, double value) {
       F::SafeDownCast(filter)->SetScale(value, 1, 1 / value);
     } } };
}

template <int Shape>
Property weight(const char* name, double plain)
{
  return { name, plain, -1.5, 1.5, false, [](vtkAlgorithm* filter, double value) {
            vtkMorphShapes::SafeDownCast(filter)->SetWeight(Shape, value);
          } };
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
    { "FEMWarpMorph", 3, true, true, maker<vtkFEMWarpMorph>(), ofTable("FEMWarpMorph") },
    { "LBWarpMorph", 3, true, true, maker<vtkLBWarpMorph>(), ofTable("LBWarpMorph") },
    { "WeightedResidualMorph", 3, true, true, maker<vtkWeightedResidualMorph>(),
      ofTable("WeightedResidualMorph") },
    { "RadialBasisMorph", 3, true, true, maker<vtkRadialBasisMorph>(),
      ofTable("RadialBasisMorph") },
    { "SimplexLinearMorph", 3, true, true, maker<vtkSimplexLinearMorph>(),
      ofTable("SimplexLinearMorph") },
    { "SimplexNaturalNeighborMorph", 3, true, true, maker<vtkSimplexNaturalNeighborMorph>(),
      ofTable("SimplexNaturalNeighborMorph") },
    { "InversionFreeMorph", 3, true, false, maker<vtkInversionFreeMorph>(),
      ofTable("InversionFreeMorph", { { "Validity", vtkMorphAlgorithm::VALIDITY_REPORT } }) },
    { "SmoothingMorph", 3, true, false, maker<vtkSmoothingMorph>(), ofTable("SmoothingMorph") },
    { "ScaledJacobian", 3, false, false, maker<vtkScaledJacobian>(), ofTable("ScaledJacobian") },
    { "ClassifyBoundary", 3, false, false, maker<vtkClassifyBoundary>(),
      ofTable("ClassifyBoundary") },
    { "ExtractMorphBoundary", 2, false, false, maker<vtkExtractMorphBoundary>(),
      ofTable("ExtractMorphBoundary") },
    { "MorphBoundary", 3, false, false, maker<vtkMorphBoundary>(), ofTable("MorphBoundary") },
    { "BoundaryDisplacement", 3, false, false, maker<vtkBoundaryDisplacement>(),
      joined(vectors(), ofTable("BoundaryDisplacement")) },
    { "MorphMesh", 4, false, false, maker<vtkMorphMesh>(),
      joined(vectors(), ofTable("MorphMesh", { { "Moving", vtkMorphMesh::MOVING_EVERYTHING } })) },
    { "FitToSurface", 2, false, false, maker<vtkMorphMesh>(),
      joined(vectors(),
        ofTable("MorphMesh", { { "Displacement", vtkMorphMesh::DISPLACEMENT_TARGET } })) },
    { "MorphShapes", 3, false, false, maker<vtkMorphShapes>(),
      joined({ weight<0>("Weight0", 1), weight<1>("Weight1", 0), weight<2>("Weight2", 0) },
        ofTable("MorphShapes")) },
    // Plain: one method, one step. All of them would take too long.
    { "CompareMorphMethods", 1, false, false, maker<vtkCompareMorphMethods>(),
      ofTable("CompareMorphMethods",
        { { "Smoothing", 0 }, { "WeightedResidual", 0 }, { "SimplexLinear", 0 },
          { "SimplexNaturalNeighbor", 0 }, { "RadialBasis", 0 }, { "LBWARP", 0 },
          { "InversionFree", 0 }, { "NumberOfSteps", 1 } }) },
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
