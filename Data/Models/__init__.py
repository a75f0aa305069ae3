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
    bore_twist, canister_blind      variants
    footprint                       the courier's map of the plane
    model                           what all models have in common
    classification                  which geometry owns a node or a face
    classified_mesh                 a model's mesh with that, its way to VTK
    structured, sweep, gmsh_mesh    how meshes are made
    vtk_files                       files for ParaView

Needs numpy and VTK's Python modules (Debian: python3-paraview), for tetrahedra and for unstructured
hexahedra also Gmsh (python3-gmsh). The small meshes in the folder `small` need no Gmsh:
``Models.get("pipe").read_small("tet")``. Put the folder above this one (Data) on sys.path.
"""

from .bore import Bore
from .bore_twist import BoreTwist
from .canister import Canister
from .canister_blind import CanisterBlind
from .courier import Courier
from .pipe import Pipe

_MODELS = {model.name: model for model in (
    Bore(), Pipe(), Canister(), Courier(), BoreTwist(), CanisterBlind())}

#: Names of the four models, in the order of the paper.
NAMES = ("bore", "pipe", "canister", "courier")
#: Names of further models: other readings of what the paper leaves open.
VARIANTS = ("bore_twist", "canister_blind")


def get(name):
    """The Model of this name, one of NAMES or VARIANTS. Raises ValueError for another."""
    if name not in _MODELS:
        raise ValueError(f"no model '{name}': one of {', '.join(_MODELS)}")
    return _MODELS[name]
