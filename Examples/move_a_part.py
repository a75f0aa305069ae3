# SPDX-License-Identifier: BSD-3-Clause
"""Moves the upper part of any mesh, by Boundary Displacement and Morph FEMWARP.

As a macro (Macros > Import new macro...): select a volume mesh, run it, and drag the box; tick Auto
Apply (Edit > Settings) to see the mesh follow. As a script:

    PV_PLUGIN_PATH=<the build's folder plugins> pvpython move_a_part.py part.vtu part-moved.vtu

lifts the uppermost tenth of the mesh by a twentieth of its height.
"""
import sys

from paraview.simple import *


def follow(mesh, **displacement):
    """Moves a part of the mesh's boundary, and the mesh with it; returns both as sources."""
    boundary = BoundaryDisplacement(Input=mesh, **displacement)
    return boundary, MorphFEMWARP(Input=mesh, Boundary=boundary)


def lift(mesh):
    """Lifts the uppermost tenth by a twentieth of the height; sides follow, the bottom stays."""
    low, high = mesh.GetDataInformation().GetBounds()[4:]
    boundary, morph = follow(mesh, Moving="Region", Displacement="Vector", Surroundings="Fade",
                             FalloffRadius=0.5)
    boundary.Region = "Plane"
    boundary.Region.Origin = [0, 0, high - 0.1 * (high - low)]
    boundary.Region.Normal = [0, 0, -1]
    boundary.Vector = [0, 0, 0.05 * (high - low)]
    return morph


def script(source, target):
    mesh = OpenDataFile(source)
    mesh.UpdatePipeline()
    morph = lift(mesh)
    morph.UpdatePipeline()
    if morph.MorphStatus != "Valid":
        raise SystemExit(f"no valid mesh: {morph.MorphStatus}, "
                         f"{morph.InvertedCells:.0f} inverted cells")
    print(f"minimum scaled Jacobian {morph.MinScaledJacobian:.4f}, "
          f"inverted cells {morph.InvertedCells:.0f}")
    # Debian's ParaView cannot read the appended data that it writes by default.
    SaveData(target, proxy=morph, **({"DataMode": "Binary"} if target.endswith(".vtu") else {}))


def macro():
    mesh = GetActiveSource()
    if not mesh:
        raise RuntimeError("Select a volume mesh in the Pipeline Browser, and run the macro again.")
    boundary, morph = follow(mesh, Moving="Region", Surroundings="Fade")
    view = GetActiveViewOrCreate("RenderView")
    for source in (morph, OutputPort(morph, "Bad cells")):
        Show(source, view)
    Hide(mesh, view)
    SetActiveSource(boundary)
    Render(view)


if len(sys.argv) == 3:
    script(*sys.argv[1:])
else:
    macro()
