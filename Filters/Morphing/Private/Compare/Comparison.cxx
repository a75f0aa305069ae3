// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Compare/Comparison.h"

#include "vtkMorphAlgorithm.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <tuple>

namespace morph::filters
{
namespace
{
constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

/// The value below which `percent` of the cells lie; NaN where none was measured.
double percentileOf(vtkDataArray* values, double percent)
{
  std::vector<double> known;
  for (vtkIdType i = 0; values && i < values->GetNumberOfTuples(); ++i)
  {
    const double value = values->GetComponent(i, 0);
    if (!std::isnan(value))
    {
      known.push_back(value);
    }
  }
  if (known.empty())
  {
    return NaN;
  }
  const auto place = known.begin() + static_cast<std::ptrdiff_t>(
                                       percent / 100 * static_cast<double>(known.size() - 1));
  std::nth_element(known.begin(), place, known.end());
  return *place;
}

/// A column of a table, to be filled.
template <typename Array, typename Value>
class Column
{
public:
  Column(vtkTable* table, const char* name)
  {
    this->Values->SetName(name);
    table->AddColumn(this->Values);
  }
  void Add(const Value& value) { this->Values->InsertNextValue(value); }

private:
  vtkNew<Array> Values;
};
using Texts = Column<vtkStringArray, std::string>;
using Numbers = Column<vtkDoubleArray, double>;
using Integers = Column<vtkIntArray, int>;
using Ids = Column<vtkIdTypeArray, vtkIdType>;

double lastValidTime(const MethodRun& run)
{
  const int valid = run.ValidSteps();
  return valid > 0 ? run.Steps[valid - 1].Time : NaN;
}

/// The first of the `steps` that is not valid; -1 where all are valid.
int firstInvertedStep(const MethodRun& run, int steps)
{
  return run.ValidSteps() < steps ? run.ValidSteps() : -1;
}
}

std::string MethodRun::Title() const
{
  return this->Method + ", " + this->Stepping;
}

int MethodRun::ValidSteps() const
{
  const auto invalid = std::find_if(this->Steps.begin(), this->Steps.end(),
    [this](const Step& step) { return step.Inverted + step.Degenerate > this->BadAtRest; });
  return static_cast<int>(invalid - this->Steps.begin());
}

double MethodRun::LastValidMinimum() const
{
  const int valid = this->ValidSteps();
  return valid > 0 ? this->Steps[valid - 1].Minimum : NaN;
}

double MethodRun::Seconds() const
{
  double sum = 0;
  for (const Step& step : this->Steps)
  {
    sum += step.PrepareSeconds + step.EvaluateSeconds;
  }
  return sum;
}

namespace Comparison
{
MethodRun::Step Measure(vtkMorphAlgorithm* filter, double time, double percentile)
{
  MethodRun::Step step;
  step.Time = time;
  step.Minimum = filter->GetMinScaledJacobian();
  step.Mean = filter->GetMeanScaledJacobian();
  step.Low =
    percentileOf(filter->GetOutput()->GetCellData()->GetArray("ScaledJacobian"), percentile);
  step.Inverted = filter->GetInvertedCells();
  step.Degenerate = filter->GetDegenerateCells();
  step.BoundaryInverted = filter->GetBoundaryInvertedCells();
  step.PrepareSeconds = filter->GetPrepareSeconds();
  step.EvaluateSeconds = filter->GetEvaluateSeconds();
  return step;
}

void Rank(std::vector<MethodRun>& runs)
{
  std::vector<std::size_t> order(runs.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    order[i] = i;
  }
  const auto key = [&](std::size_t i)
  {
    const double minimum = runs[i].LastValidMinimum();
    const double quality = std::isnan(minimum) ? -2 : std::round(100 * minimum);
    return std::make_tuple(-runs[i].ValidSteps(), -quality, runs[i].Seconds(), i);
  };
  std::sort(
    order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  for (std::size_t place = 0; place < order.size(); ++place)
  {
    runs[order[place]].Rank = static_cast<int>(place) + 1;
  }
}

void WriteSteps(const std::vector<MethodRun>& runs, vtkTable* output)
{
  Texts method(output, "Method"), stepping(output, "Stepping");
  Integers number(output, "Step");
  Numbers time(output, "Time"), minimum(output, "MinScaledJacobian"),
    mean(output, "MeanScaledJacobian"), low(output, "LowScaledJacobian");
  Ids inverted(output, "InvertedCells"), degenerate(output, "DegenerateCells"),
    boundary(output, "BoundaryInvertedCells");
  Numbers prepare(output, "PrepareSeconds"), evaluate(output, "EvaluateSeconds"),
    memory(output, "PeakMegabytes");
  for (const MethodRun& run : runs)
  {
    for (std::size_t i = 0; i < run.Steps.size(); ++i)
    {
      const MethodRun::Step& step = run.Steps[i];
      method.Add(run.Method);
      stepping.Add(run.Stepping);
      number.Add(static_cast<int>(i));
      time.Add(step.Time);
      minimum.Add(step.Minimum);
      mean.Add(step.Mean);
      low.Add(step.Low);
      inverted.Add(step.Inverted);
      degenerate.Add(step.Degenerate);
      boundary.Add(step.BoundaryInverted);
      prepare.Add(step.PrepareSeconds);
      evaluate.Add(step.EvaluateSeconds);
      memory.Add(run.PeakMegabytes);
    }
  }
}

void WriteChart(
  const std::vector<MethodRun>& runs, const std::vector<double>& times, vtkTable* output)
{
  // All columns before the first row: a table refuses a column that is shorter than the others.
  Numbers time(output, "Time");
  std::deque<Numbers> minimum;
  for (const MethodRun& run : runs)
  {
    minimum.emplace_back(output, run.Title().c_str());
  }
  for (std::size_t i = 0; i < times.size(); ++i)
  {
    time.Add(times[i]);
    for (std::size_t r = 0; r < runs.size(); ++r)
    {
      minimum[r].Add(i < runs[r].Steps.size() ? runs[r].Steps[i].Minimum : NaN);
    }
  }
}

void WriteRanking(const std::vector<MethodRun>& runs, int steps, vtkTable* output)
{
  Integers rank(output, "Rank");
  Texts method(output, "Method"), stepping(output, "Stepping");
  Integers first(output, "FirstInvertedStep");
  Numbers last(output, "LastValidTime"), minimum(output, "LastValidMinScaledJacobian"),
    seconds(output, "Seconds"), memory(output, "PeakMegabytes");
  std::vector<MethodRun> ordered = runs;
  std::sort(ordered.begin(), ordered.end(),
    [](const MethodRun& a, const MethodRun& b) { return a.Rank < b.Rank; });
  for (const MethodRun& run : ordered)
  {
    rank.Add(run.Rank);
    method.Add(run.Method);
    stepping.Add(run.Stepping);
    first.Add(firstInvertedStep(run, steps));
    last.Add(lastValidTime(run));
    minimum.Add(run.LastValidMinimum());
    seconds.Add(run.Seconds());
    memory.Add(run.PeakMegabytes);
  }
}
}
}
