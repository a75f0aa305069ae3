// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Mesh/Mesh.h"

#include <string>

class vtkDataObject;
class vtkDataSet;
class vtkPointSet;
class vtkPolyData;
class vtkUnstructuredGrid;

/// The checks that every filter of this module makes of its inputs. Filters accept vtkDataObject on
/// their ports and call these: if a port asked for a vtkUnstructuredGrid, the executive would run
/// the filter on each block of a composite input, and tear the blocks' shared interfaces apart.
namespace morph::filters::Input
{
/// Throw morph::Error for another type, composite data in particular, and for data that do not pass
/// DataCheck::Require(). `port` names it in the message: "The input".
vtkUnstructuredGrid* RequireGrid(vtkDataObject* input, const char* port);
vtkPointSet* RequirePointSet(vtkDataObject* input, const char* port);
vtkPolyData* RequirePolyData(vtkDataObject* input, const char* port);

/// An unstructured grid or polygonal data.
vtkPointSet* RequireGridOrPolyData(vtkDataObject* input, const char* port);
/// As RequirePointSet(), for the boundary of a mesh that is to be morphed; null has a message of
/// its own.
vtkPointSet* RequireBoundary(vtkDataObject* input);

/// Whether `data` are an unstructured grid that others can read: arrays long enough, cells that
/// name points that exist, coordinates that are finite. Cost: a copy of the grid's points and
/// cells.
bool IsReadable(vtkDataObject* data);

/// Throws morph::Error where `boundary` has volume cells and `input`, a grid or surface, has others
/// alone. Either may be null.
void RequireNotSwapped(vtkDataObject* input, vtkDataObject* boundary);

/// To be called on every process, before anything can fail there: with the data, or null where
/// their type was wrong. Throws morph::Error on all processes if several of them have cells.
/// Returns how many have: 0 or 1.
int RequireOneRankWithCells(vtkDataSet* grid);

/// Throws morph::Error unless there is a cell of dimension 3, and these are large enough to compute
/// with (see DataCheck). All types have to be known to the core.
void RequireVolumeCells(const morph::Mesh& mesh);

/// The name of an array as a property holds it. Empty for none: a null pointer, or "None", which
/// ParaView's choice of an array offers.
std::string ArrayName(const char* name);
}
