#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks comments and messages of C++ sources for private idiom that has a plain English term.

Usage: words.py [FOLDER ...]
It fails, and names file and line, for a word of the table below. Each row has a sentence that the
row must find, so that a row that finds nothing fails too. FOLDER: default FOLDERS.
"""
import os
import re
import sys

FOLDERS = ("Examples", "Filters", "Plugin", "Programs", "Python", "Testing")

# Pattern, what to write, a sentence to find.
TABLE = (
    (r"\banew\b", "again, or a form of recompute", "They are computed anew for each motion."),
    (r"\bat rest\b|\brest (mesh|points?|positions?|shapes?)\b", "undeformed, or reference",
     "Repair the rest mesh."),
    (r"\bleast (scaled )?(jacobian|determinant|quality|value)s?\b", "minimum",
     "Raises the least scaled Jacobian."),
    (r"\bcom(e|es|ing) along\b", "are kept, or moves with", "Arrays come along."),
    (r"\bround (it|its|them|the|a|some|all)\b", "around", "Cells with rings of cells round them."),
    (r"\blikewise\b|\bnotwithstanding\b", "name the thing again", "They stay likewise."),
    (r"\bno matter\b|\bnever matters?\b", "has no effect", "No matter which threads run."),
    (r"\bthreads? (do not |does not )?shows?\b", "does not depend on threads", "No thread shows."),
    (r"\bcarr(y|ies|ied|ying)( \w+)? along\b", "maps, moves or keeps", "It is carried along."),
)
COMMENT = re.compile(r"(?:(?:^|\s)//+<?|^\s*/?\*+(?!/))\s?(.*)$")
STRING = re.compile(r'"((?:[^"\\]|\\.)*)"')


def matches(text):
    return [(match.start(), match.group(), plain)
            for pattern, plain, _ in TABLE
            for match in re.finditer(pattern, text, re.IGNORECASE)]


def blocks(path):
    """Comments and strings of successive lines: the text, and (offset, number) of each line."""
    text, lines, kind = "", [], None
    with open(path, encoding="utf-8") as source:
        for number, line in enumerate(source, 1):
            comment = COMMENT.search(line)
            strings = [] if line.startswith("#include") else STRING.findall(line)
            here = "comment" if comment else "strings" if strings else None
            if here != kind and text:
                yield text, lines
                text, lines = "", []
            kind = here
            if here:
                lines.append((len(text), number))
                text += comment.group(1) + " " if comment else "".join(strings)
    if text:
        yield text, lines


def main():
    problems = [f"words.py: the row {pattern} does not find: {sentence}"
                for pattern, _, sentence in TABLE
                if not re.search(pattern, sentence, re.IGNORECASE)]
    root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    count = 0
    for folder in sys.argv[1:] or FOLDERS:
        for where, _, files in sorted(os.walk(os.path.join(root, folder))):
            for name in sorted(files):
                if not name.endswith((".h", ".cxx")):
                    continue
                count += 1
                path = os.path.join(where, name)
                for text, lines in blocks(path):
                    for offset, found, plain in matches(text):
                        number = max(n for start, n in lines if start <= offset)
                        problems.append(f"{os.path.relpath(path, root)}:{number}: "
                                        f'"{found}": write: {plain}')
    if count == 0:
        problems.append("words.py: no sources")
    print("\n".join(problems) if problems else f"{count} sources: no private idiom.")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
