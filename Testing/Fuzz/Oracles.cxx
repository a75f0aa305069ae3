// SPDX-License-Identifier: BSD-3-Clause
#include "Oracles.h"

#include "RandomMesh.h"
#include "SameData.h"
#include "vtkMorphAlgorithm.h"

#include <vtkDataSet.h>
#include <vtkPointSet.h>
#include <vtkTable.h>

#include <algorithm>
#include <cmath>

namespace fuzz
{
namespace
{
/// Times, and what is ranked by them.
const std::set<std::string> Timings = { "PrepareSeconds", "EvaluateSeconds", "Seconds",
  "PeakMegabytes" };

bool isEmpty(vtkDataObject* data)
{
  if (auto* table = vtkTable::SafeDownCast(data))
  {
    return table->GetNumberOfRows() == 0;
  }
  auto* points = vtkPointSet::SafeDownCast(data);
  return !points || points->GetNumberOfPoints() == 0;
}

Finding checkProgress(const Run& run)
{
  double last = 0;
  for (const double value : run.progress)
  {
    if (!(value >= 0 && value <= 1))
    {
      return { "progress", "is " + std::to_string(value) };
    }
    if (value < last)
    {
      return { "progress",
        "goes from " + std::to_string(last) + " back to " + std::to_string(value) };
    }
    last = value;
  }
  return {};
}

std::string summary(const Case& made)
{
  std::string text = std::to_string(made.grid.mesh.numberOfNodes()) + " nodes, " +
                     std::to_string(made.grid.outer.size()) + " of them outer, " +
                     std::to_string(made.grid.mesh.numberOfCells()) + " cells";
  for (const auto& input : made.inputs)
  {
    auto* data = vtkDataSet::SafeDownCast(input);
    text += std::string(input == made.inputs.front() ? "; inputs: " : ", ") +
            (input ? input->GetClassName() : "none") +
            (data ? " with " + std::to_string(data->GetNumberOfPoints()) + " points" : "");
  }
  return text;
}

bool hasFreeNodes(const Case& made, vtkAlgorithm* filter)
{
  const auto inside = static_cast<morph::Index>(volumeNodes(made.grid.mesh).size());
  const auto* morph = vtkMorphAlgorithm::SafeDownCast(filter);
  return inside > (morph ? const_cast<vtkMorphAlgorithm*>(morph)->GetPrescribedPoints()
                         : static_cast<morph::Index>(made.grid.outer.size()));
}
}

Finding checkMessages(const Case& made, const Run& run)
{
  if (const Finding progress = checkProgress(run))
  {
    return progress;
  }
  if (!run.fromOthers.empty())
  {
    return { "foreign message", run.fromOthers.front() };
  }
  if (run.errors.size() > 1)
  {
    return { "several errors", run.errors[0] + " | " + run.errors[1] };
  }
  for (const std::string& error : run.errors)
  {
    if (error.find("Unexpected failure") != std::string::npos)
    {
      return { "unexpected failure", error };
    }
  }
  const bool saidNothing = run.errors.empty() && run.warnings.empty() && run.fromExecutive.empty();
  if (saidNothing && isEmpty(run.outputs.front()))
  {
    return { "silence", "an empty output without a message" };
  }
  (void)made;
  return {};
}

Verdict judge(
  Choices& choices, const Filter& filter, const std::function<void(const std::string&)>& tellMade)
{
  Verdict verdict;
  verdict.filter = filter.name;
  Case made(choices, filter);
  std::vector<vtkSmartPointer<vtkDataObject>> before;
  for (const auto& input : made.inputs)
  {
    before.push_back(deepCopy(input));
  }
  auto algorithm = made.makeFilter();
  tellMade(summary(made));
  const Run run = execute(algorithm);
  verdict.hasError = !run.errors.empty() || !run.fromExecutive.empty();
  verdict.messages = run.errors;
  verdict.messages.insert(verdict.messages.end(), run.warnings.begin(), run.warnings.end());
  verdict.messages.insert(
    verdict.messages.end(), run.fromExecutive.begin(), run.fromExecutive.end());
  verdict.hasFreeNodes = hasFreeNodes(made, algorithm);

  const auto inputsChanged = [&]() -> Finding
  {
    for (std::size_t port = 0; port < before.size(); ++port)
    {
      const std::string found = difference(before[port], made.inputs[port]);
      if (!found.empty())
      {
        return { "input changed", "port " + std::to_string(port) + ": " + found };
      }
    }
    return {};
  };
  for (const auto& check :
    std::vector<std::function<Finding()>>{ inputsChanged, [&] { return checkMessages(made, run); },
      [&] { return checkOutput(made, algorithm, run); } })
  {
    verdict.finding = check();
    if (verdict.finding)
    {
      return verdict;
    }
  }

  const int again =
    choices.pick("again", { "same filter", "new filter", "three threads" }, { 2, 2, 0.3 });
  if (again == 0)
  {
    algorithm->Modified();
  }
  else
  {
    algorithm = made.makeFilter(again == 2 ? 3 : 0);
  }
  const Run second = execute(algorithm);
  verdict.finding = inputsChanged();
  if (verdict.finding)
  {
    return verdict;
  }
  // The ranking of the comparison depends on times.
  const std::size_t compared = filter.name == "CompareMorphMethods" ? 2 : run.outputs.size();
  for (std::size_t port = 0; port < compared; ++port)
  {
    const std::string found = difference(run.outputs[port], second.outputs[port], Timings);
    if (!found.empty())
    {
      verdict.finding = { "repeat", "output " + std::to_string(port) + ": " + found };
      return verdict;
    }
  }
  if (run.errors != second.errors)
  {
    verdict.finding = { "repeat", "errors: " + (run.errors.empty() ? "none" : run.errors.front()) +
                                    " | " +
                                    (second.errors.empty() ? "none" : second.errors.front()) };
  }
  return verdict;
}
}
