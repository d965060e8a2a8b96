#!/usr/bin/python3
"""Makes the site: one folder that Sphinx reads, the pictures of the gallery, the HTML.

    build.py --source TREE --build TREE/build/docs --module TREE/build/release/python

docs/README.md is the table of contents: each of its sections becomes a part of the side bar. The pages of
docs/guide/commands are below docs/guide/commands.md.
"""

import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys

import check_links
import cpp_reference
import live
import notebooks
from rst import title

MATHJAX = pathlib.Path("/usr/share/javascript/mathjax")
# What the configuration TeX-AMS_CHTML loads.
MATHJAX_PARTS = (
    "MathJax.js",
    "config/TeX-AMS_CHTML.js",
    "extensions",
    "fonts/HTML-CSS/TeX/woff",
    "jax/element",
    "jax/input/TeX",
    "jax/output/CommonHTML",
)
LINK = re.compile(r"(\]\()([^)\s#]+)(#[^)\s]*)?(\))")
PLAIN_URL = re.compile(r"[a-z]+:")


def prose(text):
    """The lines of a page, each with whether it is prose rather than code."""
    fence = None
    for line in text.split("\n"):
        mark = re.match(r" *(```+|~~~+)", line)
        if mark and fence is None:
            fence = mark[1]
            yield line, False
        elif mark and mark[1].startswith(fence):
            fence = None
            yield line, False
        else:
            yield line, fence is None and not line.startswith("    ")


class Stage:
    """The folder that Sphinx reads: docs/ at its top, README.md as index, other files beside."""

    def __init__(self, root, folder):
        self.root = root
        self.folder = folder

    def place(self, path):
        """Where a file of the tree goes, relative to the folder."""
        path = path.relative_to(self.root)
        if path == pathlib.Path("README.md"):
            return pathlib.Path("index.md")
        if path == pathlib.Path("docs/README.md"):
            return pathlib.Path("contents.md")
        if path.parts[0] == "docs":
            return path.relative_to("docs")
        # Sphinx offers a file for download only if it does not look like a page.
        return pathlib.Path("files") / path

    def write(self, place, text):
        file = self.folder / place
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")

    def page(self, path, ending="", figure=""):
        """Copies a page; its links lead to where the files went. A figure goes before its last section."""
        here = self.place(path).parent

        def moved(link):
            before, target, anchor, after = link[1], link[2], link[3] or "", link[4]
            if PLAIN_URL.match(target):
                return link[0]
            file = (path.parent / target).resolve()
            if not file.is_relative_to(self.root) or not file.is_file():
                raise SystemExit(f"{path}: there is no file {target}")
            goal = self.place(file)
            if file.suffix != ".md" and not (self.folder / goal).exists():
                (self.folder / goal).parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(file, self.folder / goal)
            return f"{before}{os.path.relpath(goal, here)}{anchor}{after}"

        lines = [LINK.sub(moved, line) if is_prose else line
                 for line, is_prose in prose(path.read_text(encoding="utf-8"))]
        if figure:
            last = max(k for k, line in enumerate(lines) if line.startswith("## "))
            lines.insert(last, figure)
        self.write(self.place(path), "\n".join(lines) + ending)


def contents(page):
    """[(title of a section, [pages it links to])] of docs/README.md."""
    sections = []
    for line, is_prose in prose(page.read_text(encoding="utf-8")):
        if line.startswith("## "):
            sections.append((line[3:].strip(), []))
        entry = re.match(r"- \[[^\]]*\]\(([^)#]+\.md)\):", line)
        if sections and is_prose and entry:
            sections[-1][1].append(entry[1])
    return [(title, pages) for title, pages in sections if pages]


def below(root):
    """The pages of the commands, in the order of docs/guide/commands.md."""
    page = (root / "docs/guide/commands.md").read_text(encoding="utf-8")
    return re.findall(r"^\| \[[^\]]*\]\((commands/\w+\.md)\)", page, re.M)


def toctree(caption, pages):
    entries = "\n".join(page.removesuffix(".md") for page in pages)
    named = f":caption: {caption}\n" if caption else ""
    return f"\n```{{toctree}}\n:hidden:\n{named}\n{entries}\n```\n"


def python_reference(stage):
    parts = {
        "carom.commands": "Commands",
        "carom.blocks": "Blocks of hits and of trajectories",
        "carom.system": "Systems",
        "carom.shapes": "Shapes of tables",
        "carom.results": "Results",
        "carom.stored": "What all results have",
        "carom.estimates": "Values with errors",
        "carom.plot": "Pictures",
        "carom.errors": "Errors",
    }
    text = title("Python reference")
    text += (
        "All names of commands, systems, results and errors are in ``carom`` itself:\n"
        "``carom.escape``, ``carom.stadium``, ``carom.InputError``. The guide has\n"
        ":doc:`an introduction </guide/python>`.\n\n"
    )
    for module, name in parts.items():
        text += title(name, "-") + f".. automodule:: {module}\n"
        text += "   :imported-members:\n\n" if module == "carom.plot" else "\n"
    stage.write("reference/python.rst", text)


def pictures(root, build, module, stage):
    """Runs the scripts of the gallery, if they or the module are newer than their pictures."""
    made = build / "gallery"
    made.mkdir(exist_ok=True)
    newest = max(file.stat().st_mtime for file in module.rglob("*") if file.suffix in (".so", ".py"))
    environment = os.environ | {"PYTHONPATH": str(module), "MPLBACKEND": "Agg"}
    for script in sorted((root / "docs/guide/gallery").glob("*.py")):
        picture = made / f"{script.stem}.png"
        since = max(newest, script.stat().st_mtime)
        if not picture.exists() or picture.stat().st_mtime < since:
            command = [sys.executable, "-B", str(script)]
            subprocess.run(command, cwd=made, env=environment, check=True)
        shutil.copyfile(picture, stage.folder / "guide/gallery" / picture.name)


def mathjax(static):
    for part in MATHJAX_PARTS:
        goal = static / "mathjax" / part
        goal.parent.mkdir(parents=True, exist_ok=True)
        copy = shutil.copytree if (MATHJAX / part).is_dir() else shutil.copyfile
        copy(MATHJAX / part, goal)


def mend_theme(html):
    """Debian's Furo expects a web server's /javascript and a bundler: a page from a file has neither."""
    style = html / "_static/styles/furo.css"
    normalize = pathlib.Path("/usr/share/javascript/normalize.css/normalize.css")
    text = style.read_text(encoding="utf-8")
    link = "@import url(/javascript/normalize.css/normalize.css);"
    style.write_text(text.replace(link, normalize.read_text(encoding="utf-8")), encoding="utf-8")
    scripts = html / "_static/scripts"
    parts = [(scripts / name).read_text(encoding="utf-8") for name in ("gumshoe-patched.js", "furo.js")]
    text = "\n".join(parts).replace('import Gumshoe from "./gumshoe-patched.js";', "")
    (scripts / "furo.js").write_text(text, encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    for name in ("source", "build", "module"):
        parser.add_argument(f"--{name}", type=pathlib.Path, required=True)
    given = parser.parse_args()
    root, build, module = (path.resolve() for path in (given.source, given.build, given.module))
    stage = Stage(root, build / "source")
    web = root / "build/page/carom.html"
    shutil.rmtree(stage.folder, ignore_errors=True)

    pages = contents(root / "docs/README.md")
    cpp_reference.write(stage, root, build / "doxygen")
    python_reference(stage)
    pages.append(("Library", ["reference/cpp.md", "reference/python.md"]))
    trees = toctree("Start", ["contents.md"]) + "".join(toctree(*part) for part in pages)
    for page in [root / "README.md", *sorted((root / "docs").rglob("*.md"))]:
        ending, figure = trees if page == root / "README.md" else "", ""
        if page == root / "docs/guide/commands.md":
            ending = toctree("", below(root))
        if page.parent.name == "tutorials":
            (stage.folder / "guide/tutorials").mkdir(parents=True, exist_ok=True)
            made = notebooks.write(page, stage.folder / "guide/tutorials")
            figure = live.figure(page, web, module)
            ending = f"\nThis page [as a Jupyter notebook]({made.name}).\n"
        stage.page(page, ending, figure)
    pictures(root, build, module, stage)
    mathjax(stage.folder / "static")
    for name in ("carom.css", "live.js"):
        shutil.copyfile(root / "docs/site" / name, stage.folder / "static" / name)

    version = re.search(r"project\(carom\s+VERSION\s+([\d.]+)",
                        (root / "CMakeLists.txt").read_text(encoding="utf-8"))[1]
    html = build / "html"
    for old in (html, build / "doctrees"):
        shutil.rmtree(old, ignore_errors=True)
    environment = os.environ | {
        "CAROM_MODULE": str(module),
        "CAROM_STATIC": str(stage.folder / "static"),
        "CAROM_VERSION": version,
    }
    sphinx = [sys.executable, "-B", "-m", "sphinx", "-W", "--keep-going", "-q"]
    sphinx += ["-b", "html", "-c", root / "docs/site", "-d", build / "doctrees", stage.folder, html]
    done = subprocess.run([str(word) for word in sphinx], env=environment)
    if done.returncode != 0:
        raise SystemExit("the site has warnings, which count as errors")
    mend_theme(html)
    live.copy(web, html)
    check_links.main(html)


if __name__ == "__main__":
    main()
