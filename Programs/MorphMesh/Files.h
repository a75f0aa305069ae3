// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkSmartPointer.h>

#include <string>

class vtkDataObject;
class vtkPointSet;
class vtkUnstructuredGrid;

/// Reads and writes files in VTK's formats, which the extension determines, and in solvers' own
/// formats. Each function throws Failure.
namespace morph_mesh
{
/// ".vtu", in lower case.
std::string extensionOf(const std::string& path);

/// `timeStep`: of the displacements in a solver's file, from 0 on; -1: the last.
vtkSmartPointer<vtkDataObject> readFile(const std::string& path, int timeStep = -1);

/// The file as an XML writer of VTK writes it, in binary mode.
template <typename Writer>
std::string xmlOf(vtkDataObject* data, const std::string& path);

/// Composite files become one grid, coincident points merged: those of Exodus II, where this was
/// built without netCDF.
vtkSmartPointer<vtkUnstructuredGrid> readGrid(const std::string& path, int timeStep = -1);
vtkSmartPointer<vtkPointSet> readPoints(const std::string& path, int timeStep = -1);

/// The path of the mesh of a region of a case of OpenFOAM.
std::string regionOf(const std::string& folder, const std::string& region);

/// Throws Failure where writeGrid(), writeMorphed() or writeBoundary() would for the extension, or
/// for the file at the path, so that the error comes before the work.
void requireGridFormat(const std::string& path);
void requireMorphedFormat(const std::string& original, const std::string& path);
void requireBoundaryFormat(const std::string& path);

/// Write a file. They replace it as a whole, or leave it as it was.
void writeGrid(vtkUnstructuredGrid* grid, const std::string& path);
void writeBoundary(vtkPointSet* boundary, const std::string& path);

/// Writes a morphed grid: in VTK's format by the extension .vtu or .vtk, or else as a copy of the
/// solver's file, or the list of pieces, `original`, which the grid was read from, with other
/// coordinates.
struct Written
{
  double rounding = 0;    ///< the largest of a coordinate
  long long changed = -1; ///< coordinates of a solver's file; -1: it is none
};
Written writeMorphed(
  vtkUnstructuredGrid* grid, const std::string& original, const std::string& path);
}
