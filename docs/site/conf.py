"""The settings of the site. build.py makes the folder that Sphinx reads and calls Sphinx."""

import os
import sys

sys.path.insert(0, os.environ["CAROM_MODULE"])

project = "Carom"
author = "The Carom developers"
copyright = "The Carom developers; GPL-3.0-or-later"
release = version = os.environ["CAROM_VERSION"]

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.mathjax"]
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
# The pages are read on GitHub, too: there a formula stands in a block of $$.
myst_update_mathjax = False
mathjax_path = "mathjax/MathJax.js?config=TeX-AMS_CHTML"
mathjax2_config = {"showMathMenu": False, "messageStyle": "none"}

highlight_language = "none"
smartquotes = False
default_role = "code"
autodoc_member_order = "bysource"
autodoc_typehints = "none"
autodoc_default_options = {"members": True, "show-inheritance": True}

html_theme = "furo"
html_title = f"Carom {release}"
html_static_path = [os.environ["CAROM_STATIC"]]
html_copy_source = False
# The search would fetch pages for their first lines, which a page from a file must not.
html_show_search_summary = False
html_show_sourcelink = False
html_css_files = ["carom.css"]
html_js_files = [("live.js", {"defer": "defer"})]
html_theme_options = {
    "light_css_variables": {"font-stack": "system-ui, 'DejaVu Sans', sans-serif"},
}
