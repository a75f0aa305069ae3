# SPDX-License-Identifier: BSD-3-Clause
"""`pip wheel` makes a wheel of the package, which a new environment installs and runs.

Run: python3 wheel.py [--build <folder of a build>]
The wheel has what that build has; without it, setup.py compiles the core.
"""
import importlib.util
import os
import subprocess
import sys
import tempfile
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
USE = """
import numpy
import meshmorphing as mm
points = numpy.array([[x, y, z] for z in (0, 1, 2) for y in (0, 1, 2) for x in (0, 1, 2)], float)
corner = numpy.array([0, 1, 4, 3, 9, 10, 13, 12])
cells = numpy.array([corner + i for i in (0, 1, 3, 4, 9, 10, 12, 13)])
mesh = mm.Mesh(points, [("hexahedron", cells)])
moved = mm.morph(mesh, mesh.boundary.nodes, 0.1 * points[mesh.boundary.nodes])
assert abs(moved - 1.1 * points).max() < 1e-10
print(mm.__version__, mm.__file__)
"""


def main():
    missing = [name for name in ("pip", "setuptools", "wheel", "numpy", "ensurepip")
               if not importlib.util.find_spec(name)]
    if missing:
        print("skipped: this Python has no", ", ".join(missing))
        return 77
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    if sys.argv[1:2] == ["--build"]:
        environment["MESHMORPHING_BUILD"] = sys.argv[2]
    with tempfile.TemporaryDirectory() as folder:
        pip = [sys.executable, "-m", "pip", "--disable-pip-version-check"]
        subprocess.run([*pip, "wheel", "--no-build-isolation", "--no-deps", "-w", folder, ROOT],
                       check=True, env=environment)
        wheel, = Path(folder).glob("meshmorphing-*.whl")
        venv.create(Path(folder, "new"), system_site_packages=True)
        python = Path(folder, "new/bin/python3")
        subprocess.run([*pip, "--python", python, "install", "--no-deps", "--no-index", wheel],
                       check=True, env=environment)
        result = subprocess.run([python, "-c", USE], check=True, env=environment, cwd=folder,
                                capture_output=True, text=True)
        version, file = result.stdout.split()
        assert wheel.name.startswith(f"meshmorphing-{version}-"), (wheel, version)
        assert Path(folder, "new") in Path(file).parents, file
        print(wheel.name, wheel.stat().st_size, "bytes")
    return 0


if __name__ == "__main__":
    sys.exit(main())
