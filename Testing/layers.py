#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Holds every #include in Filters against the arrows that Filters/layers.txt allows.

Usage: layers.py [--source FOLDER] [--write] [--try-wrong-includes]
It fails, and names file and line, for an include that no arrow allows, a file in a folder that the
table does not have, a header that does not exist, a folder without a README.md of at most ten
lines, and arrows in a circle. It also fails where the picture in CONTRIBUTING.md, or a README's
last line, is not what the table says, and where the headers at the top of Filters/Morphing are not
those of its public classes, or name what is private. And where any C++ file of the project but
Version.h asks for the release of VTK or ParaView.
  --source FOLDER        the project (default: where this script lies)
  --write                writes the picture into CONTRIBUTING.md, and each README.md's last line
  --try-wrong-includes   shows that each kind of wrong include is found, in a copy of Filters
"""
import argparse
import os
import re
import shutil
import sys
import tempfile

LIBRARIES = {
    "CGAL": r"CGAL/",
    "CGNS": r"cgns",
    "Eigen": r"(unsupported/)?Eigen/",
    "MPI": r"mpi\.h$",
    "ParaView": r"(vtkSM([^P]|P[a-z]|PV)|vtkPV|vtkSI|pq)",
    "fast_float": r"fast_float/",
    "fmt": r"fmt/",
    "hypre": r"(HYPRE|_hypre)",
    "nanoflann": r"nanoflann",
    "netCDF": r"netcdf(_mem)?\.h$",
    "zlib": r"zlib\.h$",
    "VTK": r"vtk",
}
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(["<])([^">]+)[">]')
VERSION = re.compile(r"\b(VTK_(VERSION|MAJOR_VERSION|MINOR_VERSION|BUILD_VERSION)"
                     r"|PARAVIEW_VERSION)(_\w+)?\b")
#: The one header that holds what differs between releases.
VERSION_HEADER = "Filters/Morphing/Private/Data/Version.h"
BEGIN = "<!-- Testing/layers.py --write draws this from Filters/layers.txt. -->\n"
END = "<!-- End of the picture. -->\n"


class Table:
    def __init__(self, source):
        self.filters = os.path.join(source, "Filters")
        self.arrows = {}
        self.problems = []
        common = []
        with open(os.path.join(self.filters, "layers.txt"), encoding="utf-8") as lines:
            for line in lines:
                line = line.split("#")[0].strip()
                if not line:
                    continue
                folder, names = (part.strip() for part in line.split(":"))
                if folder.endswith("/*"):
                    common.append((folder[:-1], names.split()))
                    continue
                self.arrows[folder] = [self.resolve(folder, name) for name in names.split()]
        for folder, names in common:
            for row in self.arrows:
                if row.startswith(folder):
                    self.arrows[row] += [self.resolve(row, name) for name in names]

    def resolve(self, folder, name):
        """The row, the group of rows or the library that `name` means in the row of `folder`."""
        sibling = os.path.join(os.path.dirname(folder), name)
        for candidate in (sibling, name):
            if candidate in self.arrows or any(row.startswith(candidate + "/")
                                               for row in self.arrows):
                return candidate
        if name not in LIBRARIES:
            self.problems.append(
                "layers.txt: %s may include %s, which is neither a library nor a row above it"
                % (folder, name))
        return name

    def row(self, file):
        """The row of a file, named from Filters: its own, or that of its folder."""
        return file if file in self.arrows else os.path.dirname(file)

    def allows(self, row, target):
        if row == target:
            return True
        return any(target == name or target.startswith(name + "/") for name in self.arrows[row])


def sources(folder):
    for where, folders, files in os.walk(folder):
        folders.sort()
        for file in sorted(files):
            if file.endswith((".h", ".cxx")):
                yield os.path.relpath(os.path.join(where, file), folder)


def quoted(filters, file, name):
    """The file, named from Filters, that #include "name" means in `file`; None where there is
    none."""
    library = file.split(os.sep)[0]
    for candidate in (os.path.join(os.path.dirname(file), name) if "/" not in name else "",
                      os.path.join(library, name), os.path.join("Core", name), name):
        # A header of a filter may be made from a template.
        for ending in ("", ".in"):
            if candidate and os.path.isfile(os.path.join(filters, candidate + ending)):
                return candidate
    return None


def check_includes(table):
    for file in sources(table.filters):
        row = table.row(file)
        if row not in table.arrows:
            table.problems.append("Filters/%s: its folder is no row of Filters/layers.txt" % file)
            continue
        with open(os.path.join(table.filters, file), encoding="utf-8") as lines:
            for number, line in enumerate(lines, 1):
                match = INCLUDE.match(line)
                if not match:
                    continue
                bracket, name = match.groups()
                where = "Filters/%s:%d" % (file, number)
                if bracket == '"' and (name.endswith("Module.h") or name == "Private/Options.h"):
                    continue  # VTK and cmake/properties.py make them
                if bracket == '"':
                    target = quoted(table.filters, file, name)
                    if not target:
                        table.problems.append('%s: there is no "%s"' % (where, name))
                        continue
                    if file.startswith("Core") and "/" not in name:
                        table.problems.append('%s: "%s" lacks its folder' % (where, name))
                    target = table.row(target)
                else:
                    target = next((library for library, pattern in LIBRARIES.items()
                                   if re.match(pattern, name)), None)
                if target and not table.allows(row, target):
                    table.problems.append("%s: %s may not include %s (%s)"
                                          % (where, row, target, name))


def may_include(table, row):
    """The last line of a folder's README.md."""
    names = []
    for name in table.arrows[row]:
        if os.path.dirname(name) == row:
            continue
        common = os.path.commonpath([name, row])
        names.append(name[len(common) + 1:] if common and name != common else name)
    return "May include: %s.\n" % ", ".join(names or ["nothing"])


def check_readmes(table, write):
    for row in table.arrows:
        folder = os.path.join(table.filters, row)
        if row.endswith(".h"):
            continue
        readme = os.path.join(folder, "README.md")
        if not os.path.isfile(readme):
            table.problems.append("Filters/%s has no README.md" % row)
            continue
        with open(readme, encoding="utf-8") as text:
            lines = text.readlines()
        if len(lines) > 10:
            table.problems.append("Filters/%s/README.md has more than ten lines" % row)
        if lines[-1] != may_include(table, row):
            if write:
                with open(readme, "w", encoding="utf-8") as text:
                    text.writelines(lines[:-1] + [may_include(table, row)])
            else:
                table.problems.append(
                    "Filters/%s/README.md: its last line is not what Filters/layers.txt "
                    "says: run Testing/layers.py --write" % row)
        if sum(file.endswith((".h", ".cxx")) for file in os.listdir(folder)) < 2:
            table.problems.append("Filters/%s holds fewer than two sources" % row)


def check_classes(table):
    """Checks that the headers at the top of Filters/Morphing are those of the classes that its
    CMakeLists.txt lists, and that they name nothing of namespace morph::filters."""
    folder = os.path.join(table.filters, "Morphing")
    with open(os.path.join(folder, "CMakeLists.txt"), encoding="utf-8") as f:
        classes = set(re.search(r"set\(classes\s([^)]*)\)", f.read()).group(1).split())
    # A header with properties is made from a template, vtkX.h.in.
    headers = {file.split(".")[0]: file for file in os.listdir(folder)
               if file.endswith((".h", ".h.in"))}
    for name in sorted(classes ^ headers.keys()):
        table.problems.append("Filters/Morphing/%s.h: %s" % (
            name, "no public class of CMakeLists.txt: move it to Private" if name in headers
            else "it is listed, but not there"))
    for name in sorted(headers):
        with open(os.path.join(folder, headers[name]), encoding="utf-8") as lines:
            for number, line in enumerate(lines, 1):
                if re.search(r"\bfilters::|\bnamespace (morph::)?filters\b", line):
                    table.problems.append("Filters/Morphing/%s:%d: a public header names what "
                                          "is private" % (headers[name], number))


def check_versions(table, source):
    """Checks that VERSION_HEADER alone tests the release of VTK or ParaView."""
    for top in ("Examples", "Filters", "Plugin", "Programs", "Testing"):
        folder = os.path.join(source, top)
        for file in sources(folder):
            name = os.path.join(top, file)
            if name == VERSION_HEADER:
                continue
            with open(os.path.join(folder, file), encoding="utf-8") as lines:
                for number, line in enumerate(lines, 1):
                    match = VERSION.search(line)
                    if match:
                        table.problems.append("%s:%d: %s belongs in %s"
                                              % (name, number, match.group(), VERSION_HEADER))


def picture(table):
    rows = [row for row in table.arrows if not row.endswith(".h")]
    width = max(len(row) for row in rows) + 5
    lines = [" " * width + " ".join("%2d" % number for number in range(1, len(rows) + 1))]
    for number, row in enumerate(rows, 1):
        marks = []
        for other in rows[:number - 1]:
            marks.append(" x" if table.allows(row, other) else " .")
        libraries = sorted(name for name in table.arrows[row] if name in LIBRARIES)
        line = "%2d %-*s" % (number, width - 3, row) + " ".join(marks + [" \\"])
        lines.append("%-*s  %s" % (width + 3 * len(rows) - 1, line, " ".join(libraries)))
    return BEGIN + "\n" + "".join("    %s\n" % line.rstrip() for line in lines) + "\n" + END


def check_picture(table, source, write):
    file = os.path.join(source, "CONTRIBUTING.md")
    with open(file, encoding="utf-8") as f:
        text = f.read()
    if text.count(BEGIN) != 1 or text.count(END) != 1:
        table.problems.append("CONTRIBUTING.md has no place for the picture")
        return
    before, rest = text.split(BEGIN)
    drawn = before + picture(table) + rest.split(END)[1]
    if drawn == text:
        return
    if write:
        with open(file, "w", encoding="utf-8") as f:
            f.write(drawn)
    else:
        table.problems.append(
            "CONTRIBUTING.md: the picture is not that of Filters/layers.txt: "
            "run Testing/layers.py --write")


def check(source, write=False):
    table = Table(source)
    check_includes(table)
    check_readmes(table, write)
    check_classes(table)
    check_versions(table, source)
    check_picture(table, source, write)
    return table.problems


def try_wrong_includes(source):
    """What must be found in a copy with one line more, and where."""
    wrong = {
        "upwards": ("Core/Support/Error.h", '#include "Mesh/Mesh.h"',
                    "Core/Support may not include Core/Mesh"),
        "sideways": ("Core/Solvers/Multigrid.h", '#include "Geometry/Delaunay.h"',
                     "Core/Solvers may not include Core/Geometry"),
        "VTK in the core": ("Core/Mesh/Mesh.cxx", "#include <vtkPoints.h>",
                            "Core/Mesh may not include VTK"),
        "ParaView in the filters": ("Morphing/vtkMorphAlgorithm.cxx", "#include <vtkSMProxy.h>",
                                    "Morphing may not include ParaView"),
        "CGAL outside its folder": ("Core/Mesh/Mesh.cxx", "#include <CGAL/Epick_d.h>",
                                    "Core/Mesh may not include CGAL"),
        "no folder": ("Core/Mesh/Mesh.cxx", '#include "Mesh.h"', 'lacks its folder'),
        "no such header": ("Core/Mesh/Mesh.cxx", '#include "Mesh/Nothing.h"',
                           'there is no "Mesh/Nothing.h"'),
        "private parts of each other": ("Morphing/Private/Data/Output.cxx",
                                        '#include "Private/Morph/KeptMesh.h"',
                                        "Morphing/Private/Data may not include "
                                        "Morphing/Private/Morph"),
        "a private header at the top": ("Morphing/vtkMorphStray.h", "", "no public class"),
        "a private name at the top": ("Morphing/vtkMorphAdjoint.h.in",
                                      "namespace morph::filters {}",
                                      "names what is private"),
        "a release": ("Morphing/vtkMorphMesh.cxx", "#if VTK_VERSION_NUMBER >= 0\n#endif",
                      "VTK_VERSION_NUMBER belongs in"),
        "a release of ParaView": ("Core/Mesh/Mesh.cxx", "// PARAVIEW_VERSION_MAJOR",
                                  "PARAVIEW_VERSION_MAJOR belongs in"),
        "a file in no folder": ("Core/Stray.h", "#pragma once", "its folder is no row"),
    }
    missed = []
    with tempfile.TemporaryDirectory() as copy:
        shutil.copytree(os.path.join(source, "Filters"), os.path.join(copy, "Filters"))
        shutil.copy(os.path.join(source, "CONTRIBUTING.md"), copy)
        if check(copy):
            return ["The copy has problems before anything is changed."]
        for what, (file, line, expected) in wrong.items():
            name = os.path.join(copy, "Filters", file)
            before = None
            if os.path.exists(name):
                with open(name, encoding="utf-8") as f:
                    before = f.read()
            with open(name, "w", encoding="utf-8") as f:
                f.write((before or "") + line + "\n")
            found = check(copy)
            if len(found) != 1 or expected not in found[0] or "Filters/" + file not in found[0]:
                missed.append("%s: expected '%s', found %s" % (what, expected, found))
            if before is None:
                os.remove(name)
            else:
                with open(name, "w", encoding="utf-8") as f:
                    f.write(before)
    return missed


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--source", default=os.path.join(os.path.dirname(__file__), ".."))
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--try-wrong-includes", action="store_true")
    arguments = parser.parse_args()
    if arguments.try_wrong_includes:
        problems = try_wrong_includes(arguments.source)
    else:
        problems = check(arguments.source, arguments.write)
    for problem in problems:
        print(problem, file=sys.stderr)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
