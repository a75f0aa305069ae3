#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The site as a browser shows it: each page opens without an error in the browser's console, its
pictures are there, and it can be read in a window that is 400 pixels wide. The search finds. All
pages for users but those of the properties, which come from a table, have at most 25,000 words.

Usage: site_browser.py     (it builds the site first, which checks the links)
Exits with 77 without mkdocs, chromium or Selenium (install-packages.sh --site).
"""
import functools
import http.server
import shutil
import subprocess
import sys
import threading
import unittest
from pathlib import Path

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.support.ui import WebDriverWait
except ImportError as error:
    print(error)
    sys.exit(77)

ROOT = Path(__file__).resolve().parent.parent
SITE = ROOT / "build/site"
NARROW = 400  # pixels
MOST_WORDS = 25000
# How wide the page is, and the first element that sticks out of the window.
WIDTH = """
  const wide = [...document.querySelectorAll("body *")].find(
    e => e.getBoundingClientRect().right > innerWidth + 1);
  return [document.documentElement.scrollWidth,
    wide ? wide.tagName + ": " + wide.textContent.trim().slice(0, 60) : ""];"""
PICTURES = """
  return [...document.images].map(i => [i.src, i.complete && i.naturalWidth > 0]);"""
# Numbers of tables are words, too; code is none.
WORDS = """
  const page = (document.querySelector("[role=main]") || document.createElement("p"))
    .cloneNode(true); // 404.html has none
  page.querySelectorAll("pre").forEach(e => e.remove());
  return (page.textContent.match(/\\S+/g) || []).length;"""


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        subprocess.run([ROOT / "Utilities/site.sh", "--no-api"], check=True,
                       stdout=subprocess.DEVNULL)
        server = http.server.ThreadingHTTPServer(
            ("localhost", 0), functools.partial(Quiet, directory=str(SITE)))
        cls.addClassCleanup(server.server_close)
        cls.addClassCleanup(server.shutdown)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        cls.address = f"http://localhost:{server.server_port}"
        options = webdriver.ChromeOptions()
        options.binary_location = shutil.which("chromium")
        for option in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage"):
            options.add_argument(option)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        cls.browser = webdriver.Chrome(service=Service(shutil.which("chromedriver")),
                                       options=options)
        cls.addClassCleanup(cls.browser.quit)
        cls.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": NARROW, "height": 800, "deviceScaleFactor": 1, "mobile": False})

    def test_pages(self):
        pages = sorted(path.relative_to(SITE).as_posix() for path in SITE.glob("**/*.html"))
        self.assertGreater(len(pages), 40)
        shown = words = 0
        for page in pages:
            with self.subTest(page=page):
                self.browser.get(f"{self.address}/{page}")
                self.assertEqual([entry["message"] for entry in self.browser.get_log("browser")
                                  if entry["level"] == "SEVERE"], [])
                pictures = self.browser.execute_script(PICTURES)
                self.assertEqual([source for source, there in pictures if not there], [])
                shown += len(pictures)
                if "/Properties/" not in page and page != "CONTRIBUTING.html":
                    words += self.browser.execute_script(WORDS)
                width, widest = self.browser.execute_script(WIDTH)
                self.assertLessEqual(width, NARROW, widest)
        self.assertGreater(shown, 40)
        self.assertLessEqual(words, MOST_WORDS)

    def test_search(self):
        self.browser.get(f"{self.address}/index.html?q=adjoint")
        results = self.browser.find_element("id", "mkdocs-search-results")
        WebDriverWait(self.browser, 60).until(
            lambda _: "Derivatives" in results.get_attribute("textContent"))


if __name__ == "__main__":
    for program in ("mkdocs", "chromium", "chromedriver"):
        if shutil.which(program) is None:
            print(f"{program} is missing")
            sys.exit(77)
    unittest.main()
