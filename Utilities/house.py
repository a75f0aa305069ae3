# SPDX-License-Identifier: BSD-3-Clause
"""Counts what a reader of the sources has to know, in the files that git tracks:

    python3 Utilities/house.py            counts statements, types and places, in a second
    python3 Utilities/house.py --frames   also how deep FEMWARP's kernel lies, in minutes

Statements are semicolons outside comments and strings. Frames are the functions of Filters that are
on the stack between the filter Morph FEMWARP and its product of matrix and vector, each counted
once: gdb stops in a Debug build of morph-mesh, which it makes in build/frames."""

import argparse
import os
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

CXX = (".h", ".cxx")
CORE = "Filters/Core/"
FOLDERS = {
    "Filters": ("Filters/",),
    "Core/Solvers and Core/Support": (CORE + "Solvers/", CORE + "Support/"),
    "rooms of MPI ranks": ("Filters/Distributed/", "Filters/Morphing/Private/Distributed/",
                           "Filters/Morphing/Private/RankBlocks/"),
    "Testing": ("Testing/",),
}
PRODUCT = ("Filters/", "Plugin/", "Programs/", "Python/")

NOT_CODE = re.compile(
    r"""//[^\n]*|/\*.*?\*/|R"\(.*?\)"|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'""", re.DOTALL)
TYPE = re.compile(r"\b(?:class|struct|union|enum(?: class)?)\s+(?:alignas\(\w+\)\s+)?\w+[^;{()]*\{")

# The properties of vtkMorphAlgorithm, vtkDisplacementAlgorithm and vtkMorphMesh.
PROPERTIES = """
    AlignTarget AutoCenter BoundaryIdArray Center Certify CoincidentPoints CornerAngle
    Displacement DisplacementArray Distance FalloffRadius FeatureAngle FeatureLines HandleRadius
    FixUnnamedBoundary KeepLayers LatticeBasis LatticeBox LatticeSize LayersArray Live
    MatchTolerance MaximumSubSteps Method Moving MovingArray NumberOfSteps NumberOfThreads
    OutputPointsPrecision PostSmooth PostSmoothIterations Quality RadiusChange RestTime Rotation
    Scale ScaleFactor SelectedHandles SlideRounds SoftStiffness StepMemoryLimit Stepping Stiffness
    StiffnessArray StiffnessExponent SurfaceIdArray SurfaceMethod Surroundings TargetAngle
    TargetReach TransformAboutCenter Translation UseGeometryArrays Validity Vector WallArray
    ZoneRegionType ZoneSelectionType""".split()

# A line in the innermost loop of the product of matrix and vector: its file, and what it holds.
KERNEL = "Filters/Core/Solvers/MultiVector.h:sum0 += A.value[k] * row"


def tracked(tree):
    """{path: text} of the text files that git tracks in the folder `tree`."""
    names = subprocess.run(["git", "-C", str(tree), "ls-files", "-z"], check=True,
                           capture_output=True, text=True).stdout.split("\0")
    texts = {}
    for name in filter(None, names):
        try:
            texts[name] = (tree / name).read_text(encoding="utf-8")
        except (UnicodeDecodeError, FileNotFoundError):
            pass
    return texts


def code(text):
    return NOT_CODE.sub(lambda match: " " if match.group()[0] == "/" else '""', text)


def statements(texts, folders):
    return sum(code(text).count(";") for name, text in texts.items()
               if name.startswith(folders) and name.endswith(CXX))


def types(texts):
    return sum(len(TYPE.findall(code(text))) for name, text in texts.items()
               if name.startswith(CORE) and name.endswith(".h"))


def places(texts):
    """Median number of files that name a property, its setter or its getter: all of them but
    scripts, and those of the product. Properties that no file of the product names are gone."""
    words = {name: set(re.findall(r"\w+", text)) for name, text in texts.items()
             if not name.endswith(".py")}
    counts = []
    for name in PROPERTIES:
        files = [file for file, found in words.items()
                 if not found.isdisjoint((name, "Set" + name, "Get" + name))]
        product = [file for file in files if file.startswith(PRODUCT)]
        if product:
            counts.append((len(files), len(product)))
    return tuple(statistics.median(column) for column in zip(*counts))


# Runs in gdb: prints the functions of the first stack on which Morph FEMWARP multiplies.
IN_GDB = """
import gdb, re
gdb.execute("set pagination off")
gdb.execute("set breakpoint pending on")
gdb.execute("break {kernel}", to_string=True)
gdb.execute("run", to_string=True)
while gdb.selected_inferior().pid:
    stack, frame = [], gdb.newest_frame()
    while frame is not None:
        where = frame.find_sal().symtab
        stack.append((frame.name() or "", where.fullname() if where else ""))
        if re.search(r"::RequestData\\b", stack[-1][0]):
            for name, file in stack:
                print("FRAME", file, name, sep="\\t")
            gdb.execute("kill")
            gdb.execute("quit")
        frame = frame.older()
    gdb.execute("continue", to_string=True)
"""


def frames(tree, build, kernel):
    """The stack's functions in Filters, the innermost first, each once."""
    file, text = kernel.split(":", 1)
    lines = (tree / file).read_text(encoding="utf-8").splitlines()
    number = next((i for i, line in enumerate(lines, 1) if text in line), None)
    if number is None:
        sys.exit(f"house.py: {file} has no line with '{text}': give another one by --kernel")
    subprocess.run(
        ["cmake", "-S", str(tree), "-B", str(build), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug",
         "-DMESHMORPHING_BUILD_PARAVIEW_PLUGIN=OFF", "-DMESHMORPHING_BUILD_TESTING=OFF",
         "-DMESHMORPHING_WRAP_PYTHON=OFF", "-DMESHMORPHING_UNITY_BUILD=ON"],
        check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", str(build), "--target", "morph-mesh"], check=True,
                   stdout=sys.stderr)
    program, mesh = build / "bin/morph-mesh", tree / "Data/Models/small/bore_hex_small.vtu"
    with tempfile.TemporaryDirectory() as folder:
        boundary = Path(folder) / "boundary.vtp"
        subprocess.run([program, "extract", mesh, boundary], check=True,
                       stdout=subprocess.DEVNULL)
        script = Path(folder) / "stack.py"
        script.write_text(IN_GDB.format(kernel=f"{tree / file}:{number}"), encoding="utf-8")
        output = subprocess.run(
            ["gdb", "--batch", "--nx", "-x", script, "--args", program, "--threads", "1",
             "--method", "FEMWARP", "--displacement-array", "FinalDisplacement", mesh, boundary,
             Path(folder) / "out.vtu"],
            capture_output=True, text=True, env={**os.environ, "DEBUGINFOD_URLS": ""})
    filters = str(tree / "Filters") + os.sep
    stack = [line.split("\t")[1:] for line in output.stdout.splitlines()
             if line.startswith("FRAME\t")]
    if not stack:
        sys.exit(f"house.py: gdb did not stop at {file}:{number} below RequestData:\n"
                 f"{output.stdout[-2000:]}{output.stderr[-2000:]}")
    return list(dict.fromkeys(
        name for file, name in stack if os.path.realpath(file).startswith(filters)))


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tree", type=Path, default=Path(__file__).resolve().parent.parent,
                        help="the checkout to count in (default: this one)")
    parser.add_argument("--frames", action="store_true", help="build, and count frames")
    parser.add_argument("--kernel", default=KERNEL,
                        help="where to stop: a file, and what its line holds (by default "
                        "%(default)s)")
    parser.add_argument("--build", type=Path, help="folder of the Debug build (default: "
                        "build/frames beside this script's folder)")
    arguments = parser.parse_args()
    tree = arguments.tree.resolve()

    texts = tracked(tree)
    rows = [(f"statements of {name}", statements(texts, folders))
            for name, folders in FOLDERS.items()]
    rows.append(("types in headers of Core", types(texts)))
    rows.extend(zip(("files that name a property", "files of the product that do"), places(texts)))
    for name, value in rows:
        print(f"{name:42}{value:9,.10g}")
    if arguments.frames:
        build = arguments.build or Path(__file__).resolve().parent.parent / "build" / "frames"
        stack = frames(tree, build.resolve(), arguments.kernel)
        print(f"{'frames under Morph FEMWARP':42}{len(stack):9}")
        for name in stack:
            print("  ", name)


if __name__ == "__main__":
    main()
