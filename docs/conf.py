"""Sphinx settings; the pages of models and mechanisms are written from the declarations at build time."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
sys.path.insert(0, str(HERE.parent))

from declared import write_pages  # noqa: E402

project = "rocking-study"
author = "the rocking-study authors"
copyright = "2026, the rocking-study authors"
extensions = ["myst_parser", "sphinx.ext.mathjax", "sphinx.ext.autodoc"]
myst_enable_extensions = ["dollarmath", "deflist", "colon_fence"]
myst_heading_anchors = 3
exclude_patterns = ["_build", "_static", "tables"]
html_theme = "furo"
html_title = "rocking-study"
html_static_path = ["_static"]
html_css_files = ["tables.css"]
autodoc_typehints = "description"
suppress_warnings = ["myst.header"]

write_pages(HERE / "generated")


def copy_gallery(app: Any, error: Exception | None) -> None:
    """The reports lie beside the pages as they do in the repository, so that links to them work in both."""
    if error is None:
        shutil.copytree(HERE / "gallery", Path(app.outdir) / "gallery", dirs_exist_ok=True)


def setup(app: Any) -> None:
    app.connect("build-finished", copy_gallery)
