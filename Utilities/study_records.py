# SPDX-License-Identifier: BSD-3-Clause
"""The study's results in a CSV file, a row for each step of each series. Rows are written as they
come, so that a study can be interrupted and resumed."""

import csv
from typing import NamedTuple


class Series(NamedTuple):
    """One line of a figure. kind: "hex" or "tet"; surfaces: "weighted residual", as in the paper,
    or "exact"; stepping: "absolute" or "relative"."""

    model: str
    kind: str
    surfaces: str
    stepping: str
    method: str

    def __str__(self):
        return f"{self.model} {self.kind}, {self.surfaces} surfaces, {self.stepping}, {self.method}"


class Step(NamedTuple):
    """The result of one step. minimum, mean: scaled Jacobian. inverted: cells at or below 0, the
    degenerate ones included; boundary: of these, the cells that the boundary inverts by itself, at
    a corner whose four nodes are all prescribed; folded: of the others, the cells with a folded
    boundary face. The remaining cells are the method's own. cells: ids of the first of these.
    commit: of the sources."""

    step: int
    t: float
    minimum: float
    mean: float
    inverted: int
    boundary: int
    folded: int
    cells: str
    commit: str

    @property
    def own(self):
        """How many cells the method has inverted though the boundary lets them be valid."""
        return self.inverted - self.boundary - self.folded

    @property
    def valid(self):
        """No cell is inverted but those that the boundary takes with it."""
        return self.own == 0


class RowFile:
    """A CSV file that grows by a row at a time.

    It is made with its head unless it is there; a last row that an interruption has cut off is
    dropped. Raises ValueError for a file with another head."""

    def __init__(self, path, fields):
        self._path = path
        text = path.read_text(encoding="utf-8") if path.is_file() else ""
        head = ",".join(fields) + "\n"
        whole = text[:text.rfind("\n") + 1] or head
        if not whole.startswith(head):
            raise ValueError(f"{path} has other columns than {', '.join(fields)}: "
                             "give another folder, or move it away")
        if whole != text:
            path.write_text(whole, encoding="utf-8")

    def rows(self):
        """As dictionaries of texts."""
        with open(self._path, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def add(self, row):
        with open(self._path, "a", newline="", encoding="utf-8") as file:
            csv.writer(file, lineterminator="\n").writerow(row)


class Records:
    """`path`: of the CSV file; read if it is there, and appended to."""

    def __init__(self, path):
        self._file = RowFile(path, Series._fields + Step._fields)
        self._steps = {}
        for row in self._file.rows():
            self._take(row)

    def _take(self, row):
        series = Series(*(row[field] for field in Series._fields))
        self._put(series, Step(*(kind(row[field]) for field, kind in Step.__annotations__.items())))

    def _put(self, series, step):
        """The rows of one commit take the place of another's."""
        found = self._steps.setdefault(series, {})
        if any(other.commit != step.commit for other in found.values()):
            found.clear()
        found[step.step] = step

    def add(self, series, step):
        self._file.add(series + step)
        self._put(series, step)

    def steps(self, series, commit=None):
        """Its Steps so far, in order; up to the first that is missing. With a commit, only what
        comes from there."""
        found = self._steps.get(series, {})
        steps = []
        while len(steps) in found and commit in (None, found[len(steps)].commit):
            steps.append(found[len(steps)])
        return steps

    def series(self):
        """All series with a result."""
        return list(self._steps)


def last_valid(steps):
    """t*: the t of the last step up to which all are valid; None where the first is not, or there
    is none."""
    result = None
    for step in steps:
        if not step.valid:
            break
        result = step.t
    return result
