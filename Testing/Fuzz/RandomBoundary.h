// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "RandomGrid.h"

#include <vtkPointSet.h>

#include <string>
#include <utility>
#include <vector>

namespace fuzz
{
/// What a filter gets on port 1.
struct RandomBoundary
{
  vtkSmartPointer<vtkDataObject> data; ///< null, or of any type
  std::string idArray;                 ///< for BoundaryIdArray
  std::string displacementArray;       ///< for DisplacementArray

  /// The nodes that it names, and where they go with a ScaleFactor of 1: known where isRight holds.
  std::vector<std::pair<morph::Index, Eigen::RowVector3d>> targets;
  bool isRight = true;    ///< ids, arrays and positions are as they should be
  bool isExact = true;    ///< targets are the very points of `data`
  bool isNothing = false; ///< nobody meant to move anything
  bool isAffine = false;  ///< all outer nodes go where this map takes them
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  Eigen::RowVector3d shift = Eigen::RowVector3d::Zero();
};

RandomBoundary randomBoundary(Choices& choices, const RandomGrid& grid);
}
