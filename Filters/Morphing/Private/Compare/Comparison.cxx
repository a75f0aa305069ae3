// SPDX-License-Identifier: BSD-3-Clause
#include "Private/Compare/Comparison.h"

#include "Private/Data/Results.h"
#include "Private/Pipeline/Ranks.h"

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
#include <cstdint>
#include <cstring>
#include <deque>
#include <limits>
#include <tuple>

namespace morph::filters
{
namespace
{
constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

/// A number whose order is that of the values.
std::uint64_t keyOf(double value)
{
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  constexpr std::uint64_t Sign = std::uint64_t(1) << 63;
  return (bits & Sign) != 0 ? ~bits : bits | Sign;
}

double valueOf(std::uint64_t key)
{
  constexpr std::uint64_t Sign = std::uint64_t(1) << 63;
  const std::uint64_t bits = (key & Sign) != 0 ? key & ~Sign : ~key;
  double value = 0;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

/// The value below which `percent` of the cells of all processes lie; NaN where none was measured.
/// It is found by counts, bit by bit: no process gets the others' values.
double percentileOf(vtkDataArray* values, double percent, const RankGroup& processes)
{
  std::vector<std::uint64_t> known;
  for (vtkIdType i = 0; values && i < values->GetNumberOfTuples(); ++i)
  {
    const double value = values->GetComponent(i, 0);
    if (!std::isnan(value))
    {
      known.push_back(keyOf(value));
    }
  }
  std::sort(known.begin(), known.end());
  auto number = static_cast<morph::Index>(known.size());
  processes.Sum(&number, 1);
  if (number == 0)
  {
    return NaN;
  }
  const auto place = static_cast<morph::Index>(percent / 100 * static_cast<double>(number - 1));
  std::uint64_t key = 0; // the largest one with no more than `place` values below it
  for (int bit = 63; bit >= 0; --bit)
  {
    const std::uint64_t next = key | std::uint64_t(1) << bit;
    morph::Index below = std::lower_bound(known.begin(), known.end(), next) - known.begin();
    processes.Sum(&below, 1);
    key = below <= place ? next : key;
  }
  return valueOf(key);
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
MethodRun::Step Measure(const Results& results, vtkUnstructuredGrid* mesh, double time,
  double percentile, const RankGroup& processes)
{
  std::vector<double> numbers;
  if (mesh->GetNumberOfCells() > 0) // others may not know
  {
    const auto integer = [&](const char* name) { return double(results.Integer(name)); };
    numbers = { results.Number("MinScaledJacobian"), results.Number("MeanScaledJacobian"),
      integer("InvertedCells"), integer("DegenerateCells"), integer("BoundaryInvertedCells"),
      results.Number("PrepareSeconds"), results.Number("EvaluateSeconds") };
  }
  processes.Share(numbers);
  MethodRun::Step step;
  step.Time = time;
  step.Minimum = numbers.at(0);
  step.Mean = numbers.at(1);
  step.Low = percentileOf(mesh->GetCellData()->GetArray("ScaledJacobian"), percentile, processes);
  step.Inverted = static_cast<vtkIdType>(numbers.at(2));
  step.Degenerate = static_cast<vtkIdType>(numbers.at(3));
  step.BoundaryInverted = static_cast<vtkIdType>(numbers.at(4));
  step.PrepareSeconds = numbers.at(5);
  step.EvaluateSeconds = numbers.at(6);
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
  std::deque<Numbers> criteria; // four columns of each
  const auto any =
    std::find_if(runs.begin(), runs.end(), [](const MethodRun& run) { return !run.Steps.empty(); });
  for (const Quality::OfCriterion& criterion : any->Steps.front().Criteria)
  {
    for (const char* column : { "Limit", "Worst", "WorstCellId", "CellsBeyond" })
    {
      criteria.emplace_back(output, (criterion.Label + column).c_str());
    }
  }
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
      auto column = criteria.begin();
      for (const Quality::OfCriterion& found : step.Criteria)
      {
        for (const double value : { found.Limit, found.Worst, static_cast<double>(found.WorstCell),
               static_cast<double>(found.Beyond) })
        {
          column++->Add(value);
        }
      }
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
