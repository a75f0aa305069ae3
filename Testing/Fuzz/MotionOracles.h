// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Oracles.h"

namespace fuzz
{
/// Where nothing is asked, nothing moves: a motion of zero moves no node by more than 1e-12 of the
/// mesh's size, and one of Tiny none by more than 1e-7. Excepted are methods that improve a mesh
/// however it moves.
Finding checkNothing(const Case& made, vtkAlgorithm* filter, const Run& run);

/// Some cases again in another unit, from another origin, turned by a quarter or reflected. Linear
/// methods and vtkMorphBoundary give the same to 1e-9; the others to 2 % in counts of inverted
/// cells and in the minimum.
Finding checkFrame(Case& made, vtkAlgorithm* filter, const Run& first);

/// Nodes between two corners that are not prescribed divide the displacements of these as they
/// divided their edge.
Finding checkBetween(const Case& made, vtkAlgorithm* filter, const Run& run);

/// Nodes that hang on one node of the volume by shells or beams are as far from it and from one
/// another as before, and those that hang on none stay.
Finding checkAttached(const Case& made, vtkAlgorithm* filter, const Run& run);

/// The faces between two named parts are listed with their number. The list is the same whatever
/// names are asked for.
Finding checkParts(Case& made, vtkAlgorithm* filter);

/// With weights inside the ranges that vtkMorphShapes gives, no cell is inverted. Changes the
/// weights.
Finding checkRanges(Case& made, vtkAlgorithm* filter, const Run& run);
}
