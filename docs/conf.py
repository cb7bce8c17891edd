"""The pages that stand beside the code, and an API reference, as a site: `make docs`."""

import shutil
from importlib import metadata
from pathlib import Path

from sphinx.application import Sphinx

NAV = {
    "Start": "docs/tutorial docs/glossary docs/gallery/README results/README",
    "Closed form": (
        "analytic/README analytic/case-file analytic/reconstruct analytic/methods "
        "analytic/real-vibrissa analytic/two-contacts analytic/there-and-back "
        "analytic/who-does-not-know analytic/calibrate analytic/out-of-plane"
    ),
    "In space": (
        "analytic/space analytic/space-mujoco analytic/space-friction analytic/space-compare"
    ),
    "MuJoCo": (
        "mujoco_models/README mujoco_models/at-rest mujoco_models/motion mujoco_models/quasi-static"
    ),
    "Your MuJoCo model": (
        "docs/clinic/inspect docs/clinic/robot docs/clinic/too-stiff docs/clinic/bend-and-twist "
        "docs/clinic/tapered-joints docs/clinic/contact docs/clinic/chatter "
        "docs/clinic/single-precision docs/clinic/another-engine"
    ),
    "Other engines": (
        "engines/README docs/examples/engine/README docs/evaluations/README results/league "
        "docs/reports/pyelastica-rod-cylinder-contact"
    ),
    "Compare": (
        "compare/README compare/files compare/gates compare/validation compare/budget "
        "compare/study/README docs/examples/rig/README docs/examples/measured/README "
        "tests/examples/README"
    ),
    "Trust": "compare/verify docs/examples/reference/README tests/bench/README",
    "Reference": "docs/api CONTRIBUTING docs/release/README CHANGELOG",
}
"""Pages by heading, from the top folder."""

project = "vibrissa-testbed"
copyright = "the vibrissa-testbed developers"  # Sphinx's name
root_doc = "README"
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
include_patterns = [f"{page}.*" for pages in NAV.values() for page in pages.split()]
include_patterns += ["README.md", "results/*.png", "docs/gallery/*.png"]
exclude_patterns = ["**/*.py", "**/*.toml", "**/*.csv"]
html_theme = "furo"
html_static_path, html_css_files = ["site.css"], ["site.css"]
version = metadata.version(project)
html_title = f"{project} {version}"
html_show_sphinx = html_copy_source = html_show_sourcelink = False
myst_heading_anchors = 3
default_role = "py:obj"
highlight_language = "text"  # a block without a language is what a command prints
# Names in docstrings are links only where they are of one thing; models on pages have gaps.
suppress_warnings = ["ref.python", "misc.highlighting_failure"]
autodoc_typehints = "none"
autodoc_member_order = "alphabetical"
napoleon_use_rtype = False


def setup(app: Sphinx) -> None:
    """Give the front page the table of contents, which its readers elsewhere need not see."""
    app.connect("source-read", _with_contents)
    app.connect("build-finished", _index)


def _with_contents(_: Sphinx, page: str, source: list[str]) -> None:
    if page == root_doc:
        for title, pages in NAV.items():
            below = "\n".join(f"/{name}" for name in pages.split())
            source[0] += f"\n\n```{{toctree}}\n:hidden:\n:caption: {title}\n\n{below}\n```\n"


def _index(app: Sphinx, error: Exception | None) -> None:
    if error is None:
        shutil.copy(Path(app.outdir) / f"{root_doc}.html", Path(app.outdir) / "index.html")
