// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Oracles.h"

class vtkPointSet;

namespace fuzz
{
/// Of the filters whose output is a boundary, or says what is one. `output`: port 0, not empty,
/// without an error.

/// vtkExtractMorphBoundary: the boundary's nodes are the outer ones, in ascending order.
Finding checkExtracted(const Case& made, vtkPointSet* output);
/// vtkClassifyBoundary: outer nodes have a dimension of 0 to 2, and those inside 3.
Finding checkClassified(const Case& made, vtkPointSet* output);
/// vtkMorphBoundary: given nodes and vertices are where they are to be; affine motions come out.
Finding checkMovedBoundary(const Case& made, vtkAlgorithm* filter, const Run& run);
/// vtkBoundaryDisplacement: what stays or is held does not move.
Finding checkDisplaced(const Case& made, vtkPointSet* output);
}
