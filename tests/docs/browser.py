#!/usr/bin/python3
"""Opens the site in a browser without network: browser.py SITE SCREENSHOTS.
The exit status is 77 where there is no chromium."""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

site = screenshots = None


def chromium(address, *options):
    """What the browser prints: its log on standard error, a page on standard output."""
    with tempfile.TemporaryDirectory() as profile:
        command = [shutil.which("chromium"), "--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
                   "--host-resolver-rules=MAP * ~NOTFOUND", f"--user-data-dir={profile}", "--window-size=1300,1400",
                   "--enable-logging=stderr", "--virtual-time-budget=20000", *options, address]
        return subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)


def opened(page, name=None):
    """The page as the browser has made it; its log must have no message of the page."""
    done = chromium(page, "--dump-dom")
    complaints = [line for line in done.stderr.splitlines() if "CONSOLE" in line]
    assert not complaints, complaints
    if name:
        picture = screenshots / f"{name}.png"
        chromium(page, f"--screenshot={picture}")
        assert picture.stat().st_size > 10000, picture
    return done.stdout


def text_of(html):
    return re.sub(r"<[^>]*>", "", html)


class Site(unittest.TestCase):
    def test_pages_open(self):
        for page in ("index", "contents", "guide/gallery", "guide/commands", "guide/tutorials/escape",
                     "physics/integrators", "reference/cpp/events", "reference/python"):
            with self.subTest(page):
                html = opened((site / f"{page}.html").as_uri(), page.replace("/", "-"))
                self.assertIn("Search", html)

    def test_formulas_are_set(self):
        html = opened((site / "physics/tangent-map.html").as_uri(), "physics-tangent-map")
        self.assertGreater(html.count("mjx-chtml"), 5)
        self.assertNotIn("mjx-merror\"", html)

    def test_tutorials_have_figures_that_compute(self):
        if (site / "carom.html").exists():
            html = opened((site / "guide/tutorials/orbit.html").as_uri(), "guide-tutorials-orbit")
            self.assertIn('src="../../carom.html#system=mushroom', html)
            # The system whose table is a drawing.
            html = opened((site / "guide/tutorials/drawing.html").as_uri(), "guide-tutorials-drawing")
            shown = re.search(r'src="../../(carom.html#toml=[^"]*)"', html)[1].replace("&amp;", "&")
            html = opened(f"{site.as_uri()}/{shown}", "carom-drawing")
            self.assertIn("An egg with a pillar", html)
            self.assertIn('shape = "path"', text_of(html))

    def test_the_search_finds_a_page(self):
        html = opened((site / "search.html").as_uri() + "?q=mushroom", "search")
        self.assertIn("finished, found", text_of(html))
        self.assertIn("guide/system-file.html", html)


if __name__ == "__main__":
    if not shutil.which("chromium"):
        print("there is no chromium")
        sys.exit(77)
    site, screenshots = (pathlib.Path(given).resolve() for given in sys.argv[1:3])
    screenshots.mkdir(parents=True, exist_ok=True)
    unittest.main(argv=sys.argv[:1])
