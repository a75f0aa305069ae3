// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"

#include <string>

class vtkDataObject;
class vtkDataSet;
class vtkPointSet;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace morph
{
class Monitor;
}

namespace morph::filters
{
class Blocks;
class Unchanged;
}

/// The checks of the inputs of every filter of this module. Filters accept vtkDataObject on their
/// ports and call these functions. If a port asked for a vtkUnstructuredGrid, the executive would
/// run the filter on each block of a composite input, and tear the blocks' shared interfaces apart.
namespace morph::filters::Input
{
/// Return the input as its type. They throw morph::Error for another type, composite data in
/// particular, and for data that do not pass DataCheck::Require(). `port`: the subject of the
/// message ("The input").
vtkUnstructuredGrid* RequireGrid(vtkDataObject* input, const char* port);
vtkPointSet* RequirePointSet(vtkDataObject* input, const char* port);
vtkPolyData* RequirePolyData(vtkDataObject* input, const char* port);

/// Returns an unstructured grid or polygonal data.
vtkPointSet* RequireGridOrPolyData(vtkDataObject* input, const char* port);
/// As above, for a filter that is executed again and again. `checked`: the grid that it checked
/// last, of which the arrays' lengths alone are checked again.
vtkUnstructuredGrid* RequireGrid(vtkDataObject* input, const char* port, Unchanged& checked);
vtkPointSet* RequireGridOrPolyData(vtkDataObject* input, const char* port, Unchanged& checked);
/// As RequirePointSet(), for the boundary of a mesh to be morphed; null has a message of its own.
vtkPointSet* RequireBoundary(vtkDataObject* input);

/// Whether `data` are an unstructured grid that other filters can read. Its arrays are long enough,
/// its cells name points that exist, and its coordinates are finite. Cost: a copy of the grid's
/// points and cells.
bool IsReadable(vtkDataObject* data);

/// Whether `data`, which may be null, have points.
bool HasPoints(vtkDataObject* data);

/// Throws morph::Error where `boundary` has volume cells and `input`, a grid or surface, has none.
/// Either may be null.
void RequireNotSwapped(vtkDataObject* input, vtkDataObject* boundary);

enum class Use
{
  ToMorph,   ///< each MPI process may have a part, of known types alone, if Ranks::TakePieces()
  ToMeasure, ///< each process may have a part, of any cells
};
struct Mesh
{
  vtkDataObject* Data; ///< the input, or its blocks as one grid
  bool IsElsewhere;    ///< other MPI processes have the cells
  bool IsEmpty;        ///< no process has any
  bool IsDistributed;  ///< several processes have cells
};
/// Takes a filter's mesh, of composite data too, and a plane one as a solid; see Blocks. Throws
/// morph::Error as Gather(), Thicken() and RequireNotSwapped() do and, on all processes, where
/// more of them have cells than `use` allows. To be called on every process, before anything can
/// fail there. `filter`: what the message says needs one rank. `boundary`: the mesh's, or null.
Mesh TakeMesh(vtkDataObject* input, Blocks& blocks, int coincidentPoints, Use use,
  const char* filter, morph::Monitor& monitor, vtkDataObject* boundary = nullptr);
}
