#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks that no sentence of the pages (all Markdown) has more than 30 words.

Usage: sentences.py [--try]
Code, links' targets and headings are left out; a cell of a table, an item of a list and what a
colon or semicolon ends are sentences. Fails, and names page and sentence. --try: finds a long
sentence of its own in each of these places.
"""
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MOST = 30


def paragraphs(text):
    text = re.sub(r"^```.*?^```", "", text, flags=re.S | re.M)
    text = re.sub(r"<!--.*?-->", "", text, flags=re.S)
    # Code is indented where no list is: at the start, or after an empty line.
    kept, code = [], True
    for line in text.split("\n"):
        code = line.startswith("    ") and (code or not kept or not kept[-1].strip())
        kept.append("" if code or line.startswith("#") else line)
    for block in re.split(r"\n\s*\n|\n(?=\s*(?:[-*|]|\d+\.) ?)", "\n".join(kept)):
        yield from block.split("|") if block.lstrip().startswith("|") else [block]


def long_sentences(text):
    for paragraph in paragraphs(text):
        plain = re.sub(r"\]\([^)]*\)", "]", paragraph)
        plain = re.sub(r"`[^`]*`", "code", plain)
        for sentence in re.split(r"(?<=[.!?:;])[*_)\]]*\s+", plain):
            words = re.findall(r"[A-Za-z0-9][\w'.,-]*", sentence)
            if len(words) > MOST:
                yield len(words), " ".join(sentence.split())


def pages():
    listed = subprocess.run(["git", "ls-files", "*.md"], cwd=ROOT, capture_output=True, text=True,
                            check=False)
    if listed.returncode == 0 and listed.stdout:
        return [ROOT / name for name in listed.stdout.split("\n") if name]
    return [p for p in sorted(ROOT.rglob("*.md")) if "build" not in p.relative_to(ROOT).parts]


def main():
    if sys.argv[1:] == ["--try"]:
        words = "word " * MOST
        for wrong in (words + "end.", f"- Short.\n- {words} end.", f"| short | {words} end |",
                      f"Short. {words}\n`code`.", f"1. {words}\n   end"):
            assert len(list(long_sentences(wrong))) == 1, wrong
        for right in (words, f"    {words} code", f"```\n{words} code\n```", f"{words}: {words}",
                      f"- {words}\n- {words}"):
            assert not list(long_sentences(right)), right
        return
    found = [f"{page.relative_to(ROOT)}: {count} words: {sentence}" for page in pages()
             if page.exists() for count, sentence in long_sentences(page.read_text("utf-8"))]
    print("\n".join(found) or f"{len(pages())} pages: no sentence has more than {MOST} words.")
    sys.exit(bool(found) or not pages())


if __name__ == "__main__":
    main()
