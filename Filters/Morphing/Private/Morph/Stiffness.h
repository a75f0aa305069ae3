// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Morpher/Morpher.h"

#include <string>
#include <vector>

class vtkDataObject;
class vtkUnstructuredGrid;

/// The stiffness of cells from a mesh's arrays and its displaced boundary.
namespace morph::filters::Stiffness
{
/// The properties of vtkFEMWarpMorph of these names.
struct Options
{
  int Stiffness;
  double StiffnessExponent;
  std::string StiffnessArray, WallArray;

  bool AreGiven() const { return this->Stiffness != 0 || !this->StiffnessArray.empty(); }
};
/// Those of a filter that has them.
template <typename FilterOptions>
Options Of(const FilterOptions& from)
{
  return { from.Stiffness, from.StiffnessExponent, from.StiffnessArray, from.WallArray };
}

/// `factors`: #cells, multiply the stiffness; empty: 1. Of a mesh on several MPI processes `rest`
/// is a piece, and walls that come from the boundary are global. Throws morph::Error for arrays
/// that are missing, of another length or of several components.
morph::CellStiffness Take(const Options& options, vtkUnstructuredGrid* rest,
  vtkDataObject* boundary, const std::vector<double>& factors = {});
}
