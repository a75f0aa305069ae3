# SPDX-License-Identifier: BSD-3-Clause
"""The wheel of Python's package for NumPy: `pip wheel --no-build-isolation .` CMake builds it, from
nothing or, if the environment variable MESHMORPHING_BUILD names one, in the folder of a build."""
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent


class CMake(build_ext):
    def run(self):
        build, prefix = os.environ.get("MESHMORPHING_BUILD"), Path(self.build_temp, "prefix")
        if not build:
            build = Path(self.build_temp, "cmake")
            subprocess.run(
                ["cmake", "-S", ROOT, "-B", build, "-D", "MESHMORPHING_ONLY_NUMPY=ON",
                 "-D", "MESHMORPHING_UNITY_BUILD=ON", "-D", f"Python3_EXECUTABLE={sys.executable}"],
                check=True)
        subprocess.run(["cmake", "--build", build, "--target", "meshmorphing_numpy", "--parallel",
                        os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count()))],
                       check=True)
        made = Path(self.build_lib, "meshmorphing")
        for old in (prefix, made):
            shutil.rmtree(old, ignore_errors=True)
        subprocess.run(["cmake", "--install", build, "--component", "numpy", "--prefix", prefix],
                       check=True)
        package, = prefix.glob("**/meshmorphing")
        shutil.copytree(package, made)


setup(
    name="meshmorphing",
    version=re.search(r"^project\(MeshMorphing VERSION ([\d.]+)",
                      (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"), re.MULTILINE)[1],
    description="Moves the nodes of volume meshes so that they fit a changed boundary",
    license="BSD-3-Clause; with CGAL in it, the wheel is under GPL-3.0-or-later",
    python_requires=">=3.9",
    install_requires=["numpy"],
    ext_modules=[Extension("meshmorphing._core", [])],
    cmdclass={"build_ext": CMake},
    packages=[])
