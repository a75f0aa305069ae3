// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkDisplacementAlgorithm.h"

#include <vtkAbstractTransform.h>
#include <vtkExtractSelection.h>
#include <vtkImplicitFunction.h>
#include <vtkSmartPointer.h>

#include <array>
#include <string>
#include <vector>

/// The properties of vtkDisplacementAlgorithm that are objects or lists.
struct vtkDisplacementAlgorithm::vtkShared
{
  vtkSmartPointer<vtkImplicitFunction> Region, ZoneRegion;
  vtkSmartPointer<vtkAbstractTransform> Transform, RigidTransform;
  vtkSmartPointer<vtkExtractSelection> Extractor;
  std::vector<std::array<double, 7>> Handles;
  std::vector<std::array<double, 6>> LatticeDisplacements;
  std::string SlideReport = "None"; ///< of the last execution
};
