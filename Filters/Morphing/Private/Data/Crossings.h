// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Session/UndeformedMesh.h"

#include <string>
#include <vector>

class vtkPointSet;
class vtkUnstructuredGrid;

namespace morph
{
class Monitor;
}

/// Faces of a boundary that a motion has run into each other.
namespace morph::filters::Crossings
{
struct Found
{
  morph::Index Count = 0;        ///< of faces that cross others
  std::vector<morph::Index> Own; ///< those of this process, ascending
  std::string Warning;           ///< names their surfaces; empty without any
};

/// Finds them on the points of `output` as written. `rest`: the undeformed mesh. `grid`: the cells
/// of `output`, the leading ones of that. `boundary`: the displaced one, or null. Surfaces have the
/// names that the file gives, or else the ids that `boundary` has from vtkClassifyBoundary. Of a
/// shell that is curved now its own faces count, and none is Own. Collective. Cost: that of
/// WholeBoundary::crossings() and, if there are any, a pass over the faces for each name of the
/// file.
Found Find(const morph::UndeformedMesh& rest, const morph::Mesh& grid, vtkUnstructuredGrid* output,
  vtkPointSet* boundary, morph::Monitor& monitor);
}
