"""One report that many tests look at: with a budget, a film and a name that means mischief.

And a browser that looks at any report.
"""

import json
import os
import re
import shutil
import subprocess
from dataclasses import replace
from html import unescape
from pathlib import Path

import pytest
from PIL import Image

from compare import compare
from compare.comparison import Comparison
from compare.show.document import Film
from compare.show.report import write_report
from tests.compare.planted import planted
from tests.compare.show import sweeps
from tests.compare.show.pages import Page

NASTY = 'a <b>"case"</b> & <script>alert(1)</script> {{ 7 * 7 }} $$ ünder_score'


@pytest.fixture(scope="session")
def film(tmp_path_factory) -> Film:
    folder = tmp_path_factory.mktemp("film")
    film = Film(folder / "film.gif", folder / "still.png")
    for file in (film.gif, film.still):
        Image.new("RGB", (80, 64), "white").save(file)
    return film


@pytest.fixture(scope="session")
def comparison() -> Comparison:
    exact = sweeps.exact("parabola")
    named = replace(exact, provenance={**exact.provenance, "case": NASTY})
    return compare(named, sweeps.candidate("parabola"))


@pytest.fixture(scope="session")
def page(comparison, film, tmp_path_factory) -> Page:
    report = write_report(comparison, tmp_path_factory.mktemp("report"), planted(), film)
    return Page(report.read_text(encoding="utf-8"))


@pytest.fixture(scope="session")
def browser() -> str:
    asked = os.environ.get("VIBRISSA_BROWSER")
    found = shutil.which(asked or "chromium") or (shutil.which("google-chrome") if not asked else 0)
    if not found and asked:
        pytest.fail(f"VIBRISSA_BROWSER names {asked}, which is not installed")
    if not found:
        pytest.skip("no Chromium to look at the report with: install chromium")
    return found


@pytest.fixture
def look(browser, tmp_path):
    """Run the browser on a page; its output."""

    def run(page: Path, *options: str) -> str:
        command = [
            browser, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
            f"--user-data-dir={tmp_path / 'profile'}", *options, page.as_uri(),
        ]  # fmt: skip
        done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)
        return done.stdout

    return run


# A window cannot be as narrow as a telephone, a frame in it can.
FRAME = """<body><script>
addEventListener("message", e => { document.body.dataset.found = e.data; });
</script><iframe src="probed.html" style="width: WIDTHpx; height: 900px; border: 0"></iframe>"""
# Errors are counted from the first script on.
WATCH = """<head><script>
window.wrong = []; addEventListener("error", e => wrong.push(e.message));
</script>"""


@pytest.fixture
def probe(look, tmp_path):
    """What a script finds in a page: the body of a function, run when all is loaded."""

    def run(page: Path, script: str, width: int, *options: str) -> dict:
        probe = f"""<script>addEventListener("load", () => {{
          parent.postMessage(JSON.stringify((() => {{ {script} }})()), "*");
        }});</script></body>"""
        text = page.read_text(encoding="utf-8").replace("<head>", WATCH).replace("</body>", probe)
        (tmp_path / "probed.html").write_text(text, encoding="utf-8")
        (tmp_path / "frame.html").write_text(FRAME.replace("WIDTH", str(width)))
        window = ("--window-size=1600,1000", "--virtual-time-budget=5000", "--dump-dom")
        seen = look(tmp_path / "frame.html", *window, *options)
        return json.loads(unescape(re.search(r'data-found="([^"]*)"', seen)[1]))

    return run
