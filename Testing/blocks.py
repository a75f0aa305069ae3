#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Each block of code on the pages is run by a test, or has a reason why not. This names the test or
the reason for each, and fails at a block that is in neither list, at a row without a block, and at
a test that is gone, that ctest does not run, or that does not read what it is to run."""
import ast
import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "Examples/README.md",
         *sorted((ROOT / "Documentation").rglob("*.md"))]

#: Tests are file::function of Python, file::name of ctest, script::stage, or a script.
OF_PAGES = "Testing/ParaView/pages.py"
OF_README = "Testing/ParaView/readme.py::test_pvpython_example"
OF_INSTALL = "Testing/Install/CMakeLists.txt"
HOW_TOS = (OF_PAGES + "::test_pages", "in howto_pictures.pages()")

#: Pages, language of the block, the test that runs it, and how this reads it.
FENCED = (
    (r"README\.md", "python", OF_README, "README.read_text"),
    (r"Documentation/HowTo/\w+\.md", "python3?|bash", *HOW_TOS),
    (r"Documentation/HowTo/MorphFromNumPy\.md", "py",
     "Testing/Install/installed_python.py::test_documented_example", "HowTo/MorphFromNumPy.md"),
    (r"Documentation/HowTo/WriteYourOwnMethod\.md", r"c\+\+",
     OF_PAGES + "::test_cxx_is_that_of_the_example", "HowTo/WriteYourOwnMethod.md"),
    (r"Documentation/SolverFiles\.md", "py", OF_PAGES + "::test_solver_file",
     'PAGES["SolverFiles.md"]'),
    (r"Documentation/\w+\.md", "py", OF_PAGES + "::run_page", "in enumerate(PAGES[page]"),
    (r"Documentation/API\.md", r"c\+\+|cmake", OF_INSTALL + "::install.ApiExample",
     "Documentation/API.md"),
)

#: A command of an indented block, the test that runs it, and how this reads or has it.
COMMANDS = (
    (r"build/paraview/bin/morph-mesh ", OF_README, "build/paraview/(bin/morph-mesh.*)"),
    (r"export PV_PLUGIN_PATH=", OF_PAGES + "::test_paraview_loads_the_plugin_by_its_folder",
     '"Install.md", "export PV_PLUGIN_PATH"'),
    (r"cmake --install build/paraview --component plugin ",
     OF_PAGES + "::test_the_plugin_is_installed_alone", "--component plugin"),
    (r"pvpython Utilities/study\.py --report", OF_PAGES + "::test_the_study_s_report",
     "Utilities/study.py --report"),
    (r"mkdir -p build/howto|ln -sfn|cp -r \.\./|export PATH=\$PWD/build/paraview/bin"
     r"|(xvfb-run .*)?pvpython .*task\.py", OF_PAGES + "::test_pages", "howto_pictures.run("),
    (r"cmake --install build/paraview --prefix ", OF_INSTALL + "::install.Install",
     "Install.cmake"),
    (r"cmake (-S Examples|--build build/examples)|export PATH=\$PWD/build/examples",
     OF_INSTALL + "::install.Examples", "/Examples"),
    (r"(morph-mesh .*|cp -r )\bcase\b",
     "Testing/Programs/openfoam_cases.py::test_the_commands_of_the_page", "SolverFiles.md"),
    (r"morph-mesh ", OF_PAGES + "::test_commands", "commands_of(page)"),
    (r"Data/generate\.py pipe --kind hex", "Testing/ParaView/models_small.py::setUpClass",
     '"pipe", "--kind", "hex"'),
    (r"pvpython Utilities/study\.py --quick", "Testing/ParaView/steps_and_study.py::run_study",
     '"--quick"'),
    (r"pip wheel |env/bin/pip install", "Testing/Python/wheel.py::main", '"wheel"'),
    (r"morphed = mm\.morph\(", "Testing/Install/python_morph.py::test_it_is_the_filter",
     "mm.morph(self.grid, surface)"),
    (r"Utilities/plain-vtk\.sh", "Utilities/test-stages.sh::plainvtk", "Utilities/plain-vtk.sh"),
    (r"Utilities/package\.sh", "Utilities/test-stages.sh::package", "Utilities/package.sh"),
    (r"Utilities/build\.sh", "Utilities/test.sh", "Utilities/build.sh"),
    (r"Utilities/test\.sh", "Utilities/other-debian.sh", "Utilities/test.sh"),
    (r"cmake --preset paraview", "Utilities/build.sh", "cmake --preset paraview"),
)

#: A command that no test runs, and why.
NOT_RUN = (
    (r"(Utilities/install-packages\.sh|sudo apt install) ", "it changes the system's packages"),
    (r"Utilities/build-for\.sh ", "it needs another ParaView than the machine has"),
    (r"cmake --preset vtk", "it needs another VTK than the machine has"),
    (r"ctest --preset paraview", "a test does not run the tests"),
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


def source_of(test):
    """What a test of the tables consists of; empty if it is not there."""
    file, _, name = test.partition("::")
    text = (ROOT / file).read_text(encoding="utf-8")
    if file.endswith(".py"):
        return "".join(ast.get_source_segment(text, node) for node in ast.walk(ast.parse(text))
                       if isinstance(node, ast.FunctionDef) and node.name == name)
    if file.endswith("CMakeLists.txt"):
        pattern = rf"^add_test\(NAME {re.escape(name)}\s.*?\)\n"
    else:  # a shell script, without what its usage says
        text = re.sub(r"<<END\n.*?^END$|^\s*#[^\n]*", "", text, flags=re.MULTILINE | re.DOTALL)
        pattern = rf"^    {name}\).*?;;" if name else r".*"
    return "".join(re.findall(pattern, text, re.MULTILINE | re.DOTALL))


class Blocks(unittest.TestCase):
    def test_each_is_run_or_has_a_reason(self):
        used = set()
        for page in PAGES:
            for row, text in rows_of(page):
                with self.subTest(page=page.name, block=text):
                    self.assertIsNotNone(row, "no test and no reason")
                used.add(row)
        self.assertEqual({*FENCED, *COMMANDS, *NOT_RUN} - used, set())

    def test_the_tests_read_them(self):
        for *_, test, text in (*FENCED, *COMMANDS):
            with self.subTest(test=test):
                self.assertIn(text, source_of(test))

    def test_ctest_runs_the_files_of_python(self):
        listed = "".join(path.read_text(encoding="utf-8")
                         for path in (ROOT / "Testing").rglob("CMakeLists.txt"))
        for file in {row[-2].partition("::")[0] for row in (*FENCED, *COMMANDS)}:
            if file.endswith(".py"):
                self.assertRegex(listed, rf"(?m)^[^#\n]*\b{re.escape(Path(file).name)}")


if __name__ == "__main__":
    unittest.main()
