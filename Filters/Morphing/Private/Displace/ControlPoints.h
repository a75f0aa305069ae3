// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "BoundaryMorphing/HandleMotion.h"
#include "BoundaryMorphing/LatticeMotion.h"
#include "Support/Types.h"

#include <vtkSmartPointer.h>

#include <array>
#include <string>
#include <vector>

class vtkDataObject;
class vtkPolyData;

/// The control points of a displacement: handles, or those of a lattice. `given`, a vtkPointSet or
/// a vtkTable, may be null; see vtkDisplacementAlgorithm::SetControlPointsData().
namespace morph::filters::ControlPoints
{
inline constexpr const char* Whose = "The control points'"; ///< arrays are, in messages

/// Whether nothing is given. A reader leaves such data on an MPI process that has no part of them.
bool AreNone(vtkDataObject* given);

/// The handles of both. `listed`: place, displacement, radius. Throws morph::Error for data of
/// another type, and for arrays or columns that are missing, not numeric or too short.
std::vector<Handle> Handles(vtkDataObject* given, const std::vector<std::array<double, 7>>& listed,
  const std::string& whose = Whose);

/// The displacements of all control points of a lattice, as LatticeMotion has them. `listed`: i, j,
/// k, displacement. Throws as above and for ids that are no whole number or not in the lattice,
/// another number of points than the lattice has, and displacements that are not finite.
morph::Points Lattice(vtkDataObject* given, const std::vector<std::array<double, 6>>& listed,
  const std::array<int, 3>& size);

/// Makes `output` the points of handles, or of a lattice where it takes them, with the lines
/// between them: points that Handles() and Lattice() read.
void Write(const std::vector<Handle>& handles, vtkPolyData* output);
void Write(const LatticeMotion& lattice, vtkPolyData* output);

/// What Handles() or Lattice() read of `given`, as points that they read again: to be gathered from
/// MPI processes. Empty for null. `whose`: as Whose.
vtkSmartPointer<vtkPolyData> AsHandles(vtkDataObject* given, const std::string& whose = Whose);
vtkSmartPointer<vtkPolyData> AsLattice(vtkDataObject* given, const std::array<int, 3>& size);
}
