"""Figures of the tutorials that compute: the page, if ./dev page made it, with the system of the tutorial."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

# What the page shows, as in its address.
SHOWN = {
    "certified-orbits": "system=stadium&from=0.1,0.2,0.9486832980505138,0.31622776601683794",
    "comparing": "system=henon-heiles",
    "diffusion": "system=lorentz-triangular&particles=100",
    "equilibria": "system=wigner",
    "escape": "system=stadium&particles=100",
    "forces": "system=henon-heiles",
    "lyapunov": "system=mushroom",
    "orbit": "system=mushroom&from=0.72,0.05,0.01999600119960014,0.999800059980007",
    "periodic-orbits": "system=three-disc&particles=100",
    "section": "system=ellipse-magnetic",
    "sweep": "system=magnetic-square&particles=100",
}
FIGURE = """```{{raw}} html
<p>The system in the page (<a href="../../carom.html#{shown}">in a window of its own</a>):</p>
<div class="live" data-page="../../carom.html#{shown}"></div>
```
"""


def drawn(tutorial, module):
    """The system of a tutorial that draws its table. The page reads no second file: the drawing has become a path."""
    text = tutorial.read_text(encoding="utf-8")
    drawing = re.search(r'^(\w+) = """(<svg.*?)"""', text, re.DOTALL | re.MULTILINE)
    written = "import carom, carom.page; print(carom.page.fragment(carom.load('own.toml'))[1:])"
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / f"{drawing[1]}.svg").write_text(drawing[2], encoding="utf-8")
        (folder / "own.toml").write_text(re.search(r"```toml\n(.*?)```", text, re.DOTALL)[1], encoding="utf-8")
        done = subprocess.run([sys.executable, "-B", "-c", written], cwd=folder, check=True, capture_output=True, text=True,
                              env=os.environ | {"PYTHONPATH": str(module)})
    return f"{done.stdout.strip()}&particles=100&colour=exponent"


def figure(tutorial, page, module):
    """What goes into a tutorial, a file."""
    if not page.exists():
        return ""
    shown = drawn(tutorial, module) if tutorial.stem == "drawing" else SHOWN.get(tutorial.stem)
    return FIGURE.format(shown=shown.replace("&", "&amp;")) if shown else ""


def copy(page, html):
    if page.exists():
        shutil.copyfile(page, html / "carom.html")
