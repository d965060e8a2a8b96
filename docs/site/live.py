"""Figures of the tutorials that compute: the page, if ./dev page made it, with the system of the tutorial."""

import shutil

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


def figure(tutorial, page):
    """What goes into a tutorial."""
    shown = SHOWN.get(tutorial)
    return FIGURE.format(shown=shown.replace("&", "&amp;")) if shown and page.exists() else ""


def copy(page, html):
    if page.exists():
        shutil.copyfile(page, html / "carom.html")
