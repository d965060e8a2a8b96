#!/usr/bin/python3
"""Checks a folder of HTML: every link of a page leads to a file and an anchor in the folder, and
no page loads anything from elsewhere. check_links.py FOLDER"""

import html.parser
import pathlib
import sys
import urllib.parse


class Page(html.parser.HTMLParser):
    """The anchors and links of a page."""

    def __init__(self, file):
        super().__init__()
        self.anchors, self.links, self.loads = set(), [], []
        self.feed(file.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.anchors |= {given[name] for name in ("id", "name") if given.get(name)}
        if tag == "a" and given.get("href"):
            self.links.append(given["href"])
        elif tag == "link" and given.get("rel") in ("stylesheet", "icon", "shortcut icon"):
            self.loads.append(given["href"])
        elif tag in ("script", "img", "iframe", "object", "source") and given.get("src"):
            self.loads.append(given["src"])


def faults(folder):
    """What is broken, a line each; and how many links were looked at."""
    folder = folder.resolve()
    pages = {file: Page(file) for file in sorted(folder.rglob("*.html"))}
    found, looked_at = [], 0
    for file, page in pages.items():
        for link, loaded in [(one, False) for one in page.links] + [(one, True) for one in page.loads]:
            looked_at += 1
            parts = urllib.parse.urlsplit(link)
            where = f"{file.relative_to(folder)}: {link}"
            if parts.scheme or parts.netloc:
                if loaded and parts.scheme != "data":
                    found.append(f"{where} is loaded from elsewhere")
                continue
            path = urllib.parse.unquote(parts.path)
            target = (file.parent / path).resolve() if path else file
            if target.is_dir():
                target /= "index.html"
            if not target.is_relative_to(folder) or not target.exists():
                found.append(f"{where} leads to no file")
            elif parts.fragment and "=" not in parts.fragment and target in pages:  # else for carom.html's script
                anchor = urllib.parse.unquote(parts.fragment)
                if anchor not in pages[target].anchors:
                    found.append(f"{where} leads to no anchor")
    return found, looked_at, len(pages)


def main(folder):
    found, links, pages = faults(pathlib.Path(folder))
    for one in found:
        print(one, file=sys.stderr)
    if found or not links:
        raise SystemExit(f"{len(found)} broken links")
    print(f"{pages} pages, {links} links", file=sys.stderr)


if __name__ == "__main__":
    main(sys.argv[1])
