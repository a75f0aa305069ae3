#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What the installation takes on this Debian.

    Testing/Benchmark/install.py    # after apt-get update, as root

Writes this release's rows. results/install.csv: of the packages of install-packages.sh --use,
without those that the smallest system has, megabytes to download and on the disk, as the index of
apt has them. results/install-minutes.csv: in a bare system that other-debian.sh makes, minutes
until these packages are installed, downloads included, and minutes of processor time, of all cores
in sum, that build.sh takes from nothing."""

import csv
import os
import re
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
RESULTS = ROOT / "Testing/Benchmark/results"
sys.path.insert(0, str(ROOT / "Utilities"))
from study_pieces import commit, machine  # noqa: E402  (needs the path above)


def apt(program, folder, *arguments):
    """The output of a program of apt that takes no package for installed."""
    options = ("Dir::State::status=/dev/null", f"Dir::Cache={folder}", "Debug::NoLocking=1")
    command = [program, *(f"-o{option}" for option in options), *arguments]
    return subprocess.run(command, capture_output=True, text=True,
                          env={**os.environ, "LC_ALL": "C"}).stdout


def megabytes(folder, packages):
    """(to download, on the disk) of packages and all that they need."""
    said = apt("apt-get", folder, "--no-install-recommends", "--assume-no", "install", *packages)
    found = re.search(r"Need to get ([\d.,]+) MB of archives.*?operation, ([\d.,]+) MB", said,
                      re.DOTALL)
    if not found:
        sys.exit(f"install.py: apt does not say what it needs. Run apt-get update first.\n{said}")
    return tuple(float(number.replace(",", "")) for number in found.groups())


def packages_row():
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "archives/partial").mkdir(parents=True)
        known = apt("apt-cache", folder, "dumpavail").split("\n\n")
        smallest = ["apt"] + [re.search(r"^Package: (.*)", one, re.M)[1] for one in known
                              if re.search(r"^Priority: required$", one, re.M)]
        ours = subprocess.run([ROOT / "Utilities/install-packages.sh", "--use", "--list"],
                              check=True, capture_output=True, text=True).stdout.split()
        less, all_ = megabytes(folder, smallest), megabytes(folder, smallest + ours)
    return {"download_MB": round(all_[0] - less[0]), "disk_MB": round(all_[1] - less[1])}


def used():
    """Seconds (passed, of processor time that ended processes have had)."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.monotonic(), children.ru_utime + children.ru_stime


def minutes_row(suite):
    def in_bare_system(*arguments):
        before = used()
        subprocess.run([ROOT / "Utilities/other-debian.sh", suite, *arguments], check=True)
        return [round((now - then) / 60, 1) for then, now in zip(before, used())]

    in_bare_system("--clean")
    in_bare_system("shell", "true")
    installed, _ = in_bare_system("shell", "Utilities/install-packages.sh", "--use")
    _, built = in_bare_system("shell", "Utilities/build.sh")
    in_bare_system("--clean")
    return {"install_minutes": installed, "build_processor_minutes": built}


def write(name, row):
    """Takes the place of this release's row."""
    path = RESULTS / name
    others = []
    if path.exists():
        with open(path, encoding="utf-8") as file:
            others = [one for one in csv.DictReader(file) if one["release"] != row["release"]]
    with open(path, "w", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, list(row), lineterminator="\n")
        table.writeheader()
        table.writerows(sorted([*others, row], key=lambda one: one["release"]))


def main():
    text = Path("/etc/os-release").read_text(encoding="utf-8")
    system = dict(re.findall(r'^(\w+)="?(.*?)"?$', text, re.MULTILINE))
    release = {"release": system["ID"] + " " + system.get("VERSION_ID", "unstable")}
    state = commit()
    write("install.csv", {**release, **packages_row(), "commit": state})
    write("install-minutes.csv", {**release, **minutes_row(system["VERSION_CODENAME"]),
                                  "machine": machine(), "commit": state})


if __name__ == "__main__":
    main()
