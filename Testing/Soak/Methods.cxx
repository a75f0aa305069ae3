// SPDX-License-Identifier: BSD-3-Clause
#include "Methods.h"

#include "vtkFEMWarpMorph.h"
#include "vtkInversionFreeMorph.h"
#include "vtkLBWarpMorph.h"
#include "vtkRadialBasisMorph.h"
#include "vtkSimplexLinearMorph.h"
#include "vtkSimplexNaturalNeighborMorph.h"
#include "vtkSmoothingMorph.h"
#include "vtkWeightedResidualMorph.h"

#include <vtkObjectFactory.h>

#include <chrono>
#include <ctime>

namespace soak
{
namespace
{
bool threadTime = false;

/// A filter that finds itself aborted at a given time: it asks by this getter.
template <typename Filter>
class Stoppable : public Filter
{
public:
  static Stoppable* New() { VTK_STANDARD_NEW_BODY(Stoppable); }
  vtkTypeBool GetAbortExecute() override
  {
    return (this->When && this->When->isDue(this->GetProgress())) ||
           this->Filter::GetAbortExecute();
  }

  Abort* When = nullptr;
};

template <typename Filter>
Method method(const char* name)
{
  return { name, [](Abort* abort)
    {
      auto filter = vtkSmartPointer<Stoppable<Filter>>::New();
      filter->When = abort;
      if (auto* weighted = vtkLBWarpMorph::SafeDownCast(filter))
      {
        weighted->SetOutsideHullToRelax(); // for the free nodes of a boundary given in part
      }
      return vtkSmartPointer<vtkMorphAlgorithm>(filter);
    } };
}
}

void Clock::setThreadTime(bool isThreadTime)
{
  threadTime = isThreadTime;
}

double Clock::now()
{
  timespec time;
  if (threadTime && clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time) == 0)
  {
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

const std::vector<Method>& methods()
{
  static const std::vector<Method> all = {
    method<vtkFEMWarpMorph>("FEMWarp"),
    method<vtkInversionFreeMorph>("InversionFree"),
    method<vtkLBWarpMorph>("LBWarp"),
    method<vtkRadialBasisMorph>("RadialBasis"),
    method<vtkSimplexLinearMorph>("SimplexLinear"),
    method<vtkSimplexNaturalNeighborMorph>("SimplexNaturalNeighbor"),
    method<vtkSmoothingMorph>("Smoothing"),
    method<vtkWeightedResidualMorph>("WeightedResidual"),
  };
  return all;
}
}
