# SPDX-License-Identifier: BSD-3-Clause
"""Runs the code of each page in Documentation/HowTo, in a folder of its own with the small models
and the folders of Examples, and keeps the pictures that the pages make.

    xvfb-run -a -s "-noreset -screen 0 1280x1024x24" \\
        python3 Utilities/howto_pictures.py [--plugin MeshMorphing.so] [--page NAME] [folder]

Blocks marked python run in one pvpython; those marked bash run by bash, which stops at the first
command that fails. Writes howto-*.png into Documentation/images, or the folder given. Needs the
built plugin, morph-mesh and ImageMagick. A page that fails ends this program."""
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
MODELS = ROOT / "Data/Models/small"
EXAMPLES = ROOT / "Examples"
BLOCK = re.compile(r"^```(python|bash)\n(.*?)^```", re.MULTILINE | re.DOTALL)
#: Programs that a page runs, and libraries of the plugin, that may be missing.
NEEDS = {"CalculixAndScipy": ("ccx",),
         "MorphAFoamCase": ("blockMesh", "icoFoam", "checkMesh"),
         "MorphOnMpiRanks": ("mpiexec", "libHYPRE"),
         "WriteYourOwnMethod": ("own-method",)}  # built by the test install.Examples


def blocks(page, plugin):
    """What a page runs, with this plugin: (language, code). Neighbors of one language are one."""
    found = BLOCK.findall((PAGES / f"{page}.md").read_text(encoding="utf-8"))
    return [(language, re.sub(r'glob\("build/.*?\)\[0\]', lambda _: repr(str(plugin)),
                              "\n".join(code for _, code in group)))
            for language, group in groupby(found, key=lambda block: block[0])]


def pages():
    """The names of the pages with code to run."""
    return [page.stem for page in sorted(PAGES.glob("*.md")) if blocks(page.stem, "")]


def search_path(plugin):
    """PATH with the programs that are built with the plugin, morph-mesh and the examples."""
    build = next(folder for folder in Path(plugin).parents if folder.name == "lib").parent
    return f"{build}/bin:{build}/installed-examples:{os.environ['PATH']}"


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
    linked = Path(plugin).read_bytes() if page in NEEDS else b""
    return [name for name in NEEDS.get(page, ())
            if not (name.encode() in linked if name.startswith("lib")
                    else shutil.which(name, path=search_path(plugin)))]


def run(page, plugin, images):
    """Runs a page, and copies its picture to the folder `images`; returns its path, and what the
    page has printed."""
    text = (PAGES / f"{page}.md").read_text(encoding="utf-8")
    picture = re.search(r"images/howto-([\w-]+\.png)", text).group(1)
    # This may be a process of MPI itself, run by root, on a machine of few processors.
    environment = {name: value for name, value in os.environ.items()
                   if not name.startswith(("OMPI_", "PMIX_", "ORTE_", "OPAL_"))}
    environment.update(PATH=search_path(plugin), OMPI_ALLOW_RUN_AS_ROOT="1",
                       OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMPI_MCA_rmaps_base_oversubscribe="1")
    commands = {"python": ["pvpython", "--force-offscreen-rendering", "page.py"],
                "bash": ["bash", "-e", "-o", "pipefail", "page.sh"]}
    with tempfile.TemporaryDirectory() as name:
        for model in ("bore_hex_small.vtu", "canister_hex_small.vtu"):
            shutil.copy(MODELS / model, name)
        for example in EXAMPLES.iterdir():
            if example.is_dir():
                shutil.copytree(example, Path(name) / example.name)
        printed = ""
        for language, code in blocks(page, plugin):
            command = commands[language]
            (Path(name) / command[-1]).write_text(code, encoding="utf-8")
            done = subprocess.run(command, cwd=name, env=environment,
                                  capture_output=True, text=True, check=False)
            if done.returncode != 0:
                raise RuntimeError(f"{page}.md: {done.stdout}{done.stderr}")
            printed += done.stdout
        return shutil.copy(Path(name) / picture, Path(images) / f"howto-{picture}"), printed


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
        path, _ = run(page, plugin, options.folder)
        fewer_colors(path)
        print(path)


if __name__ == "__main__":
    main()
