#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the folders of Filters and who includes whom, from the sources' own #include lines.

    Utilities/design_picture.py [--output FILE.svg]

Writes Documentation/images/design.svg. An arrow is left out where a longer way says the same. Needs
the Debian package graphviz.
"""
import argparse
import collections
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "Testing"))
import layers  # noqa: E402  (needs the path above)

COLORS = {"Core": "#dbe9f6", "Morphing": "#fde5cd", "IO": "#e3f1dc", "Distributed": "#efe0f3",
          "ParallelMorphing": "#f6dbe3"}


def folder_graph(table):
    """The rows of Filters/layers.txt with their number of files and lines, and the pairs (includes,
    included)."""
    filters = table.filters
    sizes, arrows = collections.Counter(), set()
    files = collections.Counter()
    for file in layers.sources(filters):
        folder = table.row(file)
        lines = (Path(filters) / file).read_text(encoding="utf-8").splitlines()
        files[folder] += 1
        sizes[folder] += len(lines)
        for line in lines:
            match = layers.INCLUDE.match(line)
            if match and match.group(1) == '"':
                target = layers.quoted(filters, file, match.group(2))
                if target and table.row(target) != folder:
                    arrows.add((folder, table.row(target)))
    return files, sizes, arrows


def dot_text(files, sizes, arrows):
    lines = ["digraph {", "rankdir=TB; ranksep=0.35; nodesep=0.25;",
             'node [shape=box, style="filled,rounded", fontname="Helvetica", fontsize=11, '
             'color="#7f8c99"];', 'edge [color="#7f8c99", arrowsize=0.6];']
    for folder in sorted(files):
        name = folder.replace("Private/", "").replace("/", "\\n", 1)
        count = f"{files[folder]} files" if files[folder] > 1 else "1 file"
        lines.append(f'"{folder}" [fillcolor="{COLORS.get(folder.split("/")[0], "#eeeeee")}", '
                     f'label="{name}\\n{count}, {sizes[folder]:,} lines"];')
    lines += [f'"{a}" -> "{b}";' for a, b in sorted(arrows)]
    return "\n".join(lines + ["}"])


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--output", type=Path, default=ROOT / "Documentation/images/design.svg")
    options = parser.parse_args()
    text = dot_text(*folder_graph(layers.Table(str(ROOT))))
    reduced = subprocess.run(["tred"], input=text, capture_output=True, text=True, check=False)
    if reduced.returncode or "cycle" in reduced.stderr:
        sys.exit(f"design_picture.py: {reduced.stderr}")
    subprocess.run(["dot", "-Tsvg", "-o", str(options.output)], input=reduced.stdout, text=True,
                   check=True)
    print(options.output)


if __name__ == "__main__":
    main()
