# SPDX-License-Identifier: BSD-3-Clause
"""Compares what the filters make now with what they made when frozen.json was stored:

    xvfb-run -a pvpython --force-offscreen-rendering Testing/Freeze/freeze.py [--plugin FILE]
        [--rows REGEX] [--list] [--store]

A row (rows.py) is one filter on one mesh. There are three kinds:
    exact    points agree to 1e-10 of the size of the mesh, counts and texts are the same
    solved   as exact, to 1e-8: Morph Mesh and Morph Shapes solve to their own tolerance
    search   counts and the minimum agree within 2 %; the points are not compared: methods that
             search, and what was repaired
Without --store the exit status is 1 where a row differs. --store writes the rows chosen by --rows,
or all of them, and leaves the others. Rows on meshes that are not there are left out, and named."""

import argparse
import json
import re
import sys
import time
from pathlib import Path

import numpy as np
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet, vtkTable

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "Utilities"), str(HERE.parents[1] / "Data")]
from built_plugin import add_plugin, load_plugin  # noqa: E402  (needs the path above)

SUMS = 48  # of the points of a row
FROZEN = HERE / "frozen.json"
POINT_TOLERANCE = {"exact": 1e-10, "solved": 1e-8}  # of the size
NUMBER_TOLERANCE = {"exact": 1e-7, "solved": 1e-5, "search": 0.02}
SEARCH_NUMBERS = {"InvertedCells", "DegenerateCells", "MinScaledJacobian", "MorphStatus",
                  "PrescribedPoints", "UnmatchedPoints", "BoundaryInvertedCells", "FoldedFaces"}
# Effort is no result, several cells may be the worst one, and lists of surfaces are long.
IGNORED = re.compile("Seconds|Iterations|Evaluations|Memory|Megabytes|SlideReport"
                     "|(Prepare|Solve|Classify|Choose)Count"
                     "|MethodCounts|WorstCellId|(Patch|Surface)(List|Sizes|Bounds)|Picked|Timestep"
                     "|FinalDisplacement|MorphDisplacement|RestPosition")
# What a filter without a result says.
NOTHING = ("-1", "0", "0.0", "-1.0", "nan", "'None'", "''", "[]")
NUMBER = re.compile(r"-?\b\d+\.?\d*(?:e[-+]?\d+)?")


def leaves(data):
    """The data sets of an output, which may be composite."""
    if not isinstance(data, vtkCompositeDataSet):
        return [data]
    iterator, found = data.NewIterator(), []
    while not iterator.IsDoneWithTraversal():
        found.append(iterator.GetCurrentDataObject())
        iterator.GoToNextItem()
    return found


def sums(values, count):
    """Random signed sums of the numbers, each number in one of `count` sums: where a few numbers
    change, the sums that hold them change as much. Returns the sums and how many numbers each has.
    """
    values = np.asarray(values, dtype=float).ravel()
    generator = np.random.default_rng(values.size)
    place = generator.integers(0, count, values.size)
    sign = generator.choice([-1.0, 1.0], values.size)
    finite = np.where(np.isfinite(values), values, 0)
    return (np.bincount(place, sign * finite, count),
            np.bincount(place, minlength=count))


def rounded(values):
    return [float(f"{value:.14g}") for value in values]


def arrays_of(data_sets):
    """{name: what is stored} of the point and cell arrays of numbers."""
    found = {}
    for kind in ("Point", "Cell"):
        columns = {}
        for data in data_sets:
            attributes = getattr(data, f"Get{kind}Data", lambda: None)()
            for i in range(attributes.GetNumberOfArrays() if attributes else 0):
                array = attributes.GetArray(i)
                if array is not None and array.GetName() and not IGNORED.search(array.GetName()):
                    columns.setdefault(array.GetName(), []).append(
                        vtk_to_numpy(array).astype(float).ravel())
        for name, parts in columns.items():
            values = np.concatenate(parts)
            found[f"{kind} {name}"] = {
                "numbers": values.size, "not finite": int(np.sum(~np.isfinite(values))),
                "largest": float(np.nanmax(np.abs(values), initial=0)),
                "sums": rounded(sums(values, 4)[0])}
    return found


def table_of(table):
    columns = (table.GetColumn(i) for i in range(table.GetNumberOfColumns()))
    return {column.GetName(): " ".join(str(column.GetVariantValue(row))
                                       for row in range(table.GetNumberOfRows()))
            for column in columns if not IGNORED.search(column.GetName())}


def numbers_of(proxy):
    """{name: text} of the numbers and texts that the filter reports in the panel."""
    proxy.UpdatePropertyInformation()
    found = {}
    for name in proxy.ListProperties():
        value = proxy.GetProperty(name)
        if value.SMProperty.GetInformationOnly() and not IGNORED.search(name):
            found[name] = str(value)
    return {name: text for name, text in found.items() if text not in NOTHING}


def measured(kind, proxy, port=0, at=None):
    """What is stored of a row."""
    window, before = vtkStringOutputWindow(), vtkOutputWindow.GetInstance()
    vtkOutputWindow.SetInstance(window)
    try:
        proxy.UpdatePipeline() if at is None else proxy.UpdatePipeline(at)
        data = proxy.GetClientSideObject().GetOutputDataObject(port)
        numbers = numbers_of(proxy)
    finally:
        vtkOutputWindow.SetInstance(before)
    # Without places in the sources, addresses, and cells of which several may be as bad.
    said = [re.sub(r" \(0x\w+\)", "", line) for line in window.GetOutput().splitlines()
            if line.strip() and not re.search(r"^\w+: In .*, line \d+$|^ +(cell \d|\.\.\.)", line)]
    if numbers.get("MorphStatus") == "'Repaired'":
        kind = "search"
    row = {"kind": kind, "said": said, "numbers": numbers}
    if isinstance(data, vtkTable):
        row["table"] = table_of(data)
        return row
    data_sets = [one for one in leaves(data) if hasattr(one, "GetPoint")]
    row["points"] = sum(one.GetNumberOfPoints() for one in data_sets)
    row["cells"] = sum(one.GetNumberOfCells() for one in data_sets)
    if kind == "search":
        row["numbers"] = {name: text for name, text in numbers.items() if name in SEARCH_NUMBERS}
        return row
    points = np.concatenate([
        vtk_to_numpy(one.GetPoints().GetData()).astype(float) for one in data_sets
        if one.GetNumberOfPoints()] or [np.empty((0, 3))])
    row["size"] = float(np.linalg.norm(np.ptp(points, axis=0))) if len(points) else 0.0
    row["sums"] = rounded(sums(points, SUMS)[0])
    row["arrays"] = arrays_of(data_sets)
    return row


def texts_differ(old, new, tolerance):
    """Whether two texts differ in more than their numbers by the tolerance, of the larger one."""
    if NUMBER.sub("#", old) != NUMBER.sub("#", new):
        return True
    pairs = zip(map(float, NUMBER.findall(old)), map(float, NUMBER.findall(new)))
    return any(abs(a - b) > tolerance * max(abs(a), abs(b)) + 1e-12 for a, b in pairs)


def differences(old, new):
    """Lines that say how a row differs from the stored one."""
    kind, found = old["kind"], []
    tolerance = NUMBER_TOLERANCE[kind]
    for name in ("kind", "points", "cells"):
        if old.get(name) != new.get(name):
            found.append(f"{name}: {old.get(name)} before, {new.get(name)} now")
    for part in ("numbers", "table"):
        before, now = old.get(part, {}), new.get(part, {})
        for name in sorted(before.keys() | now.keys()):
            pair = before.get(name, "nothing"), now.get(name, "nothing")
            if texts_differ(*pair, tolerance):
                found.append(f"{name}: {pair[0]} before, {pair[1]} now")
    if texts_differ("\n".join(old["said"]), "\n".join(new["said"]), tolerance):
        found.append(f"said {old['said']} before, {new['said']} now")
    if kind == "search" or "sums" not in old or old["points"] != new["points"]:
        return found
    size = max(old["size"], 1e-300)
    held = np.maximum(sums(np.zeros(3 * old["points"]), SUMS)[1], 1)
    # Deviations of several nodes add up at random.
    worst = np.max(np.abs(np.subtract(old["sums"], new["sums"])) / np.sqrt(held)) / size
    if not worst <= POINT_TOLERANCE[kind]:
        found.append(f"points differ by {worst:.1e} of the size")
    for name in sorted(old["arrays"].keys() | new["arrays"].keys()):
        before, now = old["arrays"].get(name), new["arrays"].get(name)
        if before is None or now is None:
            found.append(f"array {name}: only {'now' if before is None else 'before'}")
        elif any(before[key] != now[key] for key in ("numbers", "not finite")):
            found.append(f"array {name}: other numbers of values")
        else:
            change = np.max(np.abs(np.subtract(before["sums"], now["sums"])))
            scale = max(before["largest"], now["largest"]) * max(1, np.sqrt(before["numbers"] / 4))
            if not change <= tolerance * scale + 1e-12:
                found.append(f"array {name} differs by {change / scale:.1e}")
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    add_plugin(parser)
    parser.add_argument("--rows", default="", help="a regular expression: these rows alone")
    parser.add_argument("--store", action="store_true", help="store, do not compare")
    parser.add_argument("--list", action="store_true", help="print the names of the rows")
    parser.add_argument("--file", type=Path, default=FROZEN, help="default: %(default)s")
    arguments = parser.parse_args()
    load_plugin(arguments.plugin)
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)  # what filters say is compared
    import rows
    chosen = {name: row for name, row in rows.all_rows().items()
              if re.search(arguments.rows, name)}
    if arguments.list:
        print("\n".join(chosen))
        return 0
    frozen = {}
    if arguments.file.exists():
        frozen = json.loads(arguments.file.read_text(encoding="utf-8"))
    elif not arguments.store:
        print(f"{arguments.file} is not there: nothing to compare with. --store makes it.")
        return 77

    start, different, new, seconds = time.monotonic(), [], {}, {}
    for name, (kind, make) in chosen.items():
        if name not in frozen and not arguments.store:
            different.append(name)
            print(f"{name}: not stored")
            continue
        began = time.monotonic()
        new[name] = measured(kind, *make())
        seconds[name] = time.monotonic() - began
        simple.Delete()
        if not arguments.store:
            found = differences(frozen[name], new[name])
            if found:
                different.append(name)
                print("\n    ".join([f"{name}:", *found]), flush=True)
    if arguments.store:
        gone = [name for name in frozen
                if re.search(arguments.rows, name) and name not in chosen
                and not rows.is_on_missing_mesh(name)]
        kept = {name: row for name, row in frozen.items() if name not in gone}
        lines = [f"{json.dumps(name)}: {json.dumps(row, separators=(',', ':'))}"
                 for name, row in sorted({**kept, **new}.items())]
        arguments.file.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")
    else:
        for name in frozen:
            if re.search(arguments.rows, name) and name not in chosen:
                if rows.is_on_missing_mesh(name):
                    print(f"{name}: left out, its mesh is not here")
                else:
                    different.append(name)
                    print(f"{name}: stored, but no row any more")
    slowest = sorted(seconds, key=seconds.get)[:-4:-1]
    print(f"{len(new)} rows {'stored' if arguments.store else 'compared'} in "
          f"{time.monotonic() - start:.0f} s, {len(different)} differ. Slowest: "
          + ", ".join(f"{name} {seconds[name]:.1f} s" for name in slowest))
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
