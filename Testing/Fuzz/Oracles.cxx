// SPDX-License-Identifier: BSD-3-Clause
#include "Oracles.h"

#include "MotionOracles.h"
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
  return !data || data->GetNumberOfElements(vtkDataObject::POINT) == 0; // blocks, too
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
  const auto inside = static_cast<morph::Index>(made.grid.nodes.size());
  const auto* morph = vtkMorphAlgorithm::SafeDownCast(filter);
  return inside > (morph ? const_cast<vtkMorphAlgorithm*>(morph)->GetPrescribedPoints()
                         : static_cast<morph::Index>(made.grid.outer.size()));
}

/// Outputs and errors of two executions are the same.
Finding compare(const Case& made, const Run& first, const Run& second, const char* oracle)
{
  // The ranking of the comparison depends on times.
  const std::size_t ports = made.filter.name == "CompareMorphMethods" ? 2 : first.outputs.size();
  for (std::size_t port = 0; port < ports; ++port)
  {
    const std::string found = difference(first.outputs[port], second.outputs[port], Timings);
    if (!found.empty())
    {
      return { oracle, "output " + std::to_string(port) + ": " + found };
    }
  }
  const auto text = [](const Run& run) { return run.errors.empty() ? "none" : run.errors.front(); };
  return first.errors == second.errors
           ? Finding{}
           : Finding{ oracle, "errors: " + text(first) + " | " + text(second) };
}

/// An execution that is told to stop gives the undeformed mesh, or nothing, and no error.
Finding checkAborted(const Case& made, vtkAlgorithm* filter, const Run& run)
{
  auto* morph = vtkMorphAlgorithm::SafeDownCast(filter);
  if (!morph || std::string(morph->GetMorphStatus()) != "Cancelled")
  {
    return {};
  }
  auto* output = vtkPointSet::SafeDownCast(run.outputs.front());
  const bool isAtRest = !made.grid.isAsMesh || output->GetNumberOfPoints() == 0 ||
                        pointsOf(output) == made.grid.mesh.points ||
                        morph->GetOutputPointsPrecision() == 0;
  return run.errors.empty() && isAtRest
           ? Finding{}
           : Finding{ "abort", isAtRest ? run.errors.front() : "nodes have moved" };
}

/// The same call again, by the same filter or another one, gives the same bits; after an abort too.
Finding checkAgain(Case& made, vtkSmartPointer<vtkAlgorithm> filter, const Run& first)
{
  const int again =
    made.choices.pick("again", { "same filter", "new filter", "three threads" }, { 2, 2, 0.3 });
  if (again == 0)
  {
    filter->Modified();
  }
  else
  {
    filter = made.makeFilter(again == 2 ? 3 : 0);
  }
  const double abortAt = made.choices.number(
    "abortAt", 2, [](Random& random) { return random.happens(0.06) ? random.unit() : 2; });
  if (abortAt <= 1)
  {
    const Run aborted = execute(filter, made.time, abortAt);
    if (const Finding found = checkAborted(made, filter, aborted))
    {
      return found;
    }
    filter->SetAbortExecute(0);
    filter->Modified();
  }
  return compare(
    made, first, execute(filter, made.time), abortAt <= 1 ? "after an abort" : "repeat");
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
  // A rank may have no part of a grid that is measured.
  const bool mayBeEmpty = made.filter.name == "ScaledJacobian" && isEmpty(made.inputs.front());
  if (saidNothing && isEmpty(run.outputs.front()) && !mayBeEmpty)
  {
    return { "silence", "an empty output without a message" };
  }
  if (!made.acceptedProperty.empty())
  {
    return { "property", made.acceptedProperty + " took a number that is not finite" };
  }
  const bool isRefused = !run.errors.empty() && !run.fromExecutive.empty();
  return isRefused ? Finding{ "message of the executive", run.fromExecutive.front() } : Finding{};
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
  const Run run = execute(algorithm, made.time);
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
      [&] { return checkOutput(made, algorithm, run); },
      [&] { return checkNothing(made, algorithm, run); },
      [&] { return checkAttached(made, algorithm, run); },
      [&] { return checkBetween(made, algorithm, run); },
      [&] { return checkAgain(made, algorithm, run); },
      [&] { return checkFrame(made, algorithm, run); }, [&] { return checkParts(made, algorithm); },
      [&] { return checkRanges(made, algorithm, run); }, inputsChanged })
  {
    verdict.finding = check();
    if (verdict.finding)
    {
      break;
    }
  }
  for (const auto& [name, isMade] : choices.asked())
  {
    if (name.rfind("property.", 0) == 0 || name.rfind("with.", 0) == 0)
    {
      verdict.features += (verdict.features.empty() ? "" : " ") + name + (isMade ? "+" : "-");
    }
  }
  return verdict;
}
}
