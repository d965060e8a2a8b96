"""The check of links finds what is broken."""

import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "docs/site"))
import build
import check_links


class Links(unittest.TestCase):
    def faults(self, **pages):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in pages.items():
                (pathlib.Path(folder) / f"{name}.html").write_text(text, encoding="utf-8")
            return check_links.faults(pathlib.Path(folder))[0]

    def test_whole_pages_have_no_fault(self):
        one = '<a id="top" href="two.html#end">two</a><a href="#top">up</a><a href="https://x.org">x</a>'
        self.assertEqual(self.faults(one=one, two='<p id="end">'), [])

    def test_a_missing_page_is_found(self):
        self.assertIn("no file", self.faults(one='<a href="two.html">')[0])

    def test_a_missing_anchor_is_found(self):
        self.assertIn("no anchor", self.faults(one='<a href="two.html#end">', two="<p>")[0])

    def test_a_missing_picture_is_found(self):
        self.assertIn("no file", self.faults(one='<img src="two.png">')[0])

    def test_what_the_network_would_bring_is_found(self):
        self.assertIn("elsewhere", self.faults(one='<script src="https://x.org/x.js"></script>')[0])
        self.assertIn("elsewhere", self.faults(one='<link rel="stylesheet" href="//x.org/x.css">')[0])


class Pages(unittest.TestCase):
    def test_code_is_no_prose(self):
        text = "a\n```sh\nb\n```\n    c\nd"
        self.assertEqual([line for line, is_prose in build.prose(text) if is_prose], ["a", "d"])

    def test_every_page_is_in_the_contents(self):
        docs = pathlib.Path(__file__).parents[2] / "docs"
        listed = {page for _, pages in build.contents(docs / "README.md") for page in pages}
        listed |= {f"guide/{page}" for page in build.below(docs.parent)}
        there = {str(page.relative_to(docs)) for page in docs.rglob("*.md")} - {"README.md"}
        self.assertEqual(there, listed)


if __name__ == "__main__":
    unittest.main()
