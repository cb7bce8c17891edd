"""The view that is turned, in a real browser: without network, without errors, and it moves.

Needs Chromium, as `test_browser` does.
"""

import json
import re

import numpy as np
import pytest
from PIL import Image

from analytic import space
from analytic.space import FootPath, SpatialCase, SpatialReadings, solve_space
from analytic.space.problem.readings import FORCE, MOMENT
from compare import compare
from compare.show.report import write_report
from compare.show.scene import SweepScene, faces_within

CASE = SpatialCase(
    body=space.sphere(1.0, (0.0, 1.4, 0.0)), path=FootPath([[1.3, 0.3], [-1.5, 0.3]], stations=40)
)
# Turns, comes closer, moves the slider, and says what has changed and what the page fetches.
PROBE = """
  const canvas = document.getElementById("scene-canvas"), context = canvas.getContext("2d");
  const seen = () => {
    const colours = {}; let drawn = 0, sum = 0;
    const data = context.getImageData(0, 0, canvas.width, canvas.height).data;
    for (let i = 0; i < data.length; i += 4) if (data[i + 3] > 200) {
      drawn++; sum = (sum * 31 + data[i] + 7 * data[i + 1] + i) % 1e9;
      const c = [data[i], data[i + 1], data[i + 2]].join(); colours[c] = (colours[c] || 0) + 1;
    }
    return {drawn, sum, colours, said: document.getElementById("scene-said").textContent};
  };
  const found = {first: seen()}, slider = document.getElementById("scene-station");
  slider.value = 0; slider.dispatchEvent(new Event("input"));
  found.free = seen();
  const box = canvas.getBoundingClientRect();
  const pointer = (on, name, x, y) => on.dispatchEvent(new PointerEvent("pointer" + name,
    {bubbles: true, pointerId: 1, button: 0, clientX: box.left + x, clientY: box.top + y}));
  pointer(canvas, "down", 100, 100); pointer(window, "move", 180, 130);
  pointer(window, "up", 180, 130);
  found.turned = seen();
  document.querySelector("[data-zoom]").click();
  found.closer = seen();
  const fetched = performance.getEntriesByType("resource").map(e => e.name);
  return {...found, max: Number(slider.max), wrong,
          fetched: fetched.filter(name => !name.startsWith("data:"))};"""


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    exact = solve_space(CASE)
    folder = tmp_path_factory.mktemp("space")
    return write_report(compare(exact, exact), folder, body=CASE.body)


def test_free_air_is_drawn_straight_whatever_the_noise():
    exact = solve_space(CASE)
    random = np.random.default_rng(0)
    columns = {n: exact.values(n) + random.normal(0, 1e-3, 40) for n in (*FORCE, *MOMENT)}
    table = exact.table[[*space.SENSED_IN_SPACE]].assign(**columns)
    scene = SweepScene.of(SpatialReadings(table, exact.beam, exact.tangent), None)
    free = ~exact.touching
    assert free.sum() > 10
    assert (scene.phase == "free")[free].all()
    tips = scene.foot + np.array([0.0, 1.0, 0.0])
    assert np.abs(scene.lines[free, -1] - tips[free]).max() < 1e-12
    assert scene.high[1] == pytest.approx(np.nanmax(scene.lines[:, :, 1]) + 0.1)  # a margin, ...
    assert (scene.high - scene.low)[2] > 0.5  # ... and depth where the way has none


@pytest.mark.slow
def test_it_draws_turns_zooms_and_steps_offline_without_errors(probe, report):
    text = report.read_text(encoding="utf-8")
    assert "import(" not in text
    assert not re.search(r'(src|href)="(?!data:|#)', text)
    found = probe(report, PROBE, 1200)
    assert found["wrong"] == []
    assert found["fetched"] == []
    assert found["max"] == 39
    assert found["first"]["drawn"] > 1000
    assert "tangential" in found["first"]["said"]
    assert "station 1 of 40" in found["free"]["said"]
    for colour in ("213,94,0", "0,114,178"):  # contacts of both phases
        assert found["first"]["colours"].get(colour, 0) > 20
    sums = [found[name]["sum"] for name in ("first", "free", "turned", "closer")]
    assert len(set(sums)) == 4
    assert found["closer"]["drawn"] > 1.1 * found["turned"]["drawn"]


@pytest.mark.slow
def test_paper_has_a_still_in_its_place(look, report, tmp_path):
    shot, pdf = tmp_path / "shot.png", tmp_path / "report.pdf"
    for width in (390, 1200):
        look(report, f"--window-size={width},4000", f"--screenshot={shot}")
        with Image.open(shot) as image:
            assert (np.asarray(image.convert("RGB")).std(axis=(1, 2)) > 5).mean() > 0.3
    look(report, f"--print-to-pdf={pdf}", "--no-pdf-header-footer")
    assert pdf.stat().st_size > 100_000


@pytest.mark.slow
def test_the_page_holds_every_station_and_is_small(report):
    text = report.read_text(encoding="utf-8")
    data = re.search(r'id="scene-data" type="application/json">(.*?)</script>', text)[1]
    assert len(data) < 370_000
    stations = json.loads(data)["stations"]
    assert len(stations) == 40
    assert {one["phase"] for one in stations} == {"free", "tip", "tangent"}
    assert "Zdog v1.1.3" in text
    assert "Licensed MIT" in text


@pytest.mark.parametrize(
    "body",
    [
        space.polyhedron([[x, y, z] for x in (-9, 9) for y in (0.6, 5) for z in (-9, 9)]),
        space.cylinder(0.5, (0, 0.9, 0), (0.2, 0.1, 1)),
        space.sphere(1.0, (0, 1.4, 0)),
    ],
    ids=["wall", "endless", "ball"],
)
def test_a_body_is_cut_where_the_picture_ends_and_closed_there(body):
    low, high = np.array([-1.0, 0.0, -1.0]), np.array([1.0, 1.0, 1.0])
    corners = body.patches(np.zeros(3), 2.0).reshape(-1, 3)
    faces = faces_within(corners, low, high)
    assert len(faces) >= 12
    assert (faces >= low - 1e-9).all()
    assert (faces <= high + 1e-9).all()
    across = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 1])
    middle = faces.reshape(-1, 3).mean(axis=0)
    assert (((faces.mean(axis=1) - middle) * across).sum(axis=1) > -1e-12).all()  # from outside
    assert np.allclose(across.sum(axis=0), 0, atol=1e-9)  # closed
    assert len(faces_within(corners, low - [0, 2, 0], high * [1, -0.1, 1])) == 0
