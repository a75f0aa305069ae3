// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkAlgorithm.h>
#include <vtkCellArray.h>
#include <vtkGenericCell.h>
#include <vtkIdList.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVersionMacros.h>

#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 6, 0)
#include <vtkCellTypeUtilities.h>
#else
#include <vtkCellTypes.h>
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

/// Finds the cells that a line from `a` to `b` meets, and perhaps others near it.
template <typename Locator>
void FindCellsAlongLine(Locator& locator, const double* a, const double* b, double tolerance,
  vtkIdList* cells, [[maybe_unused]] vtkGenericCell* work)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 0)
  locator.IntersectWithLine(a, b, tolerance, nullptr, cells, work);
#else
  locator.FindCellsAlongLine(a, b, tolerance, cells);
#endif
}

/// Whether a grid stores the faces of its polyhedra in two cell arrays, as since VTK 9.4, or in one
/// stream. Asked of the class: releases in between have either.
template <typename Grid, typename = void>
struct HasFaceArrays : std::false_type
{
};
template <typename Grid>
struct HasFaceArrays<Grid, std::void_t<decltype(std::declval<Grid&>().GetPolyhedronFaces())>>
  : std::true_type
{
};

/// Appends the faces of a polyhedron to `faces`: for each its number of points, then their ids.
/// Returns whether the grid's arrays hold them.
template <typename Grid>
bool AppendFaces(Grid* grid, vtkIdType cell, std::vector<std::int64_t>& faces)
{
  if constexpr (HasFaceArrays<Grid>::value)
  {
    auto* places = grid->GetPolyhedronFaceLocations();
    auto* all = grid->GetPolyhedronFaces();
    if (!places || !all || cell >= places->GetNumberOfCells())
    {
      return false;
    }
    vtkNew<vtkIdList> own, points;
    places->GetCellAtId(cell, own);
    for (vtkIdType i = 0; i < own->GetNumberOfIds(); ++i)
    {
      if (own->GetId(i) < 0 || own->GetId(i) >= all->GetNumberOfCells())
      {
        return false;
      }
      all->GetCellAtId(own->GetId(i), points);
      faces.push_back(points->GetNumberOfIds());
      faces.insert(
        faces.end(), points->GetPointer(0), points->GetPointer(0) + points->GetNumberOfIds());
    }
    return own->GetNumberOfIds() > 0;
  }
  else
  {
    auto* places = grid->GetFaceLocations();
    auto* stream = grid->GetFaces();
    if (!places || !stream || cell >= places->GetNumberOfValues())
    {
      return false;
    }
    const vtkIdType size = stream->GetNumberOfValues();
    vtkIdType at = places->GetValue(cell);
    if (at < 0 || at >= size)
    {
      return false;
    }
    for (vtkIdType left = stream->GetValue(at++); left > 0; --left)
    {
      if (at >= size || stream->GetValue(at) < 0 || stream->GetValue(at) >= size - at)
      {
        return false;
      }
      const vtkIdType points = stream->GetValue(at) + 1;
      faces.insert(faces.end(), stream->GetPointer(at), stream->GetPointer(at) + points);
      at += points;
    }
    return true;
  }
}

/// Whether the offsets of the arrays of faces can be followed.
template <typename Grid>
bool AreFacesReadable(Grid* grid)
{
  if constexpr (HasFaceArrays<Grid>::value)
  {
    auto* places = grid->GetPolyhedronFaceLocations();
    auto* all = grid->GetPolyhedronFaces();
    return places && all && places->IsValid() && all->IsValid();
  }
  else
  {
    return grid->GetFaceLocations() && grid->GetFaces();
  }
}

/// Sets the cells of a grid. `faceOffsets`, `faces`: of polyhedra, as morph::Mesh has them.
template <typename Grid>
void SetCells(Grid* grid, vtkUnsignedCharArray* types, vtkCellArray* cells,
  const std::vector<std::int64_t>& faceOffsets, const std::vector<std::int64_t>& faces)
{
  if (faceOffsets.empty())
  {
    grid->SetCells(types, cells);
    return;
  }
  const vtkIdType count = cells->GetNumberOfCells();
  if constexpr (HasFaceArrays<Grid>::value)
  {
    vtkNew<vtkCellArray> places, all;
    for (vtkIdType c = 0; c < count; ++c)
    {
      vtkNew<vtkIdList> own;
      for (std::int64_t at = faceOffsets[c]; at < faceOffsets[c + 1]; at += faces[at] + 1)
      {
        vtkNew<vtkIdList> points;
        for (std::int64_t k = 1; k <= faces[at]; ++k)
        {
          points->InsertNextId(static_cast<vtkIdType>(faces[at + k]));
        }
        own->InsertNextId(all->InsertNextCell(points));
      }
      places->InsertNextCell(own);
    }
    grid->SetPolyhedralCells(types, cells, places, all);
  }
  else
  {
    vtkNew<vtkIdTypeArray> places, stream;
    for (vtkIdType c = 0; c < count; ++c)
    {
      const bool isPolyhedron = faceOffsets[c] < faceOffsets[c + 1];
      places->InsertNextValue(isPolyhedron ? stream->GetNumberOfValues() : -1);
      if (!isPolyhedron)
      {
        continue;
      }
      const vtkIdType first = stream->InsertNextValue(0);
      for (std::int64_t at = faceOffsets[c]; at < faceOffsets[c + 1]; at += faces[at] + 1)
      {
        stream->SetValue(first, stream->GetValue(first) + 1);
        for (std::int64_t k = 0; k <= faces[at]; ++k)
        {
          stream->InsertNextValue(static_cast<vtkIdType>(faces[at + k]));
        }
      }
    }
    grid->SetCells(types, cells, places, stream);
  }
}
}
