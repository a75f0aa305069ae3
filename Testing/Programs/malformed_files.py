# SPDX-License-Identifier: BSD-3-Clause
"""Breaks small files in all formats that morph-mesh reads, and runs it on them: it must either fail
with one message and leave no file, or write a valid mesh. Readers of VTK, netCDF and CGNS may
seldom die of damage within the data, and then no file may be left either.

Run: MORPH_MESH=<its path> SAMPLE_FILES=<path of MeshMorphingSampleFiles>
         python3 malformed_files.py [--cases N] [--seed S] [--first I] [-j N]
A case depends on the seed and its index alone; one that fails is kept in --keep.
"""
import argparse
import collections
import concurrent.futures
import math
import os
import random
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import ansys_files
import deck_forms
import exodus_models
import gmsh_models
import mutations
import solver_models as models

PROGRAM = os.environ["MORPH_MESH"]
SAMPLES = os.environ["SAMPLE_FILES"]
SECONDS = 10  # of computing: a run that takes longer hangs
WALL_SECONDS = 300  # by the clock: others may use the machine
OWN = ".bdf", ".cdb", ".inp", ".k", ".msh", ".su2"  # solvers' files that no library of others reads
DEATHS = 0.03  # of the cases, at most; 10 of 600 were measured with ParaView 5.11
MEGABYTES = 4096  # of address space that a run may grow by: a small file must not need it


def write_text_samples(folder):
    """Writes the formats that VTK reads but does not write, AVS UCD and Gambit, and a grid of one
    piece."""
    (folder / "grid_parallel.pvtu").write_text("""<?xml version="1.0"?>
<VTKFile type="PUnstructuredGrid" version="0.1" byte_order="LittleEndian">
  <PUnstructuredGrid GhostLevel="0">
    <PPoints>
      <PDataArray type="Float64" Name="Points" NumberOfComponents="3"/>
    </PPoints>
    <Piece Source="grid_ascii.vtu"/>
  </PUnstructuredGrid>
</VTKFile>
""")
    nodes = [(x, y, z) for z in range(4) for y in range(4) for x in range(4)]
    corners = [x + 4 * (y + 4 * z) for z in range(3) for y in range(3) for x in range(3)]
    cells = [[first + corner for corner in (1, 2, 6, 5, 17, 18, 22, 21)] for first in corners]
    lines = [f"{len(nodes)} {len(cells)} 0 0 0"]
    lines += [f"{i + 1} {x} {y} {z}" for i, (x, y, z) in enumerate(nodes)]
    lines += [f"{i + 1} 0 hex " + " ".join(map(str, cell)) for i, cell in enumerate(cells)]
    (folder / "grid.inp").write_text("\n".join(lines) + "\n")
    lines = ["        CONTROL INFO 1.3.0", "** GAMBIT NEUTRAL FILE", "cube",
             "PROGRAM: Gambit VERSION: 1.3.0",
             "January 2000", "     NUMNP     NELEM     NGRPS    NBSETS     NDFCD     NDFVL",
             f"{len(nodes):10}{len(cells):10}{0:10}{0:10}{3:10}{3:10}", "ENDOFSECTION",
             "   NODAL COORDINATES 1.3.0"]
    lines += [f"{i + 1:10}{x:20.10e}{y:20.10e}{z:20.10e}" for i, (x, y, z) in enumerate(nodes)]
    lines += ["ENDOFSECTION", "      ELEMENTS/CELLS 1.3.0"]
    for i, c in enumerate(cells):
        lines += [f"{i + 1:8} {4:2} {8:2} " + "".join(f"{n:8}" for n in c[:7]), f"{c[7]:23}"]
    lines += ["ENDOFSECTION"]
    (folder / "grid.neu").write_text("\n".join(lines) + "\n")


def write_solver_samples(folder):
    """Solvers' own files, of a small model. Their names begin with "solver"."""
    model, rng = models.random_model("malformed", sizes=(2, 2, 2))
    for name, pieces in (("solver.inp", models.abaqus(model, rng)),
                         ("solver.bdf", models.nastran(model, rng)),
                         ("solver.su2", models.su2(model, rng)),
                         ("solver22.msh", gmsh_models.gmsh(model, rng, version="2.2")),
                         ("solver41.msh", gmsh_models.gmsh(model, rng, version="4.1"))):
        (folder / name).write_bytes(models.text_of(pieces))
    ansys, elements = ansys_files.Ansys, ((1, ansys_files.Ansys.BRICK), (3, ansys_files.Ansys.LID))
    component = "CMBLOCK,WALL,NODE,2\n(8i10)\n         5        -8\n"
    for name, write in (("solver.cdb", ansys.cdb), ("solver_unblocked.cdb", ansys.unblocked)):
        (folder / name).write_text(write(ansys, ansys.CORNERS, elements, rest=component))
    (folder / "solver.k").write_text(deck_forms.DeckForms.dyna(
        deck_forms, "*SET_NODE_LIST_TITLE\nwall\n1\n5,6,7,8\n*ELEMENT_SHELL\n1,8,5,6,8,7\n"))
    for version in ("2.2", "4.1"):
        (folder / f"solver_binary{version[0]}.msh").write_bytes(
            gmsh_models.gmsh_binary(model, version)[0])
    if shutil.which("ncgen"):
        cdl = folder.parent / "solver.cdl"
        cdl.write_text(exodus_models.exodus(model))
        for kind in ("classic", "64-bit offset", "64-bit data", "netCDF-4"):
            subprocess.run(["ncgen", "-k", kind, "-o", folder / f"solver_{kind[:6]}.exo", cdl],
                           check=True)
    for path in folder.glob("cube*.cgns"):
        path.rename(path.with_name("solver_" + path.name))


#: The names of what moves in these files; "wall" in the others.
WALLS = {".cdb": "WALL", ".inp": "Wall", ".bdf": "PID 2"}


def finite_mesh(path):
    """Why the legacy file that morph-mesh wrote is no valid mesh; empty if it is one."""
    data = path.read_bytes()
    match = re.search(rb"\nPOINTS (\d+) (float|double)\n", data)
    if not match:
        return "it has no points"
    count, size = 3 * int(match[1]), 4 if match[2] == b"float" else 8
    values = struct.unpack_from(f">{count}{'f' if size == 4 else 'd'}", data, match.end())
    if not all(map(math.isfinite, values)):
        return "a coordinate is not finite"
    cells = re.search(rb"\nCELLS (\d+) (\d+)\nOFFSETS vtktypeint64\n", data)
    if not cells:
        return "it has no cells"
    offsets = struct.unpack_from(f">{int(cells[1])}q", data, cells.end())
    head = b"CONNECTIVITY vtktypeint64\n"
    start = data.index(head, cells.end()) + len(head)
    ids = struct.unpack_from(f">{int(cells[2])}q", data, start)
    if list(offsets) != sorted(offsets) or offsets[0] != 0 or offsets[-1] != len(ids):
        return "its offsets are wrong"
    return "" if all(0 <= i < count // 3 for i in ids) else "a cell names a point that is not there"


class Cases:
    def __init__(self, folder, seed):
        self.folder, self.seed = folder, seed
        subprocess.run([SAMPLES, str(folder)], check=True)
        write_text_samples(folder)
        write_solver_samples(folder)
        self.grid = str(folder / "grid_zlib.vtu")
        self.boundaries = {}
        names = "grid_zlib.vtu", "grid.exo", "grid.inp", "grid.neu"
        for grid in [folder / name for name in names]:
            path = folder / f"boundary_of_{grid.name}.vtp"
            result = subprocess.run([PROGRAM, "extract", str(grid), str(path)],
                                    capture_output=True, text=True)
            if result.returncode != 0:
                raise SystemExit(f"{grid}: {result.stderr}")
            self.boundaries[grid.name] = str(path)
        names = sorted(p.name for p in folder.iterdir() if not p.name.startswith("boundary_of"))
        self.samples = [folder / name for name in names]

    def arguments(self, sample, file, output):
        if sample.name.startswith("boundary"):
            return [self.grid, str(file), str(output)]
        if sample.name.startswith("solver"):
            return ["--move", WALLS.get(sample.suffix, "wall"), "--translate", "0.05,0.02,-0.03",
                    str(file), str(output)]
        boundary = self.boundaries.get(sample.name, self.boundaries["grid_zlib.vtu"])
        return [str(file), boundary, str(output)]

    def make(self, index, folder):
        """The broken file of case `index`."""
        source = random.Random(f"{self.seed}:{index}")
        sample = self.samples[index % len(self.samples)]
        data, ways = mutations.broken(source, sample.read_bytes())
        extension = sample.suffix
        if source.random() < 0.03:  # a file of another kind
            extension, ways = source.choice(self.samples).suffix, ways + "+renamed"
        file = folder / f"case{index}{extension}"
        if sample.name == "grid_parallel.pvtu" and source.random() < 0.9:
            shutil.copy(self.folder / "grid_ascii.vtu", folder)
        file.write_bytes(data)
        return sample, file, ways

    def run(self, index):
        """(sample, ways, status, fault): the fault is empty where morph-mesh did what it must."""
        with tempfile.TemporaryDirectory(dir=self.folder.parent) as name:
            folder = Path(name)
            sample, file, ways = self.make(index, folder)
            own = sample.name.startswith("solver") and index // len(self.samples) % 2
            output = folder / ("out" + (file.suffix if own else ".vtk"))
            command = ["prlimit", f"--as={MEGABYTES << 20}", f"--cpu={SECONDS}", PROGRAM,
                       "--quiet", "--threads", "1", *self.arguments(sample, file, output)]
            try:
                result = subprocess.run(command, capture_output=True, timeout=WALL_SECONDS,
                                        stdin=subprocess.DEVNULL)
            except subprocess.TimeoutExpired:
                return sample.name, ways, None, f"no end after {WALL_SECONDS} s"
            fault = self.fault(sample, file, ways, result, output)
            return sample.name, ways, result.returncode, fault

    def fault(self, sample, file, ways, result, output):
        text = result.stderr.decode(errors="replace")
        left = [p.name for p in output.parent.iterdir() if ".morph-mesh-" in p.name]
        if left:
            return f"a temporary file is left: {left}"
        if result.returncode in (0, 3):  # 3: written, with cells that the motion inverts
            xml = file.suffix in (".vtu", ".vtp")
            cut = file.read_bytes().rstrip() != sample.read_bytes().rstrip()
            if xml and ways == "truncated" and cut:
                return "a truncated XML file is taken for a whole one"
            if not output.exists():
                return f"status {result.returncode} without a file"
            if output.suffix == ".vtk":
                return finite_mesh(output)
            again = subprocess.run([PROGRAM, "--list-surfaces", output], capture_output=True,
                                   timeout=WALL_SECONDS)
            return "" if again.returncode == 0 else f"the copy cannot be read: {again.stderr!r}"
        if output.exists():
            return "an error, yet a file is written"
        is_ours = sample.name.startswith("solver") and file.suffix in OWN
        if result.returncode < 0 and not is_ours:
            return ""
        if result.returncode != 1:
            return f"status {result.returncode}: {text.strip()[-300:]}"
        lines = text.splitlines()
        errors = [line for line in lines
                  if line.startswith("morph-mesh: ") and "warning: " not in line]
        if len(errors) != 1 or not lines[-1].startswith("morph-mesh: "):
            return f"not one message: {text.strip()[:600]!r}"
        return ""


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--cases", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("-j", type=int, default=2, dest="jobs")
    parser.add_argument("--keep", type=Path, help="folder for the files of cases that fail")
    options = parser.parse_args()
    start = time.monotonic()
    with tempfile.TemporaryDirectory() as name:
        samples = Path(name) / "samples"
        samples.mkdir()
        cases = Cases(samples, options.seed)
        indices = range(options.first, options.first + options.cases)
        failed, statuses = 0, collections.Counter()
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            for index, (sample, ways, status, fault) in zip(indices, pool.map(cases.run, indices)):
                statuses[status] += 1
                if (index + 1) % 1000 == 0:
                    seconds = time.monotonic() - start
                    print(f"{index + 1}: {failed} failed, {seconds:.0f} s", flush=True)
                if fault:
                    failed += 1
                    print(f"case {index} ({sample}, {ways}): {fault}", flush=True)
                    if options.keep:
                        options.keep.mkdir(parents=True, exist_ok=True)
                        cases.make(index, options.keep)
    deaths = sum(count for status, count in statuses.items() if status and status < 0)
    print(f"seed {options.seed}, cases {indices.start} to {indices.stop - 1}, "
          f"{time.monotonic() - start:.0f} s: "
          f"{failed} failed; {deaths} deaths; exit statuses {dict(statuses)}")
    return 1 if failed or deaths > DEATHS * options.cases else 0


if __name__ == "__main__":
    sys.exit(main())
