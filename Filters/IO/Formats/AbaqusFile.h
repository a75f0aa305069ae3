// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Formats/SolverFile.h"

namespace morph::io
{
/// Whether a file is the input of Abaqus or CalculiX: an .inp whose first line, comments apart, is
/// a keyword. AVS UCD files have the same extension, and begin with numbers.
bool isAbaqusFile(const std::string& path);

/// Reads nodes, elements, node sets, element sets and surfaces of an input file and of those that
/// it includes (*INCLUDE, and INPUT= of *NODE and *ELEMENT). Couplings, rigid bodies and the
/// multi-point constraints BEAM, LINK, PIN and TIE are lines without a number. Parts are read as
/// their instances, in the assembly; the numbers of the second one and later ones are shifted.
/// Generated nodes or elements and spherical coordinates are refused by name. Numbers are written
/// with up to 20 characters, which CalculiX reads.
std::unique_ptr<SolverFile> readAbaqusFile(const std::string& path);
}
