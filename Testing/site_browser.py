#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The site as a browser shows it: each page opens without an error in the browser's console, its
pictures are there, and it can be read in a window that is 400 pixels wide.

Usage: site_browser.py     (it builds the site first, which checks the links)
Needs mkdocs, chromium and Selenium (install-packages.sh --site); skipped without one of them.
"""
import functools
import http.server
import shutil
import subprocess
import threading
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SITE = ROOT / "build/site"
# What sticks out of the window to the right, where the page cannot be read without scrolling.
WIDER = """
  const wide = [...document.querySelectorAll("body *")].filter(
    e => e.getBoundingClientRect().right > innerWidth + 1 && e.checkVisibility());
  return document.documentElement.scrollWidth <= innerWidth ? [] :
    wide.slice(0, 3).map(e => e.tagName + ": " + e.textContent.trim().slice(0, 60));"""
PICTURES = """
  return [...document.images].map(i => [i.getAttribute("src"), i.complete && i.naturalWidth > 0]);"""


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        for program in ("mkdocs", "chromium", "chromedriver"):
            if shutil.which(program) is None:
                raise unittest.SkipTest(f"{program} is missing")
        try:
            from selenium import webdriver
        except ImportError as error:
            raise unittest.SkipTest(str(error))
        subprocess.run([ROOT / "Utilities/site.sh", "--no-api"], check=True,
                       stdout=subprocess.DEVNULL)
        server = http.server.ThreadingHTTPServer(
            ("localhost", 0), functools.partial(Quiet, directory=str(SITE)))
        threading.Thread(target=server.serve_forever, daemon=True).start()
        cls.addClassCleanup(server.shutdown)
        cls.address = f"http://localhost:{server.server_port}"
        options = webdriver.ChromeOptions()
        options.binary_location = shutil.which("chromium")
        for option in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage"):
            options.add_argument(option)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        cls.browser = webdriver.Chrome(
            service=webdriver.chrome.service.Service(shutil.which("chromedriver")), options=options)
        cls.addClassCleanup(cls.browser.quit)

    def open(self, page, width):
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": 800, "deviceScaleFactor": 1, "mobile": False})
        self.browser.get(f"{self.address}/{page}")

    def test_pages(self):
        pages = sorted(path.relative_to(SITE).as_posix() for path in SITE.glob("**/*.html"))
        self.assertGreater(len(pages), 40)
        shown = 0
        for page in pages:
            with self.subTest(page=page):
                self.open(page, 400)
                self.assertEqual([e["message"] for e in self.browser.get_log("browser")
                                  if e["level"] == "SEVERE"], [])
                pictures = self.browser.execute_script(PICTURES)
                self.assertEqual([source for source, there in pictures if not there], [])
                shown += len(pictures)
                self.assertEqual(self.browser.execute_script(WIDER), [])
        self.assertGreater(shown, 40)

    def test_search(self):
        self.open("search.html?q=adjoint", 1200)


if __name__ == "__main__":
    unittest.main()
