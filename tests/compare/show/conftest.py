"""One report that many tests look at: with a budget, a film and a name that means mischief."""

from dataclasses import replace

import pytest
from PIL import Image

from compare import compare
from compare.comparison import Comparison
from compare.show.report import Film, write_report
from tests.compare.planted import planted
from tests.compare.show import sweeps
from tests.compare.show.pages import Page

NASTY = 'a <b>"case"</b> & <script>alert(1)</script> {{ 7 * 7 }} $$ ünder_score'


@pytest.fixture(scope="session")
def film(tmp_path_factory) -> Film:
    folder = tmp_path_factory.mktemp("film")
    Image.new("RGB", (80, 64), "white").save(folder / "film.gif")
    Image.new("RGB", (80, 64), "white").save(folder / "still.png")
    return Film(folder / "film.gif", folder / "still.png")


@pytest.fixture(scope="session")
def comparison() -> Comparison:
    exact = sweeps.exact("parabola")
    named = replace(exact, provenance={**exact.provenance, "case": NASTY})
    return compare(named, sweeps.candidate("parabola"))


@pytest.fixture(scope="session")
def page(comparison, film, tmp_path_factory) -> Page:
    report = write_report(comparison, tmp_path_factory.mktemp("report"), planted(), film)
    return Page(report.read_text(encoding="utf-8"))
