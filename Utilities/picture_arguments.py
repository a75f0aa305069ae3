# SPDX-License-Identifier: BSD-3-Clause
"""What the scripts that draw the documentation's pictures take at the prompt, and how they keep the
files small."""

import argparse
import os
import subprocess
from pathlib import Path

IMAGES = Path(__file__).resolve().parent.parent / "Documentation" / "images"


def picture_parser(description):
    """A parser with --output, whose description is the first paragraph of the text."""
    parser = argparse.ArgumentParser(description=description.split("\n\n")[0])
    parser.add_argument("--output", type=Path, default=IMAGES,
                        help="directory to write to (default: %(default)s)")
    return parser


def parse(parser):
    """The arguments, with their folder made. Ends the program where nothing can be drawn."""
    arguments = parser.parse_args()
    if not os.environ.get("DISPLAY"):
        parser.error("no display: run under xvfb-run -a")
    arguments.output = arguments.output.resolve()
    arguments.output.mkdir(parents=True, exist_ok=True)
    return arguments


def fewer_colors(path):
    """Replaces a PNG by one of a palette, with ImageMagick: a third of the size, and no difference
    that is seen."""
    subprocess.run(["convert", path, "+dither", "-colors", "128", "-strip", f"PNG8:{path}"],
                   check=True)
