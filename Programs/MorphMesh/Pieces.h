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

/// One grid of all pieces: equal points are one, and ghost cells are left out.
vtkSmartPointer<vtkUnstructuredGrid> mergedPieces(const std::string& path);

/// Throws Failure where writePieces() would for the extension, or for the files at these paths.
void requireWritablePieces(const std::string& original, const std::string& path);

/// Writes the list and its pieces again, with the points of `moved`, which has the points of
/// mergedPieces(original) in their order. Arrays and cells of the pieces stay. Returns the largest
/// rounding of a coordinate, where a piece is in single precision.
double writePieces(
  vtkUnstructuredGrid* moved, const std::string& original, const std::string& path);
}
