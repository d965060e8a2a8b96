"""The page that computes in a browser, with a system: in a notebook or in a browser window."""

import base64
import html
import pathlib
import sys
import webbrowser
import zlib

from .errors import InputError


def _file():
    """The page, seen from this module: in it, in a build, or where both are installed."""
    module = pathlib.Path(__file__).resolve().parent
    for file in (
        module / "carom.html", *(folder / "page/carom.html" for folder in module.parents[1:3]),
        pathlib.Path(sys.prefix) / "share/carom/carom.html",
    ):  # fmt: skip
        if file.exists():
            return file
    raise InputError("the page is not there", ("", 0, 0, "show"), "./dev page, which makes it, or a package that holds it")


def fragment(system):
    """The system as the address of the page holds it."""
    packer = zlib.compressobj(9, wbits=-15)
    packed = packer.compress(system.to_toml().encode()) + packer.flush()
    return "#toml=" + base64.urlsafe_b64encode(packed).decode().rstrip("=")


def show(system, width="100%", height=820):
    """In a notebook a frame with the page; else the page is opened in a browser, and its address given."""
    file, at = _file(), fragment(system)
    ipython = sys.modules.get("IPython")
    if not hasattr(ipython.get_ipython() if ipython else None, "kernel"):
        address = file.as_uri() + at
        webbrowser.open(address)
        return address
    from IPython.display import HTML

    head, body = file.read_text(encoding="utf-8").split("<head>", 1)
    page = f'{head}<head><script>location.hash = "{at}"</script>{body}'
    return HTML(f'<iframe srcdoc="{html.escape(page)}" width="{width}" height="{height}" style="border: 0"></iframe>')
