"""The site: Sphinx with MyST. ``python -m sphinx -W --keep-going -b html docs site``."""

from __future__ import annotations

import re
import sys
from pathlib import Path

from sphinx.application import Sphinx
from sphinx.util import logging

DOCS = Path(__file__).parent
sys.path.insert(0, str(DOCS))

project = "tactile-graph"
copyright = "the authors of tactile-graph"
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx_design"]
exclude_patterns = ["making", "_build"]
source_suffix = {".md": "markdown"}
suppress_warnings = ["myst.header"]  # a heading level skipped in a docstring's page
nitpicky = False

myst_enable_extensions = ["colon_fence", "deflist", "fieldlist"]
myst_heading_anchors = 4

autodoc_default_options = {"members": True, "show-inheritance": True, "member-order": "bysource"}
autodoc_typehints = "signature"
napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_ivar = True

html_theme = "pydata_sphinx_theme"
html_title = "tactile-graph"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_theme_options = {
    "show_toc_level": 2,
    "navigation_depth": 3,
    "show_nav_level": 1,
    "header_links_before_dropdown": 7,
    "footer_start": ["copyright"],
    "footer_end": [],
    "navbar_end": ["theme-switcher"],
    "secondary_sidebar_items": ["page-toc"],
}
html_sidebars = {page: [] for page in ("tutorial/index", "glossary")}  # nothing is below them
html_show_sourcelink = False
html_copy_source = False
# Addresses beyond this site are not asked for: the build needs no network.
linkcheck_ignore = [r"https?://.*"]

OUTSIDE = re.compile(r"\[([^\]]*)\]\((\.\./(?!docs/)[^)\s]+)\)")


def _name_files_outside(app: Sphinx, docname: str, source: list[str]) -> None:
    """Name files of the checkout that are no pages: a site has nothing to link them to."""
    depth = docname.count("/")
    inside = "../" * (depth + 1)

    def named(found: re.Match[str]) -> str:
        text, to = found[1], found[2]
        if not to.startswith(inside) or to.removeprefix(inside).startswith("../"):
            return found[0]
        place = to.removeprefix(inside)
        return f"`{place}`" if place in text or text.strip("`") == place else f"{text} (`{place}`)"

    source[0] = OUTSIDE.sub(named, source[0])


def _generate(app: Sphinx) -> None:
    from making.generate import generate

    logging.getLogger(__name__).info("catalogue: %s", generate())


def setup(app: Sphinx) -> None:
    """Have the catalogue made before pages are read."""
    app.connect("config-inited", lambda app, _config: _generate(app))
    app.connect("source-read", _name_files_outside)
