# SPDX-License-Identifier: BSD-3-Clause
"""Loads the plugin into ParaView's Python."""

import os
import sys
from pathlib import Path

from paraview import simple

#: Not all of build/paraview: tests install another, perhaps older, plugin there.
BUILT = Path(__file__).resolve().parent.parent / "build" / "paraview" / "lib"


def add_plugin(parser):
    """Adds --plugin, whose value load_plugin() takes, to an argparse.ArgumentParser."""
    parser.add_argument("--plugin", default=os.environ.get("MESHMORPHING_PLUGIN"),
                        help="default: $MESHMORPHING_PLUGIN, or the one under build/paraview")


def load_plugin(given):
    """Loads the plugin: the file `given`, or, where that is None or empty, the one that was built.
    Ends the program where there is none."""
    built = sorted(BUILT.glob("**/MeshMorphing.so"))
    if not given and not built:
        sys.exit(f"no MeshMorphing.so under {BUILT}: "
                 "build it, by Utilities/demo.sh for one, or use --plugin")
    simple.LoadPlugin(str(given or built[0]), remote=False, ns=vars(simple))
