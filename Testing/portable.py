#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Fails where a source of Filters or Programs uses what only GCC and Clang or only POSIX have.

The vector kit has a twin for other compilers, and what writes files one for Windows. All else is
standard C++. With --try it fails unless it finds each kind in a made-up source.
"""
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
EXTENSIONS = re.compile(
    r"__builtin_\w+|__attribute__|__atomic_\w+|vector_size|__int128|__restrict|__asm|__typeof"
    r"|\[\[gnu::"
    r"|#\s*include\s*<(?:unistd|fcntl|pthread|dlfcn|dirent|glob|poll|pwd|sched|spawn|strings"
    r"|termios|windows|\w*intrin|(?:arpa|net|netinet|sys)/\w+)\.h>"
    # What POSIX adds to the headers of standard C.
    r"|\bM_(?:E|LN|LOG|PI|SQRT|[12]_)\w*|\benviron\b"
    r"|(?<![.>\w])(?:fileno|fdopen|popen|pclose|fseeko|ftello|dprintf|setenv|unsetenv|putenv"
    r"|mkstemp|mkdtemp|realpath|posix_\w+|random|srandom|[dels]rand48|\w+_r|strdup|strndup"
    r"|strcasecmp|strptime|timegm|nanosleep|clock_gettime|kill|sigaction|isatty)\(")
ALLOWED = {
    "Filters/Core/Support/Simd.h",         # has a scalar twin
    "Filters/IO/Files/ReplaceFile.cxx",    # has a twin for Windows
    "Filters/IO/Files/ReplaceFileWindows.cxx",
    "Programs/MorphMesh/ProgressBar.cxx",  # isatty
}


def findings(text):
    """Lines and what is not portable in them, without comments."""
    for number, line in enumerate(text.splitlines(), 1):
        for found in EXTENSIONS.findall(line.split("//")[0]):
            yield number, found


def main():
    if "--try" in sys.argv[1:]:
        wrong = ["int x = __builtin_popcount(3);", "__attribute__((noinline)) void f();",
                 "__atomic_load_n(&x, 0);", "using V = float [[gnu::vector_size(16)]];",
                 "#include <unistd.h>", "# include <sys/mman.h>", "#include <windows.h>",
                 "double x = M_PI;", "if (::localtime_r(&a, &b))", "setenv(name, value, 1);"]
        missed = [line for line in wrong if not list(findings(line))]
        right = ["int a; // __builtin_popcount", "x.random();", "std::getenv(name);"]
        wrongly = [line for line in right if list(findings(line))]
        if missed or wrongly:
            sys.exit(f"portable.py does not see: {missed}; it sees: {wrongly}")
        return
    count = 0
    for folder in ("Filters", "Programs"):
        for path in sorted((ROOT / folder).rglob("*")):
            name = path.relative_to(ROOT).as_posix()
            if path.suffix not in (".h", ".cxx") or name in ALLOWED:
                continue
            for number, found in findings(path.read_text()):
                print(f"{name}:{number}: {found} is not portable C++; see Support/Simd.h.")
                count += 1
    sys.exit(1 if count else 0)


if __name__ == "__main__":
    main()
