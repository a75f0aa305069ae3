# SPDX-License-Identifier: BSD-3-Clause
"""Runs the code of each page in Documentation/HowTo as it stands, in a folder that the commands of
README.md there make, and keeps the pictures that the pages make.

    xvfb-run -a -s "-noreset -screen 0 1280x1024x24" \\
        python3 Utilities/howto_pictures.py [--plugin MeshMorphing.so] [--page NAME] [folder]

Blocks marked python run in one pvpython, those marked python3 in Debian's Python with the built
package meshmorphing, and those marked bash by bash, which stops at the first command that fails.
Writes howto-*.png into Documentation/images, or the folder given. Needs the built plugin,
morph-mesh and ImageMagick. A page that fails ends this program."""
import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from itertools import groupby
from pathlib import Path

from picture_arguments import fewer_colors

ROOT = Path(__file__).resolve().parent.parent
PAGES = ROOT / "Documentation/HowTo"
PYTHON = "/usr/bin/python3"  # for which Debian's packages and the package for NumPy are built
BLOCK = re.compile(r"^```(python3?|bash)\n(.*?)^```", re.MULTILINE | re.DOTALL)
#: Programs that a page runs, modules of Python, and libraries of the plugin, that may be missing.
NEEDS = {"CalculixAndScipy": ("ccx",),
         "MorphFromNumPy": ("import meshio", "import meshmorphing"),
         "MorphAFoamCase": ("blockMesh", "icoFoam", "checkMesh"),
         "MorphOnMpiRanks": ("mpiexec", "libHYPRE"),
         "WriteYourOwnMethod": ("own-method",)}  # built by the test install.Examples


def blocks(page):
    """What a page runs: (language, code). Neighbors of one language are one."""
    found = BLOCK.findall((PAGES / f"{page}.md").read_text(encoding="utf-8"))
    return [(language, "\n".join(code for _, code in group))
            for language, group in groupby(found, key=lambda block: block[0])]


def pages():
    """The names of the pages with code to run."""
    return [page.stem for page in sorted(PAGES.glob("*.md")) if blocks(page.stem)]


def pictures(page):
    """The names of the files that a page makes and shows."""
    text = (PAGES / f"{page}.md").read_text(encoding="utf-8")
    return re.findall(r"images/howto-([\w-]+\.png)", text)


def environment(plugin):
    """That of the commands: PATH has the programs that are built with the plugin, morph-mesh and
    the examples, PYTHONPATH the package for NumPy."""
    build = build_folder(plugin)
    # This may be a process of MPI itself, run by root, on a machine of few processors.
    found = {name: value for name, value in os.environ.items()
             if not name.startswith(("OMPI_", "PMIX_", "ORTE_", "OPAL_"))}
    found.update(PATH=f"{build}/bin:{build}/installed-examples:{os.environ['PATH']}",
                 PYTHONPATH=":".join(map(str, build.glob("lib/python3*/*-packages"))),
                 OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                 OMPI_MCA_rmaps_base_oversubscribe="1")
    return found


def build_folder(plugin):
    return next(folder for folder in Path(plugin).parents if folder.name == "lib").parent


def expected(page):
    """What a page says that its code prints: patterns, in which ... stands for any characters."""
    text = re.sub(r"^```.*?^```", "", (PAGES / f"{page}.md").read_text(encoding="utf-8"),
                  flags=re.MULTILINE | re.DOTALL)
    found = []
    for sentence in re.findall(r"\bprints\b.*?(?:\.(?=\s+[A-Z]|\n\n)|:\n\n(?: {4}[^\n]*\n)+)", text,
                               re.DOTALL):
        found += re.findall(r"^ {4}(.*)$|`([^`]+)`", sentence, re.MULTILINE)
    return [re.escape(" ".join((one or other).split())).replace(r"\.\.\.", r"\S*")
            for one, other in found]


def missing(page, plugin):
    """What a page needs that is not there."""
    def there(name):
        if name.startswith("lib"):
            return name.encode() in Path(plugin).read_bytes()
        if name.startswith("import "):
            return subprocess.run([PYTHON, "-c", name], env=environment(plugin),
                                  capture_output=True, check=False).returncode == 0
        return shutil.which(name, path=environment(plugin)["PATH"])
    return [name for name in NEEDS.get(page, ()) if not there(name)]


def run(page, plugin, images):
    """Runs a page, and copies its pictures to the folder `images`. Returns their paths, and what
    the page has printed."""
    commands = {"python": "pvpython --force-offscreen-rendering page.py",
                "python3": f"{PYTHON} page.py", "bash": "bash -e -o pipefail page.sh"}
    with tempfile.TemporaryDirectory() as name:
        # A project's folder, in which the folder of the how-tos is made as their first page says.
        project = Path(name)
        (project / "build").mkdir()
        (project / "build/paraview").symlink_to(build_folder(plugin))
        for folder in "Data", "Examples":
            (project / folder).symlink_to(ROOT / folder)
        printed = ""
        for number, (language, code) in enumerate(blocks(page)):
            folder = project / "build/howto"
            command = commands[language]
            folder.mkdir(exist_ok=True)
            (folder / command.split()[-1]).write_text(code, encoding="utf-8")
            done = subprocess.run(["bash", "-e", "-c", f"{setup()}\n{command}"], cwd=project,
                                  env=environment(plugin), capture_output=True, text=True,
                                  check=False)
            if done.returncode != 0:
                raise RuntimeError(f"{page}.md, part {number + 1}: {done.stdout}{done.stderr}")
            printed += done.stdout
        return [shutil.copy(folder / picture, Path(images) / f"howto-{picture}")
                for picture in pictures(page)], printed


def setup():
    """The commands that make the folder in which the pages run."""
    text = (PAGES / "README.md").read_text(encoding="utf-8")
    lines = re.search(r"(?<=\n\n)(?: {4}.*\n)+", text)[0]
    return re.sub(r"^ {4}", "", lines, flags=re.MULTILINE)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--plugin", type=Path)
    parser.add_argument("--page", action="append", help="this page alone; may be repeated")
    parser.add_argument("folder", nargs="?", default=ROOT / "Documentation/images")
    options = parser.parse_args()
    plugin = options.plugin or next((ROOT / "build/paraview/lib").glob("**/MeshMorphing.so"), None)
    if not plugin:
        sys.exit("There is no plugin: build it, by Utilities/demo.sh for one, or use --plugin.")
    plugin = plugin.resolve()
    for page in options.page or pages():
        if missing(page, plugin):
            print(f"{page}.md left out, there is no {', '.join(missing(page, plugin))}")
            continue
        for path in run(page, plugin, options.folder)[0]:
            fewer_colors(path)
            print(path)


if __name__ == "__main__":
    main()
