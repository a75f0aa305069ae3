#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the tables of Documentation/Performance.md of results/performance.csv.

A figure is the median of the runs, with the least and the largest in parentheses."""

import csv
import math
import statistics
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
PAGE = ROOT / "Documentation/Performance.md"
DATA = ROOT / "Testing/Benchmark/results/performance.csv"
START = "## Growth\n"  # what the script writes begins here
NAMES = {"cube": "A cube of hexahedra", "tetrahedra": "A box of tetrahedra",
         "layers": "Layers from 1e-4 of the box", "pipe": "A thin pipe",
         "canister": "The canister", "polyhedra": "Polyhedra"}
SIZE = "100000"
GROWING = ("FEMWARP", "LBWARP", "Weighted residual", "Simplex-linear", "Simplex-natural neighbor",
           "Radial basis", "Smoothing", "Inversion-free", "FEMWARP on MPI ranks")


def show(value):
    return f"{value:,.0f}" if value >= 100 else f"{float(f'{value:.2g}'):g}"


def spread(texts):
    """ "0.53 (0.51 to 0.6)" """
    values = [float(text) for text in texts if text]
    if not values:
        return "-"
    median, low, high = map(show, (statistics.median(values), min(values), max(values)))
    return median if low == high else f"{median} ({low} to {high})"


def table(head, rows):
    return ["| " + " | ".join(cells) + " |" for cells in (head, ["---"] * len(head), *rows)] + [""]


def grouped(rows, *names):
    """{values of those columns: rows}"""
    groups = {}
    for row in rows:
        groups.setdefault(tuple(row[name] for name in names), []).append(row)
    return groups


def median(runs, name):
    values = [float(run[name]) for run in runs if run[name]]
    return statistics.median(values) if values else math.nan


def growth(rows):
    found = []
    for (program, processors), runs in grouped(rows, "program", "processors").items():
        sizes = grouped((run for run in runs if run["mesh"] == "cube"), "nodes")
        if program not in GROWING or len(sizes) < 2:
            continue
        nodes = sorted(sizes, key=lambda key: int(key[0]))
        ends = nodes[0], nodes[-1]
        step = math.log(int(ends[1][0]) / int(ends[0][0]))
        for name, label in (("first_s", "first step, s"), ("later_s", "later step, s"),
                            ("memory_GB", "memory, GB")):
            low, high = (median(sizes[end], name) for end in ends)
            found.append([program, processors, label,
                          *(f"{int(key[0]):,}: {show(median(sizes[key], name))}" for key in nodes),
                          f"{math.log(high / low) / step:.2f}"])
    most = max((len(row) for row in found), default=0)
    return table(["method", "processors", "", *["nodes: value"] * (most - 4), "power"],
                 [row[:-1] + [""] * (most - len(row)) + row[-1:] for row in found])


def mesh_by_mesh(rows):
    """Of the meshes on which all programs run; growth() has the other sizes."""
    text = []
    middle = [row for row in rows if row["size"] == SIZE]
    for (mesh, nodes), runs in grouped(middle, "mesh", "nodes").items():
        text += [f"### {NAMES[mesh]}, {int(nodes):,} nodes", ""]
        found = []
        for (program, processors), own in grouped(runs, "program", "processors").items():
            column = lambda name: spread(run[name] for run in own)
            found.append([program, processors, column("first_s"), column("later_s"),
                          column("evaluate_s"), column("memory_GB"), own[0]["inverted"] or "-",
                          own[0]["minimum"] or "-"])
        text += table(["program", "processors", "first step, s", "later step, s",
                       "of which evaluate, s", "memory, GB", "inverted", "minimum"], found)
    return text


def tables(rows):
    return "\n".join([START, *growth(rows), "## Mesh by mesh", "", *mesh_by_mesh(rows)])


def main():
    with open(DATA, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    head = PAGE.read_text(encoding="utf-8").split(START)[0]
    PAGE.write_text(head + tables(rows), encoding="utf-8")


if __name__ == "__main__":
    main()
