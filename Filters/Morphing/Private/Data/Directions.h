// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Support/Monitor.h"

class vtkDataSet;
class vtkUnstructuredGrid;

/// Arrays that give directions in the undeformed mesh, and would be wrong in a mesh that turned.
namespace morph::filters::Directions
{
/// Removes VTK's attribute Normals of points and cells, as vtkWarpVector does.
void RemoveNormals(vtkDataSet* moved);

/// Warns of all other arrays of `input` that look like directions, if a volume cell turns by more
/// than a degree. These have vectors, or tensors with rows, of unit length, beside zeros and NaN.
/// `moved`: #nodes x 3. Cost: an array that gives none is seldom read further than its first tuple;
/// with one, a pass over the cells up to the first that turns, in threads.
void Warn(vtkUnstructuredGrid* input, const morph::Points& rest, const morph::Points& moved,
  morph::Monitor& monitor);
}
