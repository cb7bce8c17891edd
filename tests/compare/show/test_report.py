"""The report: one offline page with the verdict first, whatever the case is called."""

import base64
import re
from datetime import datetime

import numpy as np
import pytest
from markupsafe import escape
from matplotlib.figure import Figure

from compare import Tolerances
from compare.explain.fit import Suspect
from compare.show.budgets import bars
from compare.show.page import inline_svg
from compare.show.verdict import verdict
from tests.compare.planted import planted

ELSEWHERE = re.compile(r"(?:https?:)?//(?!www\.w3\.org/(?:1999/xlink|2000/svg)\")[a-z]")


def test_it_is_one_offline_file(page, film):
    assert page.faults == []
    assert len(page.text.encode()) < 3e6  # leaves 2 MB for a real animation
    assert all(a.startswith(("#", "data:image/")) for a in page.addresses), page.addresses
    without_pictures = re.sub(r"base64,[A-Za-z0-9+/=]*", "", page.text)
    assert ELSEWHERE.findall(without_pictures) == []
    assert "@import" not in page.text
    assert not page.all("script", "link", "iframe", "object")
    for file, kind in ((film.gif, "gif"), (film.still, "png")):
        inside = base64.b64encode(file.read_bytes()).decode()
        assert f"data:image/{kind};base64,{inside}" in page.text


def test_the_verdict_comes_first(page, comparison):
    body = page.text[page.text.index("<body>") :]
    first = body.index("mujoco chain agrees with analytic.")
    for later in ("<nav", "<table", "<svg", "<img", "<h2"):
        assert first < body.index(later), later
    assert page.ids.index("verdict") < page.ids.index("budget")
    assert escape(verdict(comparison, planted())) in body


def test_links_lead_somewhere(page):
    """Those of the contents, and those inside pictures."""
    links = [a["href"].removeprefix("#") for a in page.all("a")]
    assert links == [
        "budget", "apart", "sweep", "phases", "snap-off", "convergence", "tolerances", "settings",
    ]  # fmt: skip
    used = re.findall(r"url\(#([^)]+)\)", page.text)
    used += [a["xlink:href"].removeprefix("#") for a in page.all("use")]
    assert used
    assert {*links, *used} <= set(page.ids)
    assert len(page.ids) == len(set(page.ids))


def test_those_who_cannot_see_get_a_description(page):
    assert page.all("html")[0]["lang"] == "en"
    assert all(img.get("alt") for img in page.all("img"))
    assert all(svg.get("aria-label") and svg.get("role") == "img" for svg in page.all("svg"))
    levels = [int(tag[1]) for tag, _ in page.elements if re.fullmatch(r"h[1-6]", tag)]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all(np.diff(levels) <= 1)


def test_what_the_last_sections_hold(page):
    before, limits = page.text.split('id="tolerances"')
    limits, settings = limits.split('id="settings"')
    assert limits.count("<tr>") == 1 + len(Tolerances().limits())
    assert "like a square root" in limits
    for said in (f"NumPy {np.__version__}", "SciPy", str(datetime.now().year), "mujoco"):
        assert said in settings
    assert "<script" not in page.text  # the case's name
    assert "&lt;script&gt;alert(1)&lt;/script&gt; {{ 7 * 7 }}" in before


@pytest.mark.parametrize(
    ("budget", "said"),
    [
        (planted(), "which 80 segments instead of 40 would bring to about 2.5e-4."),
        (planted("unexplained", closes=False), "neither the numerics nor a known fault"),
        (
            planted("unexplained", suspects=(Suspect("length", 0.004, 0.99),)),
            "length does if it is +0.40% off in mujoco chain: check it.",
        ),
        (
            planted(unexplained=3e-4, closes=False),
            "2.5e-4, but 3.0e-4 +- 3.0e-5 stays unexplained.",
        ),
    ],
)
def test_the_verdict_can_be_acted_on(comparison, budget, said):
    sentence = verdict(comparison, budget)
    assert said in sentence
    assert sentence.count(".", 0, -1) == sentence.count("e-") + sentence.count("+0.")  # one only


def test_the_budgets_picture_sorts_and_marks():
    (ax,) = bars(planted("facets"), "force_x").axes
    names = [label.get_text() for label in ax.get_yticklabels()]
    assert (names[0], names[-1]) == ("facets", "unexplained")
    (blamed, unexplained) = ax.patches[1:]  # bars; the others are too small for one
    assert blamed.get_x() + blamed.get_width() == pytest.approx(1e-3)
    assert unexplained.get_x() + unexplained.get_width() == pytest.approx(2e-5)


def test_pictures_take_the_pages_colours(page):
    drawn = page.text[page.text.index("<svg") :]
    assert "currentColor" in drawn
    assert "var(--orange)" in drawn
    for themed in ("#d55e00", "#0072b2", "#000000"):
        assert themed not in drawn


def test_the_same_picture_is_the_same_text():
    svg, again = (inline_svg(Figure((1, 1)), "one", 'it says "this"') for _ in range(2))
    assert 'aria-label="it says &#34;this&#34;"' in svg
    assert svg == again
