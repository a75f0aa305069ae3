// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkSmartPointer.h>

#include <string>
#include <vector>

class vtkDataObject;
class vtkUnstructuredGrid;

/// Files of VTK that list other files, with the pieces (.pvtu) or the blocks (.vtm) of a mesh. Each
/// function throws Failure.
namespace morph_mesh
{
bool isListOfPieces(const std::string& path);

/// The files that the list names, in its order.
std::vector<std::string> piecesOf(const std::string& path);

/// The pieces that one of several MPI ranks has, some in a row.
struct Part
{
  int rank = 0, ranks = 1;

  bool has(std::size_t piece, std::size_t pieces) const
  {
    return piece * static_cast<std::size_t>(this->ranks) / pieces ==
           static_cast<std::size_t>(this->rank);
  }
};

/// One grid of all pieces of a part: equal points are one, and ghost cells are left out.
vtkSmartPointer<vtkUnstructuredGrid> mergedPieces(const std::string& path, const Part& part = {});

/// Throws Failure where writePieces() would for the extension, or for the files at these paths.
void requireWritablePieces(const std::string& original, const std::string& path);

/// Writes the list and its pieces again, with the points of `moved`, which has the points of
/// mergedPieces(original, part) in their order. Arrays and cells of the pieces stay. Returns the
/// largest rounding of a coordinate, where a piece is in single precision. One of several ranks
/// writes its pieces alone.
double writePieces(vtkUnstructuredGrid* moved, const std::string& original, const std::string& path,
  const Part& part = {});

/// Writes the list alone, with the names of the new pieces.
void writeListOfPieces(const std::string& original, const std::string& path);
}
