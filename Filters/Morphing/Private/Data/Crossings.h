// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Mesh/Topology.h"

#include <array>
#include <cstdint>
#include <map>
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

using Pairs = std::vector<std::array<morph::Index, 2>>; ///< of faces; see crossingFaces()

/// Finds them on the points of `output` as written. `rest`: the undeformed mesh, `faces`,
/// `orientation`: of it. `boundary`: the displaced one, or null. Of a shell
/// that is curved now its own faces count, and none is Own. Cost: that of crossingFaces() and, if
/// there are any, of NamesOf().
Found Find(const morph::Mesh& rest, const morph::BoundaryFaces& faces,
  const std::vector<std::int8_t>& orientation, vtkUnstructuredGrid* output, vtkPointSet* boundary,
  morph::Monitor& monitor);

/// Names the surfaces that some faces belong to: by the smallest set of the file, as `grid` has it,
/// or else by the ids that `boundary` has from vtkClassifyBoundary. `mesh`, `faces`: of `grid`.
/// Cost: a pass over the faces for each name of the file.
std::map<morph::Index, std::string> NamesOf(const std::vector<morph::Index>& some,
  const morph::Mesh& mesh, const morph::BoundaryFaces& faces, vtkUnstructuredGrid* grid,
  vtkPointSet* boundary);
/// The faces of all pairs, ascending.
std::vector<morph::Index> FacesOf(const Pairs& pairs);
/// `names`: of these faces, which become Own. `cells`: #faces, what the warning calls the cell
/// behind each.
Found Describe(const Pairs& pairs, const std::map<morph::Index, std::string>& names,
  const morph::BoundaryFaces& faces, const std::vector<morph::Index>& cells,
  const morph::ConstPoints& points);
}
