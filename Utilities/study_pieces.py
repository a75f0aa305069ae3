# SPDX-License-Identifier: BSD-3-Clause
"""What lets the study run in pieces: the machine and the state of the sources that a row comes
from, and an end of the time that a piece has."""

import os
import re
import subprocess
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


#: The columns that say where a row of a data file comes from.
ORIGIN = ("machine", "commit")


def origin():
    """The values of ORIGIN."""
    return machine(), commit()


def machine():
    """ "2 x Intel Xeon" """
    text = Path("/proc/cpuinfo").read_text(encoding="ascii", errors="replace")
    return f"{os.cpu_count()} x {re.search(r'model name.*: (.*)', text)[1].strip()}"


def commit():
    """The sources' commit, with "-dirty" where files differ from it; "unknown" without git."""
    command = ["git", "-C", str(ROOT), "describe", "--always", "--dirty", "--match=", "--abbrev=7"]
    try:
        found = subprocess.run(command, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return found.stdout.strip()


class OutOfTime(Exception):
    """The piece has used its time. All that was computed is kept."""


class Deadline:
    """`minutes`: from now; None for no end."""

    def __init__(self, minutes):
        self._end = None if minutes is None else time.monotonic() + 60 * minutes

    def check(self):
        """Raises OutOfTime once the time is over."""
        if self._end is not None and time.monotonic() >= self._end:
            raise OutOfTime
