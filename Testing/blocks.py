#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Each block of code on the pages is run by a test, or has a reason why not. This names the test or
the reason for each, and fails at a block that is in neither list, and at a row without a block."""
import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "Examples/README.md",
         *sorted((ROOT / "Documentation").rglob("*.md"))]
HOW_TOS = ("Testing/ParaView/pages.py", "howto_pictures.run(")

#: Pages, language of the block, the test that runs it, and what this has.
FENCED = (
    (r"README\.md", "python", "Testing/ParaView/readme.py", "test_pvpython_example"),
    (r"Documentation/HowTo/\w+\.md", "python3?|bash", *HOW_TOS),
    (r"Documentation/HowTo/MorphFromNumPy\.md", "py", "Testing/Install/installed_python.py",
     "HowTo/MorphFromNumPy.md"),
    (r"Documentation/HowTo/WriteYourOwnMethod\.md", r"c\+\+", "Testing/ParaView/pages.py",
     "test_cxx_is_that_of_the_example"),
    (r"Documentation/\w+\.md", "py", "Testing/ParaView/pages.py", "exec(compile(block"),
    (r"Documentation/API\.md", r"c\+\+|cmake", "Testing/Install/CMakeLists.txt",
     "ApiExample.cmake"),
)

#: A command of an indented block, the test that runs it, and what this has.
COMMANDS = (
    (r"build/paraview/bin/morph-mesh ", "Testing/ParaView/readme.py", "bin/morph-mesh"),
    (r"export PV_PLUGIN_PATH=", "Testing/ParaView/pages.py", "export PV_PLUGIN_PATH"),
    (r"cmake --install build/paraview --component plugin ", "Testing/ParaView/pages.py",
     "--component plugin"),
    (r"pvpython Utilities/study\.py --report", "Testing/ParaView/pages.py", "--report"),
    (r"(mkdir -p build/howto|ln -sfn|cp -r \.\./|export PATH=\$PWD/build/paraview/bin)",
     "Utilities/howto_pictures.py", "setup()"),
    (r"(xvfb-run .*)?pvpython .*task\.py", "Utilities/howto_pictures.py",
     "pvpython --force-offscreen-rendering page.py"),
    (r"cmake --install build/paraview --prefix ", "Testing/Install/Install.cmake", "--install"),
    (r"cmake (-S Examples|--build build/examples)|export PATH=\$PWD/build/examples",
     "Testing/Install/CMakeLists.txt", "NAME install.Examples"),
    (r"(morph-mesh .*|cp -r )\bcase\b", "Testing/Programs/openfoam_cases.py",
     "test_the_commands_of_the_page"),
    (r"morph-mesh ", "Testing/ParaView/pages.py", "def test_commands"),
    (r"Data/generate\.py pipe --kind hex", "Testing/ParaView/models_small.py",
     '"pipe", "--kind", "hex"'),
    (r"pvpython Utilities/study\.py --quick", "Testing/ParaView/steps_and_study.py", '"--quick"'),
    (r"pip wheel |env/bin/pip install", "Testing/Python/wheel.py", '"wheel"'),
    (r"morphed = mm\.morph\(", "Testing/Install/python_morph.py", "mm.morph(self.grid, surface)"),
    (r"Utilities/plain-vtk\.sh|cmake --preset vtk", "Utilities/test-stages.sh",
     "Utilities/plain-vtk.sh"),
    (r"Utilities/package\.sh", "Utilities/test-stages.sh", "Utilities/package.sh"),
    (r"Utilities/build\.sh", "Utilities/test.sh", "Utilities/build.sh"),
    (r"Utilities/test\.sh", "Utilities/other-debian.sh", "Utilities/test.sh"),
    (r"(cmake|ctest) --preset paraview", "Utilities/test.sh", "ctest"),
)

#: A command that no test runs, and why.
NOT_RUN = (
    (r"(Utilities/install-packages\.sh|sudo apt install) ", "it changes the system's packages"),
    (r"Utilities/build-for\.sh ", "it needs another ParaView than the machine has"),
    (r"Utilities/study\.sh|pvpython Utilities/study\.py --models", "many hours, or one"),
    (r"pvpython Utilities/study_checks\.py", "an hour; figures.py compares what it has printed"),
    (r"Data/generate\.py +#", "minutes of Gmsh; a slow test makes the same meshes"),
)
#: What is no command: what a command prints, and formulas.
NO_COMMAND = re.compile(r"[-\d ]|[A-Z][\w-]* |max sum|t D ln|inverted|collapsed|minimum|mean|worst"
                        r"|True ")


def fenced(text):
    return re.findall(r"^```(\S*)\n.*?^```", text, re.MULTILINE | re.DOTALL)


def commands(text):
    """Of the indented blocks, a line each."""
    text = re.sub(r"^```.*?^```|<!--.*-->", "", text, flags=re.MULTILINE | re.DOTALL)
    for block in re.findall(r"(?<=\n\n)(?: {4}.*\n)+", text):
        for line in re.sub(r"\\\n +", "", re.sub("^ {4}", "", block, flags=re.M)).splitlines():
            yield line


def rows_of(page):
    """What the page has: (its row or None, text)."""
    text = page.read_text(encoding="utf-8")
    name = page.relative_to(ROOT).as_posix()
    for language in fenced(text):
        yield next((row for row in FENCED if re.fullmatch(row[0], name)
                    and re.fullmatch(row[1], language)), None), language
    if page.name == "Tutorial.md":
        return  # items of a list
    for line in commands(text):
        row = next((row for row in (*COMMANDS, *NOT_RUN) if re.match(row[0], line)), None)
        if row or not NO_COMMAND.match(line):
            yield row, line


class Blocks(unittest.TestCase):
    def test_each_is_run_or_has_a_reason(self):
        used = set()
        for page in PAGES:
            for row, text in rows_of(page):
                with self.subTest(page=page.name, block=text):
                    self.assertIsNotNone(row, "no test and no reason")
                used.add(row)
        self.assertEqual({*FENCED, *COMMANDS, *NOT_RUN} - used, set())

    def test_the_tests_have_them(self):
        for *_, file, text in (*FENCED, *COMMANDS):
            self.assertIn(text, (ROOT / file).read_text(encoding="utf-8"), file)
        listed = "".join(path.read_text(encoding="utf-8") for path in (
            *(ROOT / "Testing").rglob("CMakeLists.txt"), ROOT / "Utilities/test-stages.sh"))
        for file in {row[-2] for row in (*FENCED, *COMMANDS)}:
            if file.startswith("Testing/") and file.endswith(".py"):
                self.assertIn(Path(file).name, listed)


if __name__ == "__main__":
    unittest.main()
