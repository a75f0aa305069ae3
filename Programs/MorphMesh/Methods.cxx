// SPDX-License-Identifier: BSD-3-Clause
#include "Methods.h"

#include "Arguments.h"

#include <vtkFEMWarpMorph.h>
#include <vtkInversionFreeMorph.h>
#include <vtkLBWarpMorph.h>
#include <vtkMorphShapes.h>
#include <vtkRadialBasisMorph.h>
#include <vtkSimplexLinearMorph.h>
#include <vtkSimplexNaturalNeighborMorph.h>
#include <vtkSmoothingMorph.h>
#include <vtkWeightedResidualMorph.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <functional>
#include <vector>

namespace morph_mesh
{
namespace
{
struct Option
{
  std::string name;
  std::vector<std::string> words; ///< the values 0, 1, ...; empty for a number
  double least, most;
  std::function<void(vtkMorphAlgorithm*, double)> set;
};

struct Method
{
  std::string name;
  std::function<vtkSmartPointer<vtkMorphAlgorithm>()> make;
  std::vector<Option> options;
};

template <typename Filter>
vtkSmartPointer<vtkMorphAlgorithm> make()
{
  return vtkSmartPointer<Filter>::New();
}

template <typename Filter, typename Set>
std::function<void(vtkMorphAlgorithm*, double)> setter(Set set)
{
  return [set](vtkMorphAlgorithm* method, double value)
  { set(Filter::SafeDownCast(method), value); };
}

template <typename Filter>
Option tolerance()
{
  return { "Tolerance", {}, 1e-15, 0.999,
    setter<Filter>([](Filter* filter, double value) { filter->SetTolerance(value); }) };
}

const std::vector<Method>& methods()
{
  using Fem = vtkFEMWarpMorph;
  using Free = vtkInversionFreeMorph;
  using LBWarp = vtkLBWarpMorph;
  using Natural = vtkSimplexNaturalNeighborMorph;
  using Radial = vtkRadialBasisMorph;
  using Smoothing = vtkSmoothingMorph;
  using Residual = vtkWeightedResidualMorph;
  static const std::vector<Method> all = {
    { "FEMWARP", make<Fem>,
      { tolerance<Fem>(),
        { "Stiffness", { "Uniform", "InverseVolume", "WallDistance" }, 0, 2,
          setter<Fem>([](Fem* f, double v) { f->SetStiffness(static_cast<int>(v)); }) },
        { "StiffnessExponent", {}, 0, 4,
          setter<Fem>([](Fem* f, double v) { f->SetStiffnessExponent(v); }) } } },
    { "InversionFree", make<Free>,
      { { "Effort", { "Quick", "Default", "Thorough" }, 0, 2,
        setter<Free>([](Free* f, double v) { f->SetEffort(static_cast<int>(v)); }) } } },
    { "LBWARP", make<LBWarp>,
      { tolerance<LBWarp>(),
        { "OutsideHull", { "Error", "Relax" }, 0, 1,
          setter<LBWarp>([](LBWarp* f, double v) { f->SetOutsideHull(static_cast<int>(v)); }) } } },
    { "RadialBasis", make<Radial>,
      { { "Kernel", { "Triharmonic", "ThinPlate", "WendlandC2" }, 0, 2,
          setter<Radial>([](Radial* f, double v) { f->SetKernel(static_cast<int>(v)); }) },
        { "SupportRadius", {}, 1e-3, 1e3,
          setter<Radial>([](Radial* f, double v) { f->SetSupportRadius(v); }) },
        { "NumberOfCenters", {}, 0, 4000,
          setter<Radial>(
            [](Radial* f, double v) { f->SetNumberOfCenters(static_cast<int>(v)); }) } } },
    { "SimplexLinear", make<vtkSimplexLinearMorph>, {} },
    { "SimplexNaturalNeighbor", make<Natural>,
      { { "MemoryLimit", {}, 0, 1e12,
        setter<Natural>([](Natural* f, double v) { f->SetMemoryLimit(v); }) } } },
    { "Smoothing", make<Smoothing>,
      { { "TargetShape", { "Initial", "Ideal" }, 0, 1,
          setter<Smoothing>(
            [](Smoothing* f, double v) { f->SetTargetShape(static_cast<int>(v)); }) },
        { "Objective", { "MeanRatio", "ConditionNumber", "Adaptive" }, 0, 2,
          setter<Smoothing>([](Smoothing* f, double v) { f->SetObjective(static_cast<int>(v)); }) },
        { "IterationLimit", {}, 1, 100000,
          setter<Smoothing>(
            [](Smoothing* f, double v) { f->SetIterationLimit(static_cast<int>(v)); }) },
        { "StopMove", {}, 1e-12, 1,
          setter<Smoothing>([](Smoothing* f, double v) { f->SetStopMove(v); }) } } },
    { "WeightedResidual", make<Residual>,
      { { "NumberOfNeighbors", {}, 1, VTK_INT_MAX,
        setter<Residual>(
          [](Residual* f, double v) { f->SetNumberOfNeighbors(static_cast<int>(v)); }) } } },
  };
  return all;
}

std::string plain(const std::string& name)
{
  std::string result;
  for (const char c : name)
  {
    if (c != '-' && c != '_' && c != ' ')
    {
      result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  return result;
}

template <typename Named>
const Named* find(const std::vector<Named>& all, const std::string& name)
{
  const auto found = std::find_if(
    all.begin(), all.end(), [&](const Named& one) { return plain(one.name) == plain(name); });
  return found == all.end() ? nullptr : &*found;
}

template <typename Named>
std::string names(const std::vector<Named>& all)
{
  std::string result;
  for (const Named& one : all)
  {
    result += (result.empty() ? "" : ", ") + one.name;
  }
  return result;
}

std::string join(const std::vector<std::string>& words, const char* between)
{
  std::string result;
  for (const std::string& word : words)
  {
    result += (result.empty() ? "" : between) + word;
  }
  return result;
}

double valueOf(const Option& option, const std::string& text)
{
  for (std::size_t i = 0; i < option.words.size(); ++i)
  {
    if (plain(option.words[i]) == plain(text))
    {
      return static_cast<double>(i);
    }
  }
  if (!option.words.empty())
  {
    throw UsageError(
      option.name + " is one of " + join(option.words, ", ") + ", not '" + text + "'.");
  }
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(value >= option.least && value <= option.most))
  {
    throw UsageError(option.name + " is a number from " + std::to_string(option.least) + " to " +
                     std::to_string(option.most) + ", not '" + text + "'.");
  }
  return value;
}
}

vtkSmartPointer<vtkMorphAlgorithm> makeMethod(const std::string& name)
{
  const Method* method = find(methods(), name);
  if (!method)
  {
    throw UsageError("There is no method '" + name + "'; there are " + methodNames() + ".");
  }
  return method->make();
}

void setOption(vtkMorphAlgorithm* method, const std::string& name, const std::string& value)
{
  const auto own = std::find_if(methods().begin(), methods().end(),
    [&](const Method& one)
    { return std::string(method->GetClassName()) == one.make()->GetClassName(); });
  const Option* option = find(own->options, name);
  if (!option)
  {
    throw UsageError(own->name + " has no option '" + name + "'" +
                     (own->options.empty() ? "." : "; it has " + names(own->options) + "."));
  }
  option->set(method, valueOf(*option, value));
}

void setShapesMethod(vtkMorphShapes* filter, const std::string& name,
  const std::vector<std::pair<std::string, std::string>>& options)
{
  const std::vector<std::string> linear = { "FEMWARP", "LBWARP", "WeightedResidual",
    "SimplexLinear", "SimplexNaturalNeighbor", "RadialBasis" }; // as vtkMorphShapes::MethodType
  const auto found = std::find_if(linear.begin(), linear.end(),
    [&](const std::string& method) { return plain(method) == plain(name); });
  if (found == linear.end())
  {
    throw UsageError(
      "--shapes needs a linear method, one of " + join(linear, ", ") + ", not '" + name + "'.");
  }
  filter->SetMethod(static_cast<int>(found - linear.begin()));
  const Option tolerance = { "Tolerance", {}, 1e-15, 0.999, {} };
  for (const auto& [option, value] : options)
  {
    if (plain(option) != plain(tolerance.name))
    {
      throw UsageError(
        "With --shapes the one option of a method is Tolerance, not '" + option + "'.");
    }
    filter->SetTolerance(valueOf(tolerance, value));
  }
}

void setValidity(vtkMorphAlgorithm* method, const std::string& name)
{
  const Option validity = { "--validity",
    { "None", "Report", "SubStep", "Repair", "Refuse", "RepairAll" }, 0, 5,
    setter<vtkMorphAlgorithm>(
      [](vtkMorphAlgorithm* f, double v) { f->SetValidity(static_cast<int>(v)); }) };
  validity.set(method, valueOf(validity, name));
}

std::string methodNames()
{
  return names(methods());
}

std::string optionNames()
{
  std::string result;
  for (const Method& method : methods())
  {
    for (const Option& option : method.options)
    {
      result += method.name + " " + option.name + "=" +
                (option.words.empty() ? "<number>" : join(option.words, "|")) + "\n";
    }
  }
  return result;
}
}
