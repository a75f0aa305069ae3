#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Utilities/site_links.py names each kind of wrong link, and passes a site without one."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

CHECK = Path(__file__).resolve().parent.parent / "Utilities" / "site_links.py"


def check(**pages):
    """The exit code and the problems of a site of these pages: {name: body}."""
    with tempfile.TemporaryDirectory() as name:
        for page, body in pages.items():
            Path(name, f"{page}.html").write_text(f"<html><body>{body}</body></html>",
                                                  encoding="utf-8")
        result = subprocess.run([sys.executable, str(CHECK), name], capture_output=True, text=True,
                                check=False)
    return result.returncode, result.stderr


class Links(unittest.TestCase):
    def test_right_links(self):
        code, problems = check(one='<a href="two.html#here">',
                               two='<h2 id="here"><a href="one.html">')
        self.assertEqual((code, problems), (0, ""))

    def test_missing_page_picture_and_heading(self):
        for link, what in (('<a href="three.html">', "no such file"),
                           ('<img src="images/x.png">', "no such file"),
                           ('<a href="two.html#there">', "no such heading"),
                           ('<a href="#nowhere">', "no such heading")):
            code, problems = check(one=link, two='<h2 id="here">')
            self.assertEqual(code, 1, link)
            self.assertIn("one.html", problems)
            self.assertIn(what, problems)

    def test_nothing_to_check_is_no_success(self):
        self.assertNotEqual(check(one="text")[0], 0)


if __name__ == "__main__":
    unittest.main()
