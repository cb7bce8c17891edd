"""The report as a real browser shows it: light, dark, on a telephone, and on paper.

Needs Chromium. Where ``VIBRISSA_BROWSER`` names one it must be there; else its absence is a reason
to skip.
"""

import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from compare import compare
from compare.show.animation.plane import write_animation
from compare.show.document import Film
from compare.show.report import write_report
from tests.compare.planted import planted
from tests.conftest import exact_sweep, simulated_sweep

pytestmark = pytest.mark.slow

# What is wider than the window, and in no container that scrolls; which of the film's two is shown.
PROBE = """
  const width = document.documentElement.clientWidth;
  const wide = e =>
    e.getBoundingClientRect().right > width + 1 && !e.parentElement.closest(".scroll, svg");
  const shown = name => getComputedStyle(document.querySelector(name)).display !== "none";
  return {
    width, scroll: document.documentElement.scrollWidth,
    seen: [...document.querySelectorAll("body *")].filter(wide).map(e => e.className),
    moving: shown(".film .moving"), still: shown(".film .still"),
    pictures: [...document.querySelectorAll("svg")].map(e => e.getBoundingClientRect().height),
  };"""
DARK = "--blink-settings=preferredColorScheme=0"
ORANGE = {"light": (0xD5, 0x5E, 0x00), "dark": (0xFF, 0x91, 0x47)}  # the blamed part's bar


@pytest.fixture(scope="module")
def report(tmp_path_factory) -> Path:
    exact, simulated = exact_sweep("catenary"), simulated_sweep("catenary")
    folder = tmp_path_factory.mktemp("report")
    gif, *stills = write_animation(exact, simulated, folder, 48)
    return write_report(compare(exact, simulated), folder, planted(), Film(gif, stills[2]))


@pytest.mark.parametrize("width", [360, 800, 1400])
def test_nothing_sticks_out(probe, report, width):
    found = probe(report, PROBE, width)
    assert found["width"] == width
    assert found["scroll"] <= found["width"]
    assert found["seen"] == []
    assert min(found["pictures"]) > 100
    assert (found["moving"], found["still"]) == (True, False)


def test_what_sticks_out_is_seen_and_who_wants_nothing_to_move_gets_a_still(probe, report):
    wide = "const long = document.body.appendChild(document.createElement('div'));"
    wide += "long.className = long.textContent = 'long'; long.style.width = '60rem';"
    found = probe(report, wide + PROBE, 800, "--force-prefers-reduced-motion")
    assert found["scroll"] > found["width"]
    assert found["seen"] == ["long"]
    assert (found["moving"], found["still"]) == (False, True)


@pytest.mark.parametrize("window", ["1200,2400", "390,4000"])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_screenshot(look, report, tmp_path, scheme, window):
    path = tmp_path / "screenshot.png"
    options = [DARK] if scheme == "dark" else []
    look(report, f"--screenshot={path}", f"--window-size={window}", *options)
    with Image.open(path) as image:
        pixels = np.asarray(image.convert("RGB")).astype(int)
    page = pixels[2, 2]
    assert (page.min() > 240) if scheme == "light" else (page.max() < 40)
    # Text and figures are there all the way down, and stand out from the page.
    bands = np.array_split(np.abs(pixels - page).max(axis=2) > 130, 8)
    assert min(band.mean() for band in bands) > 0.003
    blamed = np.abs(pixels - ORANGE[scheme]).max(axis=2) < 12
    assert blamed.sum() > 3000


def test_on_paper(look, report, tmp_path):
    path = tmp_path / "report.pdf"
    look(report, f"--print-to-pdf={path}", "--no-pdf-header-footer", DARK)
    content = path.read_bytes()
    assert content.startswith(b"%PDF")
    assert len(content) > 100_000
    assert 5 <= len(re.findall(rb"/Type\s*/Page\b", content)) <= 14
    assert report.stat().st_size < 5e6
    assert (report.parent / "animation.gif").stat().st_size < 2.5e6
