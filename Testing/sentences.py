#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks that no sentence has more than 30 words: in pages (all Markdown), in the comments of the
filters' headers, and in the texts of the plugin's properties. The first sentence of such a text has
at most 20.

Usage: sentences.py [--try]
Code, formulas, links' targets and headings are left out; a cell of a table, an item of a list and
what a colon or semicolon ends are sentences. Fails, and names file and sentence. --try: finds a
long sentence of its own in each of these places.
"""
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MOST = 30
WORD = r"[A-Za-z0-9][\w'.,-]*"
MOST_OF_FIRST = 20  # of a property's text


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
            words = re.findall(WORD, sentence)
            if len(words) > MOST:
                yield len(words), " ".join(sentence.split())


def sentences_of_comment(text):
    """Of a comment without its stars and slashes."""
    text = re.sub(r"@(class|sa|param|return)\b.*", "", text)
    text = re.sub(r"@brief", "", text)
    # Columns, as of a table, and formulas are no sentences.
    text = "\n".join("" if re.search(r"\S {3,}\S", line) else line for line in text.split("\n"))
    for count, sentence in long_sentences(text):
        if not re.search(r"[=^]", sentence):
            yield count, sentence


def comments(source):
    """The comments of a C++ header, each as one text."""
    block = r"/\*.*?\*/"
    lines = r"(?:^[ \t]*//[^\n]*\n)+|//[^\n]*(?:\n[ \t]*//[^\n]*)*"
    for match in re.finditer(f"{block}|{lines}", source, re.S | re.M):
        yield re.sub(r"^[ \t]*(?:/\*+|\*+/|\*|//+<?) ?|\*/", "", match[0], flags=re.M)


def texts(xml):
    """The texts of the proxies and properties of a file of the plugin."""
    documentation = r"<Documentation([^>]*)>(.*?)</Documentation>"
    for attributes, content in re.findall(documentation, xml, re.S):
        yield from re.findall(r'_help="([^"]*)"', attributes)
        yield re.sub(r"<[^>]*>", "", content).strip()


def sentences_of_text(text):
    yield from long_sentences(text)
    first = re.split(r"(?<=[.!?:;])\s", text)[0]
    count = len(re.findall(WORD, first))
    if MOST_OF_FIRST < count <= MOST:
        yield count, "(first) " + " ".join(first.split())


def listed(*patterns):
    found = subprocess.run(["git", "ls-files", *patterns], cwd=ROOT, capture_output=True, text=True,
                           check=False)
    if found.returncode == 0 and found.stdout:
        return [ROOT / name for name in found.stdout.split("\n") if name]
    return [p for pattern in patterns for p in sorted(ROOT.rglob(pattern))
            if "build" not in p.relative_to(ROOT).parts]


def found_in(path):
    text = path.read_text("utf-8")
    if path.suffix == ".md":
        yield from long_sentences(text)
    elif path.name.endswith((".h", ".h.in")):
        for comment in comments(text):
            yield from sentences_of_comment(comment)
    elif path.suffix == ".ini":
        for one in re.findall(r"^text[^=\n]*=(.*(?:\n(?:[ ]+.*)?)*)", text, re.M):
            first, *others = re.split(r"\n\s*\n", one.strip())
            yield from sentences_of_text(first)
            for other in others:
                yield from sentences_of_comment(other)
    else:
        for one in texts(text):
            yield from sentences_of_text(one)


def try_it():
    words = "word " * MOST
    for wrong in (words + "end.", f"- Short.\n- {words} end.", f"| short | {words} end |",
                  f"Short. {words}\n`code`.", f"1. {words}\n   end"):
        assert len(list(long_sentences(wrong))) == 1, wrong
    for right in (words, f"    {words} code", f"```\n{words} code\n```", f"{words}: {words}",
                  f"- {words}\n- {words}"):
        assert not list(long_sentences(right)), right
    half = "word " * (MOST // 2)
    for wrong in (f"/**\n * Short.\n * {half}\n * {half} end\n */", f"/// {half}\n/// {half} end\n",
                  f"int i; ///< {half}\n       ///< {half} end\n"):
        found = [one for comment in comments(wrong) for one in sentences_of_comment(comment)]
        assert len(found) == 1, wrong
    for right in (f"// x = {words}\n", f"// {words}\nint i;\n// {words}\n"):
        assert not [1 for c in comments(right) for _ in sentences_of_comment(c)], right
    for wrong in (f'<Documentation long_help="{half}{half} end">Short.</Documentation>',
                  f"<Documentation>\n{'word ' * MOST_OF_FIRST} end. Short.\n</Documentation>"):
        assert len([one for text in texts(wrong) for one in sentences_of_text(text)]) == 1, wrong


def main():
    if sys.argv[1:] == ["--try"]:
        try_it()
        return
    pages, headers = listed("*.md"), [p for p in listed("*.h", "*.h.in") if "Filters" in p.parts]
    xml = [p for p in listed("*.xml", "*.xml.in", "*.ini")]
    assert pages and headers and xml
    found = [f"{path.relative_to(ROOT)}: {count} words: {sentence}"
             for path in pages + headers + xml if path.exists()
             for count, sentence in found_in(path)]
    print("\n".join(found) or f"{len(pages)} pages, {len(headers)} headers and {len(xml)} files of "
          f"properties: no sentence has more than {MOST} words.")
    sys.exit(bool(found))


if __name__ == "__main__":
    main()
