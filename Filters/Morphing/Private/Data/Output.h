// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"
#include "Support/Monitor.h"

#include <vtkType.h>

#include <vector>

class vtkDataObject;
class vtkPointSet;
class vtkUnstructuredGrid;

/// Writes the moved mesh as the output of every morphing filter.
namespace morph::filters::Output
{
/// Makes `output` a shallow copy of `input` with new points, #nodes x 3, and the point vectors
/// `MorphDisplacement`, the points as written minus `rest`. `precision`:
/// vtkAlgorithm::SINGLE_PRECISION and so on, for both arrays. The attribute Normals is left out;
/// warns of other directions as Directions.h says. Throws as RequireWritable() does. Cost: one
/// pass, in threads.
void Write(vtkUnstructuredGrid* input, const morph::Points& rest, const morph::Points& moved,
  int precision, vtkUnstructuredGrid* output, morph::Monitor& monitor);

/// Whether points for `input` are written as float at this precision. An input without points, as a
/// fresh vtkUnstructuredGrid is, has double ones.
bool IsFloat(vtkPointSet* input, int precision);

/// Throws morph::Error where a row of `moved` is not finite or beyond what DataCheck
/// allows, or, with `isFloat`, it or its difference from `rest` beyond what a float holds. Both
/// #nodes x 3. `what`: whose positions they are. `ids`: the node ids of the rows, null where these
/// are the numbers of the rows.
void RequireWritable(const morph::Points& rest, const morph::Points& moved, bool isFloat,
  const char* what, const std::vector<morph::Index>* ids = nullptr);

/// Field data of one number or text; replaces an array of that name.
void AddField(vtkDataObject* output, const char* name, double value);
void AddField(vtkDataObject* output, const char* name, int value);
void AddField(vtkDataObject* output, const char* name, vtkIdType value);
void AddField(vtkDataObject* output, const char* name, const char* value);
}
