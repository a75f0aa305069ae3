# SPDX-License-Identifier: BSD-3-Clause
"""What the scripts that draw the documentation's pictures take at the prompt."""

import argparse
import os
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
