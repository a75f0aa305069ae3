# SPDX-License-Identifier: BSD-3-Clause
"""What lets the study run in pieces: the state of the sources that a row comes from, and an end of
the time that a piece has."""

import subprocess
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


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
