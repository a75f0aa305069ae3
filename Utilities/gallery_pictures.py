# SPDX-License-Identifier: BSD-3-Clause
"""Runs the scripts of Examples/gallery, and keeps their pictures and what they measure.

    xvfb-run -a -s "-noreset -screen 0 1280x1024x24" \\
        pvpython --force-offscreen-rendering Utilities/gallery_pictures.py [--plugin FILE] [NAME...]

Writes gallery-<name>.png into Documentation/images and, if no script is named,
Documentation/Study/gallery.csv. Needs the plugin and ImageMagick."""

import csv
import importlib
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
GALLERY = ROOT / "Examples/gallery"
sys.path[:0] = [str(GALLERY), str(ROOT / "Utilities")]
from built_plugin import add_plugin, load_plugin  # noqa: E402  (needs the path above)
from picture_arguments import fewer_colors, parse, picture_parser  # noqa: E402
from study_pieces import ORIGIN, origin  # noqa: E402

NAMES = sorted(path.stem for path in GALLERY.glob("*.py") if path.stem != "gallery")


def main():
    parser = picture_parser(__doc__)
    add_plugin(parser)
    parser.add_argument("names", nargs="*", metavar="NAME", help="default: all")
    arguments = parse(parser)
    unknown = [name for name in arguments.names if name not in NAMES]
    if unknown:
        parser.error(f"no script {', '.join(unknown)}: choose from {', '.join(NAMES)}")
    load_plugin(arguments.plugin)
    rows = []
    for name in arguments.names or NAMES:
        example = importlib.import_module(name).example()
        rows.append({"script": name, **example.row(), **dict(zip(ORIGIN, origin()))})
        print(rows[-1], flush=True)
        path = arguments.output / f"gallery-{name}.png"
        example.save(path)
        fewer_colors(path)
    if not arguments.names:
        with open(ROOT / "Documentation/Study/gallery.csv", "w", encoding="utf-8",
                  newline="") as file:
            writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
            writer.writeheader()
            for row in rows:
                writer.writerow({key: f"{value:.4g}" if isinstance(value, float) else value
                                 for key, value in row.items()})


if __name__ == "__main__":
    main()
