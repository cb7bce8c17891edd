"""The pages as a site: `make docs`."""

import re
import runpy
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

from tests.documentation.blocks import PAGES, ROOT

ASSET = re.compile(r"<(?:script|img|link|iframe)\b[^>]*?(?:src|href)=\"?(https?:[^\"\s>]+)")


def test_every_page_is_in_the_table_of_contents():
    pytest.importorskip("sphinx")
    nav = runpy.run_path(str(ROOT / "docs" / "conf.py"))["NAV"]
    listed = {Path(f"{page}.md") for pages in nav.values() for page in pages.split()}
    assert {*PAGES} - {Path("docs/release/paper.md")} <= {Path("README.md"), *listed}


@pytest.mark.slow
def test_the_site_is_whole_and_needs_no_net(tmp_path):
    """No link is broken, every public name is described, and nothing is loaded from elsewhere."""
    pytest.importorskip("sphinx")
    options = ["-W", "--keep-going", "-q", "-c", "docs", "."]
    done = subprocess.run(
        [sys.executable, "-m", "sphinx", *options, tmp_path / "site"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    pages = list((tmp_path / "site").rglob("*.html"))
    assert {"index.html", "api.html", "search.html"} <= {page.name for page in pages}
    outside = {url for page in pages for url in ASSET.findall(page.read_text(encoding="utf-8"))}
    assert not outside
    reference = (tmp_path / "site" / "docs" / "api.html").read_text(encoding="utf-8")
    for package in ("analytic", "analytic.space", "mujoco_models", "engines", "compare"):
        names = [f"{package}.{name}" for name in import_module(package).__all__]
        assert not [name for name in names if f'id="{name}"' not in reference]
