// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkAlgorithm.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVersionMacros.h>

#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 6, 0)
#include <vtkCellTypeUtilities.h>
#else
#include <vtkCellTypes.h>
#include <vtkUnsignedCharArray.h>
#endif

/// The differences between the VTK releases that this module builds with. No other file of the
/// filters tests VTK_VERSION_NUMBER.
namespace morph::filters::Version
{
/// True once the user asked this algorithm, or one upstream, to stop.
inline bool AbortRequested(vtkAlgorithm* algorithm)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20220817)
  return algorithm->CheckAbort();
#else
  return algorithm->GetAbortExecute() != 0;
#endif
}

/// Keeps the executive from emptying the output of an execution that was aborted.
inline void KeepAbortedOutput([[maybe_unused]] vtkAlgorithm* algorithm)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20220817)
  algorithm->SetAbortOutput(false);
#endif
}

/// One value a cell, or null; since VTK 9.6 in an array of any class, such as a constant one.
inline vtkDataArray* CellTypes(vtkUnstructuredGrid* grid)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 6, 0)
  return grid->GetCellTypes();
#else
  return grid->GetCellTypesArray();
#endif
}

/// The name of VTK's class of cells of this type.
inline const char* CellClass(int type)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 6, 0)
  return vtkCellTypeUtilities::GetClassNameFromTypeId(type);
#else
  return vtkCellTypes::GetClassNameFromTypeId(type);
#endif
}
}
