# SPDX-License-Identifier: BSD-3-Clause
"""The models on which the morphing methods are compared: meshes at the initial shape, which
geometry owns each node, and exact boundary positions on every shape to the final one and beyond.

    import Models
    pipe = Models.get("pipe")
    mesh = pipe.hex_mesh()              # or tet_mesh(); small=True for a small one
    mesh.points, mesh.cells             # numpy; mesh.to_vtk() is a vtkUnstructuredGrid
    mesh.nodes                          # ids of the boundary nodes
    mesh.boundary_positions(0.5)        # where these are half way from S_0 to S_F

    bore, pipe, canister, courier   the models: a geometry and its meshes each
    model              what all models have in common
    classified_mesh    a model's mesh, who owns its nodes, its way to VTK
    gmsh_mesh          meshes by Gmsh

Needs numpy and VTK's Python modules (Debian: python3-paraview), for tetrahedra and for unstructured
hexahedra also Gmsh (python3-gmsh). The small meshes in the folder `small` need no Gmsh:
``Models.get("pipe").read_small("tet")``. Put the folder above this one (Data) on sys.path.
"""

from .bore import Bore
from .canister import Canister
from .courier import Courier
from .pipe import Pipe

_MODELS = {model.name: model for model in (Bore(), Pipe(), Canister(), Courier())}

#: Names of all models, in the order of the paper.
NAMES = tuple(_MODELS)


def get(name):
    """The Model of this name. Raises ValueError for an unknown name."""
    if name not in _MODELS:
        raise ValueError(f"no model '{name}': one of {', '.join(NAMES)}")
    return _MODELS[name]
