# SPDX-License-Identifier: BSD-3-Clause
"""States that ParaView 5.11 wrote open in this ParaView, and give the numbers that they gave there.

Run: MESHMORPHING_PLUGIN=<path of MeshMorphing.so> pvpython older_states.py [--write FOLDER]
With --write it writes the states of this ParaView instead: states-5.11 was made so.
"""
import json
import os
import runpy
import sys
import tempfile
import unittest
from pathlib import Path

from paraview import simple, smstate

simple.LoadPlugin(os.environ["MESHMORPHING_PLUGIN"], remote=False, ns=globals())

HERE = Path(__file__).resolve().parent
STATES = HERE / "states-5.11"
DATA = HERE.parents[1] / "Data" / "Models" / "small"
PLACE = "/place/of/the/data"  # in the states, for DATA
NUMBERS = "MinScaledJacobian", "MeanScaledJacobian", "InvertedCells"
MORPHS = "FEMWARP", "Simplex-linear", "Inversion-free"


def build():
    """A part of the bore is moved, and three methods follow; two of them are shown."""
    bore = simple.XMLUnstructuredGridReader(registrationName="bore",
                                            FileName=[str(DATA / "bore_hex_small.vtu")])
    moved = BoundaryDisplacement(registrationName="moved", Input=bore, Moving="Region",
                                 Region="Box", Surroundings="Follow everywhere")
    moved.Region.Position, moved.Region.Length = [-4, -4, 6], [8, 8, 7]
    moved.Transform.Translate = [1.2, 0.5, 1.5]
    moved.Transform.Rotate = [10, 20, 30]
    for name, make in zip(MORPHS, (MorphFEMWARP, MorphSimplexLinear, MorphInversionFree)):
        morph = make(registrationName=name, Input=bore, Boundary=moved)
        morph.ScaleFactor = 0.9
        morph.UpdatePipeline()
    quality = ScaledJacobian(registrationName="quality", Input=simple.FindSource("FEMWARP"))
    view = simple.GetActiveViewOrCreate("RenderView")
    for source in (quality, simple.FindSource("Inversion-free")):
        shown = simple.Show(source, view)
        shown.SetRepresentationType("Surface With Edges")
    simple.Render(view)


def numbers():
    """By name of the morph."""
    found = {}
    for name in MORPHS:
        morph = simple.FindSource(name)
        morph.UpdatePipeline()
        found[name] = [float(getattr(morph, number)) for number in NUMBERS]
    return found


def write(folder):
    folder.mkdir(exist_ok=True)
    build()
    simple.SaveState(str(folder / "state.pvsm"))
    (folder / "state.py").write_text(smstate.get_state(), encoding="utf-8")
    for path in folder.iterdir():
        path.write_text(path.read_text(encoding="utf-8").replace(str(DATA), PLACE),
                        encoding="utf-8")
    (folder / "numbers.json").write_text(json.dumps(numbers(), indent=1) + "\n", encoding="utf-8")


class OlderStates(unittest.TestCase):
    def test_open_and_give_the_same_numbers(self):
        expected = json.loads((STATES / "numbers.json").read_text(encoding="utf-8"))
        for name in ("state.pvsm", "state.py"):
            with self.subTest(state=name), tempfile.TemporaryDirectory() as folder:
                simple.ResetSession()
                text = (STATES / name).read_text(encoding="utf-8")
                self.assertIn(PLACE, text)
                path = Path(folder, name)
                path.write_text(text.replace(PLACE, str(DATA)), encoding="utf-8")
                if name.endswith(".py"):
                    runpy.run_path(str(path))
                else:
                    simple.LoadState(str(path))
                found = numbers()
                for morph, values in expected.items():
                    for number, value, here in zip(NUMBERS, values, found[morph]):
                        message = f"{morph} {number}"
                        if morph != "Inversion-free":
                            self.assertAlmostEqual(here, value, delta=1e-9, msg=message)
                        elif number != "MeanScaledJacobian":
                            # A minimization that is improved stops elsewhere, and no lower.
                            self.assertGreater(here, value - 5e-4, message)
                    self.assertEqual(found[morph][-1], 0)
                view = simple.GetActiveView()
                names = {source.SMProxy: name for (name, _), source in simple.GetSources().items()}
                shown = {names[representation.Input.SMProxy]
                         for representation in view.Representations
                         if representation.Visibility and hasattr(representation, "Input")}
                self.assertEqual(shown, {"quality", "Inversion-free"})
                quality = simple.GetDisplayProperties(simple.FindSource("quality"), view)
                self.assertEqual(quality.Representation, "Surface With Edges")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--write"]:
        write(Path(sys.argv[2]))
    else:
        unittest.main(argv=sys.argv[:1], verbosity=2)
