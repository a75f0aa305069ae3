// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMorphing/Target.h"
#include "BoundaryMover/BoundaryModel.h"
#include "BoundaryMover/Choice.h"

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <memory>
#include <string>
#include <vector>

class vtkPolyData;

/// Target surfaces as VTK's data.
namespace morph::filters::TargetData
{
/// Those of a filter that has a target. `size`: of its mesh.
template <typename FilterOptions>
morph::Target::Options OptionsOf(const FilterOptions& from, double size)
{
  return { from.FeatureAngle, from.TargetAngle, from.TargetReach * size, 0 };
}

/// The polygons and strips of `surface` as a target of `mesh`. `options`: without the rounding,
/// which is found here. `warning`: becomes what to warn of where the rounding shows, else empty.
/// `size`: of the mesh. Throws as morph::Target does.
std::unique_ptr<morph::Target> Make(vtkPolyData* surface, const morph::Points& mesh, double size,
  morph::Target::Options options, std::string& warning, morph::Monitor& monitor);

/// The triangles that count.
vtkSmartPointer<vtkPolyData> Surface(const morph::Target& target);
}

namespace morph::filters
{
/// The target surface of a boundary, kept while it, the mesh and the options are the same.
class FittedTarget
{
public:
  /// Takes the target. `choice`: what moves, onto which it is aligned; null for the whole boundary.
  /// `align`: rigidly onto the mesh first. Throws as morph::Target does.
  void Update(vtkPolyData* target, const morph::BoundaryModel& model, const morph::Choice* choice,
    bool align, const morph::Target::Options& options, morph::Monitor& monitor);

  const std::string& GetWarning() const { return this->Warning; } ///< of the target, or empty
  morph::Target* Get() const { return this->Place.get(); }        ///< null before Update()
  /// The triangles that nodes go to: the target as aligned; null before Update().
  vtkPolyData* Surface() const { return this->Triangles; }

private:
  const vtkPolyData* Input = nullptr; ///< compared, never used
  vtkMTimeType InputTime = 0;
  vtkIdType MotionVersion = -1;
  bool IsAligned = false;
  std::vector<morph::Index> AlignedOnto;
  std::unique_ptr<morph::Target> Place;
  std::string Warning; ///< of Place
  vtkSmartPointer<vtkPolyData> Triangles;
};
}
