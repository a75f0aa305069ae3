#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks that what the pages of a site link to is there: pages, headings, pictures, files.

Usage: site_links.py FOLDER
It fails, and names page and link, for a link into FOLDER whose file or heading is missing. Links to
other sites are counted, and not followed. Doxygen's pages (FOLDER/api) are read for their headings
alone, since Doxygen checks its links itself.
"""
import os
import sys
from html.parser import HTMLParser
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """What a page links to, and the names of its places."""

    def __init__(self, path):
        super().__init__()
        self.links, self.places = [], set()
        with open(path, encoding="utf-8") as file:
            self.feed(file.read())

    def handle_starttag(self, tag, attrs):
        for name, value in attrs:
            if name in ("href", "src") and value is not None:
                self.links.append(value)
            elif name in ("id", "name") and value:
                self.places.add(value)


def pages_of(folder):
    for path, folders, files in os.walk(folder):
        folders.sort()
        yield from (os.path.join(path, name) for name in sorted(files) if name.endswith(".html"))


def main():
    if len(sys.argv) != 2 or not os.path.isdir(sys.argv[1]):
        sys.exit(__doc__)
    root = os.path.realpath(sys.argv[1])
    pages, problems, inside, outside = {}, [], 0, 0

    def page(path):
        if path not in pages:
            pages[path] = Page(path)
        return pages[path]

    for path in pages_of(root):
        if os.path.relpath(path, root).startswith("api" + os.sep):
            continue
        for link in page(path).links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                outside += 1
                continue
            inside += 1
            target = os.path.normpath(os.path.join(os.path.dirname(path), unquote(parts.path)))
            if not parts.path:
                target = path
            elif parts.path.startswith("/"):
                target = root + parts.path
            if os.path.isdir(target):
                target = os.path.join(target, "index.html")
            where = f"{os.path.relpath(path, root)}: {link}"
            if not os.path.exists(target):
                problems.append(f"{where}: there is no such file")
            elif parts.fragment and target.endswith(".html") and not target.startswith(
                    os.path.join(root, "api")):
                if unquote(parts.fragment) not in page(target).places:
                    problems.append(f"{where}: the page has no such heading")
    for problem in problems:
        print(problem, file=sys.stderr)
    print(f"{len(pages)} pages, {inside} links within the site, {outside} to other sites")
    if not inside:
        sys.exit("no link was found, so nothing was checked")
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
