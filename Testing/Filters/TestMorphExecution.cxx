// SPDX-License-Identifier: BSD-3-Clause
// Threads, progress, abort, and what becomes of exceptions.
#include "MorphFilters.h"
#include "TestGrids.h"

#include "Private/Pipeline/CrewMonitor.h"
#include "Private/Pipeline/Execution.h"
#include "Support/Error.h"
#include "vtkExtractMorphBoundary.h"
#include "vtkFEMWarpMorph.h"
#include "vtkScaledJacobian.h"

#include <vtkCallbackCommand.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkSMPTools.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <new>
#include <stdexcept>
#include <string>

namespace
{
/// Calls a function on each ProgressEvent.
class OnProgress
{
public:
  OnProgress(vtkAlgorithm* filter, std::function<void(double)> call)
    : Call(std::move(call))
  {
    this->Command->SetClientData(this);
    this->Command->SetCallback([](vtkObject*, unsigned long, void* self, void* value)
      { static_cast<OnProgress*>(self)->Call(*static_cast<double*>(value)); });
    filter->AddObserver(vtkCommand::ProgressEvent, this->Command);
  }
  ~OnProgress() { this->Command->SetCallback(nullptr); }

private:
  std::function<void(double)> Call;
  vtkNew<vtkCallbackCommand> Command;
};
}

TEST(MorphExecution, ResultsDoNotDependOnTheThreads)
{
  morph::Mesh mesh = meshes::hexesAndPyramids(16, 16, 16);
  meshes::jitterInterior(mesh, 0.1, meshes::seed());
  auto grid = grids::make(mesh);
  auto boundary = grids::boundary(grid, grids::twist);
  morph::Points one;
  double minimum = 0, mean = 0;
  for (const int threads : { 1, 2, 4, 0 })
  {
    SCOPED_TRACE(threads);
    auto filter = grids::morphed<vtkFEMWarpMorph>(grid, boundary);
    filter->SetNumberOfThreads(threads);
    filter->Update();
    if (threads == 1)
    {
      one = grids::points(filter->GetOutput());
      minimum = filter->GetMinScaledJacobian();
      mean = filter->GetMeanScaledJacobian();
      ASSERT_EQ(one.rows(), mesh.numberOfNodes());
    }
    EXPECT_TRUE(grids::points(filter->GetOutput()) == one);
    EXPECT_EQ(filter->GetMinScaledJacobian(), minimum);
    EXPECT_EQ(filter->GetMeanScaledJacobian(), mean);
  }
}

TEST(MorphExecution, TheDefaultBackendIsLeftAlone)
{
  const std::string before = vtkSMPTools::GetBackend();
  ASSERT_TRUE(vtkSMPTools::SetBackend("Sequential"));
  auto grid = grids::hexes(20);
  auto filter = grids::morphed<vtkFEMWarpMorph>(grid, grids::twist);
  filter->Update();
  EXPECT_STREQ(vtkSMPTools::GetBackend(), "Sequential");
  vtkSMPTools::SetBackend(before.c_str());
}

TEST(MorphExecution, ProgressGoesUp)
{
  auto grid = grids::hexes(16);
  auto filter = grids::morphed<vtkFEMWarpMorph>(grid, grids::twist);
  std::vector<double> values;
  OnProgress observer(filter, [&values](double value) { values.push_back(value); });
  filter->Update();
  ASSERT_GT(values.size(), 5u);
  EXPECT_TRUE(std::is_sorted(values.begin(), values.end()));
  EXPECT_EQ(values.front(), 0);
  EXPECT_EQ(values.back(), 1);
}

TEST(MorphExecution, AbortGivesTheMeshAtRestAndNoError)
{
  auto grid = grids::hexes(16);
  auto filter = grids::morphed<vtkFEMWarpMorph>(grid, grids::twist);
  bool stop = true;
  double last = 0;
  OnProgress observer(filter,
    [&](double value)
    {
      // The executive itself reports 1 at the end.
      last = value < 1 ? value : last;
      if (stop && value > 0.1)
      {
        filter->SetAbortExecute(1);
      }
    });
  const grids::Run listener(filter);
  EXPECT_TRUE(listener.Errors.empty());
  ASSERT_EQ(filter->GetOutput()->GetNumberOfPoints(), 17 * 17 * 17);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfCells(), 16 * 16 * 16);
  for (vtkIdType i = 0; i < 17 * 17 * 17; ++i)
  {
    EXPECT_EQ(grids::Row(filter->GetOutput()->GetPoint(i)), grids::Row(grid->GetPoint(i)));
  }
  EXPECT_STREQ(filter->GetMorphStatus(), "Cancelled");
  EXPECT_EQ(grid->GetFieldData()->GetNumberOfArrays(), 0);
  EXPECT_EQ(filter->GetWorstCellId(), -1);
  EXPECT_EQ(filter->GetInvertedCells(), -1);
  EXPECT_LT(last, 0.9);

  stop = false;
  filter->SetAbortExecute(0);
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 17 * 17 * 17);
  EXPECT_STREQ(filter->GetMorphStatus(), "Inverted");
  EXPECT_TRUE(listener.Errors.empty());
}

TEST(MorphExecution, AbortIsSilentInTheOtherFiltersToo)
{
  auto grid = grids::hexes(4);
  vtkNew<vtkExtractMorphBoundary> extract;
  vtkNew<vtkScaledJacobian> quality;
  for (vtkAlgorithm* filter :
    { static_cast<vtkAlgorithm*>(extract), static_cast<vtkAlgorithm*>(quality) })
  {
    SCOPED_TRACE(filter->GetClassName());
    filter->SetInputDataObject(grid);
    bool stop = true;
    OnProgress observer(filter,
      [&](double)
      {
        if (stop)
        {
          filter->SetAbortExecute(1);
        }
      });
    grids::Listener listener(filter);
    auto* output = vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0));
    filter->Update();
    EXPECT_TRUE(listener.Errors.empty()) << listener.Errors[0];
    EXPECT_EQ(output->GetNumberOfPoints(), 0);
    EXPECT_EQ(output->GetNumberOfCells(), 0);

    stop = false;
    filter->SetAbortExecute(0);
    filter->Modified();
    filter->Update();
    EXPECT_GT(output->GetNumberOfCells(), 0);
    EXPECT_TRUE(listener.Errors.empty());
  }
  EXPECT_EQ(quality->GetMeasuredCells(), 64);
}

TEST(MorphExecution, WhateverIsThrownBecomesOneError)
{
  vtkNew<vtkFEMWarpMorph> filter;
  grids::Listener listener(filter);
  int cleared = 0;
  const auto run = [&](const std::function<void()>& work)
  { return morph::filters::Execution::Run(filter, "test this", work, [&cleared] { ++cleared; }); };

  using Outcome = morph::filters::Execution::Outcome;
  EXPECT_EQ(run([] {}), Outcome::Done);
  EXPECT_EQ(cleared, 0);
  EXPECT_TRUE(listener.Errors.empty());

  EXPECT_EQ(run([] { throw std::bad_alloc(); }), Outcome::Failed);
  EXPECT_EQ(run([] { throw std::runtime_error("of a library"); }), Outcome::Failed);
  EXPECT_EQ(run([] { throw morph::Error("Of ours."); }), Outcome::Failed);
  EXPECT_EQ(cleared, 3);
  ASSERT_EQ(listener.Errors.size(), 3u);
  const char* expected[] = { "There is not enough memory to test this.",
    "Unexpected failure: of a library", "Of ours." };
  for (int i = 0; i < 3; ++i)
  {
    EXPECT_NE(listener.Errors[i].find(expected[i]), std::string::npos) << listener.Errors[i];
  }

  EXPECT_EQ(run([] { throw morph::Error(morph::Error::Kind::Cancelled, "Cancelled."); }),
    Outcome::Cancelled);
  EXPECT_EQ(cleared, 4);
  EXPECT_EQ(listener.Errors.size(), 3u);
}

template <typename Monitor>
class MorphMonitors : public testing::Test
{
};
using BothMonitors = testing::Types<morph::filters::Monitor, morph::filters::CrewMonitor>;
TYPED_TEST_SUITE(MorphMonitors, BothMonitors);

TYPED_TEST(MorphMonitors, RangesCoverEverythingOnceAndKeepTheGrain)
{
  for (const int threads : { 1, 2, 0 })
  {
    TypeParam monitor(nullptr, threads);
    for (const morph::Index n : { 0, 1, 99, 100, 101, 1000, 12345 })
    {
      std::vector<std::atomic<int>> hits(n);
      std::atomic<int> tooShort(0);
      monitor.parallelFor(n, 100,
        [&](morph::Index first, morph::Index last)
        {
          tooShort += last - first < 100 && last != n;
          for (morph::Index i = first; i < last; ++i)
          {
            ++hits[i];
          }
        });
      EXPECT_EQ(tooShort, 0);
      for (const auto& count : hits)
      {
        ASSERT_EQ(count, 1) << n << " with " << threads << " threads";
      }
    }
  }
}

TYPED_TEST(MorphMonitors, TheBackendThatTheUserChoseIsUsed)
{
  const std::string before = vtkSMPTools::GetBackend();
  for (const char* backend : { "STDThread", "Sequential" })
  {
    ASSERT_TRUE(vtkSMPTools::SetBackend(backend));
    TypeParam monitor(nullptr, 2);
    std::atomic<bool> isItsOwn(true);
    std::vector<std::atomic<int>> hits(10000);
    monitor.parallelFor(10000, 100,
      [&](morph::Index first, morph::Index last)
      {
        isItsOwn = isItsOwn && vtkSMPTools::IsParallelScope() &&
                   std::string(vtkSMPTools::GetBackend()) == "STDThread";
        for (morph::Index i = first; i < last; ++i)
        {
          ++hits[i];
        }
      });
    // Of a Sequential backend's threads one class has its own, and the other STDThread's.
    EXPECT_TRUE(std::string(backend) == "Sequential" || isItsOwn);
    EXPECT_STREQ(vtkSMPTools::GetBackend(), backend);
    EXPECT_TRUE(std::all_of(hits.begin(), hits.end(), [](const auto& n) { return n == 1; }));
  }
  vtkSMPTools::SetBackend(before.c_str());
}

TEST(MorphExecution, ResultsDoNotDependOnTheBackend)
{
  const std::string before = vtkSMPTools::GetBackend();
  auto grid = grids::hexes(24); // long enough for loops to be cut
  auto boundary = grids::boundary(grid, grids::twist);
  morph::Points expected;
  for (const char* backend : { "Sequential", "STDThread" })
  {
    ASSERT_TRUE(vtkSMPTools::SetBackend(backend));
    auto filter = grids::morphed<vtkFEMWarpMorph>(grid, boundary);
    filter->SetNumberOfThreads(2);
    filter->Update();
    const morph::Points found = grids::points(filter->GetOutput());
    EXPECT_TRUE(expected.rows() == 0 || found == expected) << backend;
    expected = found;
    EXPECT_STREQ(vtkSMPTools::GetBackend(), backend);
  }
  vtkSMPTools::SetBackend(before.c_str());
}

TEST(MorphCrewMonitor, ThousandsOfShortLoops)
{
  morph::filters::CrewMonitor monitor(nullptr, 2);
  std::vector<double> sum(1000, 0);
  for (int loop = 0; loop < 20000; ++loop)
  {
    monitor.parallelFor(1000, 100,
      [&](morph::Index first, morph::Index last)
      {
        for (morph::Index i = first; i < last; ++i)
        {
          sum[i] += 1; // each loop sees what the one before has written
        }
      });
  }
  EXPECT_EQ(sum, std::vector<double>(1000, 20000));
}

TYPED_TEST(MorphMonitors, ExceptionsArriveInTheCallersThread)
{
  for (const int threads : { 1, 2 })
  {
    TypeParam monitor(nullptr, threads);
    EXPECT_THROW(monitor.parallelFor(10000, 10,
                   [](morph::Index first, morph::Index last)
                   {
                     if (first <= 7777 && 7777 < last)
                     {
                       throw std::runtime_error("here");
                     }
                   }),
      std::runtime_error);
    std::atomic<int> after(0);
    monitor.parallelFor(10000, 10,
      [&](morph::Index first, morph::Index last) { after += static_cast<int>(last - first); });
    EXPECT_EQ(after, 10000);
  }
}

TEST(MorphMonitor, ProgressIsMappedAndNeverFalls)
{
  vtkNew<vtkFEMWarpMorph> filter;
  std::vector<double> values;
  OnProgress observer(filter, [&values](double value) { values.push_back(value); });
  morph::filters::Monitor monitor(filter, 1);
  monitor.SetRange(0, 0.5);
  monitor.progress(0.5);
  monitor.progress(0.1);
  monitor.progress(7);
  monitor.SetRange(0.5, 1);
  monitor.progress(0.5);
  EXPECT_EQ(values, (std::vector<double>{ 0.25, 0.5, 0.75 }));
}

TEST(MorphMonitor, WarningsAreKeptOnce)
{
  morph::filters::Monitor monitor(nullptr, 1);
  monitor.warn("a");
  monitor.warn("b");
  monitor.warn("a");
  EXPECT_EQ(monitor.TakeWarnings(), (std::vector<std::string>{ "a", "b" }));
  EXPECT_TRUE(monitor.TakeWarnings().empty());
}
