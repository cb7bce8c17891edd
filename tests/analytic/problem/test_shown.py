"""What values show of themselves, and what errors suggest."""

import subprocess
import sys

import numpy as np
import pytest
from matplotlib.figure import Figure

from analytic import (
    CLAMP_READINGS,
    Readings,
    calibrate,
    find_events,
    named_case,
    solve_sweep,
)
from analytic.space import FootPath, SpatialCase, solve_space, sphere
from compare import compare
from tests.analytic.problem.given import refusal


def shown() -> list[object]:
    case = named_case("catenary")
    path = FootPath([[1, 0.2], [-1, 0.2]], stations=12)
    in_space = SpatialCase(body=sphere(1.0, centre=(0, 1.4, 0)), path=path)
    swept, spatial = solve_sweep(case), solve_space(in_space)
    fitted = calibrate(swept, case, ["flexural_rigidity", "friction"], {"force_x": 1e-2})
    found = [case, named_case("whisk-catenary"), in_space, swept, spatial]
    found += [find_events(case.profile, case.beam), fitted]
    return [*found, compare(swept, swept), compare(spatial, spatial)]


@pytest.mark.slow  # nine pictures
def test_a_line_or_a_screen_and_tiles_with_a_picture():
    for value in shown():
        assert len(repr(value)) < 1000, repr(value)
        assert "object at" not in repr(value)
        assert "functools" not in repr(value)
        page = value._repr_html_()
        assert page.startswith("<div")
        assert "data:image/png;base64," in page
        assert len(page) < 150_000


def test_what_is_drawn_is_in_the_units_of_the_case():
    outline, way, *_ = named_case("catenary").plot(Figure().subplots()).lines
    assert outline.get_ydata().min() == pytest.approx(0.2)
    np.testing.assert_allclose(way.get_ydata(), 0.0)
    whisk = solve_sweep(named_case("whisk-catenary"))
    line = whisk.plot(Figure().subplots(3))[0].lines[0]
    np.testing.assert_array_equal(line.get_xdata(), whisk.clamp_angle)


def test_events_lie_on_the_readings():
    case = named_case("parabola")
    axes = Figure().subplots(3)
    solve_sweep(case).plot(axes)
    find_events(case.profile, case.beam).plot(axes)
    curve, *events, _ = axes[1].lines  # next to the snap-off, the last, the force has no bound
    for event in events:
        at, value = event.get_xdata()[0], event.get_ydata()[0]
        near = np.argmin(np.abs(curve.get_xdata() - at))
        beside = curve.get_ydata()[[max(near - 1, 0), near, min(near + 1, 199)]]
        assert abs(beside - value).min() < 0.02 * curve.get_ydata().max()


def test_who_only_solves_loads_no_pictures():
    code = (
        "import sys; from analytic import named_case, solve_sweep; "
        "repr(solve_sweep(named_case('parabola'))); "
        "print([name for name in ('matplotlib', 'mujoco') if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


@pytest.mark.parametrize(
    ("wrong", "near"),
    [
        (lambda: named_case("catenery"), "did you mean catenary?"),
        (
            lambda: Readings.of({name: [1, 0] for name in ("footx", *CLAMP_READINGS)}),
            "add foot_x (is it footx?)",
        ),
        (lambda: named_case("q"), "`compare.load_case` reads a TOML file"),
    ],
)
def test_errors_suggest_the_nearest_name(wrong, near):
    assert near in refusal(wrong)
