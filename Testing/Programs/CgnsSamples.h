// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

/// Writes a cube of 3 x 3 x 3 hexahedra into files of CGNS: two zones in HDF5 (cube.cgns) and in
/// ADF (cube_adf.cgns), in single precision (cube_single.cgns), and as a structured zone
/// (structured.cgns). Names: "wall" (faces x = 0) and "top" (nodes z = 3). Also a hexahedron of 20
/// nodes (hexa_20.cgns), one of 27 and a wedge of 15, and a square in the plane (planar.cgns).
/// Throws runtime_error.
void writeCgnsSamples(const std::string& folder);
