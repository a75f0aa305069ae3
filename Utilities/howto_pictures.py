# SPDX-License-Identifier: BSD-3-Clause
"""Runs the Python of each page in Documentation/HowTo, in a folder of its own with the small
models, and keeps the pictures that they make.

    xvfb-run -a -s "-noreset -screen 0 1280x1024x24" \\
        python3 Utilities/howto_pictures.py [--plugin MeshMorphing.so] [--page NAME] [folder]

Writes howto-*.png into Documentation/images, or the folder given. Needs the built plugin. Each page
runs in a pvpython of its own, and ends this program if it fails."""
import argparse
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGES = ROOT / "Documentation/HowTo"
MODELS = ROOT / "Data/Models/small"
PYTHON = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)


def script(page, plugin):
    """The Python of a page, with this plugin; empty where it has none."""
    blocks = PYTHON.findall((PAGES / f"{page}.md").read_text(encoding="utf-8"))
    return re.sub(r'glob\("build/.*?\)\[0\]', lambda _: repr(str(plugin)), "\n".join(blocks))


def pages():
    """The names of the pages with Python."""
    return [page.stem for page in sorted(PAGES.glob("*.md")) if script(page.stem, "")]


def run(page, plugin, images):
    """Runs a page, and copies its picture to the folder `images`; returns its path."""
    text = (PAGES / f"{page}.md").read_text(encoding="utf-8")
    picture = re.search(r"images/howto-([\w-]+\.png)", text).group(1)
    with tempfile.TemporaryDirectory() as name:
        for model in ("bore_hex_small.vtu", "canister_hex_small.vtu"):
            shutil.copy(MODELS / model, name)
        (Path(name) / "page.py").write_text(script(page, plugin), encoding="utf-8")
        done = subprocess.run(["pvpython", "--force-offscreen-rendering", "page.py"], cwd=name,
                              capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RuntimeError(f"{page}.md: {done.stdout}{done.stderr}")
        return shutil.copy(Path(name) / picture, Path(images) / f"howto-{picture}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--plugin", type=Path)
    parser.add_argument("--page", action="append", help="this page alone; may be repeated")
    parser.add_argument("folder", nargs="?", default=ROOT / "Documentation/images")
    options = parser.parse_args()
    plugin = options.plugin or next((ROOT / "build/paraview/lib").glob("**/MeshMorphing.so"), None)
    if not plugin:
        sys.exit("There is no plugin: build it, by Utilities/demo.sh for one, or use --plugin.")
    for page in options.page or pages():
        print(run(page, plugin.resolve(), options.folder))


if __name__ == "__main__":
    main()
