# SPDX-License-Identifier: BSD-3-Clause
"""Generators of the models on which the morphing methods are compared.

    model_mesh   a volume mesh of one cell type as numpy arrays, and its way to VTK
    bore         the bore's geometry: parameters, analytic surfaces, places on them
    bore_mesh    the bore's hexahedral and tetrahedral meshes

Needs numpy and VTK's Python modules (Debian: python3-paraview); the tetrahedral meshes also Gmsh
(python3-gmsh). Put the folder above this one (Data) on sys.path: ``from Models import bore,
bore_mesh``. """
