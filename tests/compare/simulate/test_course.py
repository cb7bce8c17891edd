"""A centreline that is stepped or kinked is named, and one that is smooth gets its own case."""

import re
from dataclasses import replace

import numpy as np
import pytest

from analytic import Beam
from compare.simulate.course import curvature
from compare.simulate.fixing import case_of
from compare.simulate.inspection import Inspection
from mujoco_models import inspect_model
from tests.compare.simulate.faults import STATED, faults_in
from tests.mujoco_models.inspect.chains import OnRail


def stepped(folder, link, aside, up=0.0, links=20):
    """Where the body of a link is aside, and the geom of the one before goes there."""
    path, at = OnRail(links=links).write(folder), f"{1 / links!r} 0"
    text = path.read_text().replace(
        f'name="whisker{link}" pos="0 {at}"', f'name="whisker{link}" pos="{aside} {1 / links} {up}"'
    )
    geom = f'name="whisker-geom{link - 1}" fromto="0 0 0 '
    assert f"{geom}0 {at}" in text
    path.write_text(text.replace(f"{geom}0 {at}", f"{geom}{aside} {1 / links} {up}"))
    return path


def curved(folder, turn, links=20):
    """Each link turned against the one before by a curvature at its joint [1/L]."""
    path = OnRail(links=links).write(folder)

    def turned(found):
        return f'{found[0]} euler="0 0 {turn((int(found[1]) - 0.5) / links) / links}"'

    path.write_text(re.sub(r'<body name="whisker(\d+)"', turned, path.read_text()))
    return path


@pytest.mark.parametrize("links", [10, 20, pytest.param(40, marks=pytest.mark.slow)])
@pytest.mark.parametrize("aside", [3e-3, -3e-3, 0.01, 0.02])
@pytest.mark.parametrize("at", [0.2, 0.5, 1.0])
def test_a_body_that_is_stepped_aside_is_named(tmp_path, links, aside, at):
    """At 3e-3 L, readings are 0.9 per cent off, at 0.01 L 3.

    By most of a link's length it makes that link longer, too, and with it the vibrissa.
    """
    link = round(at * links)
    found = Inspection(inspect_model(stepped(tmp_path, link, aside, links=links)), STATED)
    said = next(fault for fault in found.faults if fault.subject == "centreline")
    assert float(re.findall(r"by (\S+) L", said.text)[0]) == pytest.approx(abs(aside), rel=0.06)
    assert f"most at 'whisker{link}'" in said.text
    assert abs(aside) * links > 0.5 or found.faults == (said,)


def test_a_step_along_the_hinges_bends_as_a_straight_vibrissa(tmp_path):
    """Swept, it is as one without: 3e-3."""
    assert Inspection(inspect_model(stepped(tmp_path, 10, 0.0, up=0.01)), STATED).sound


def test_a_vibrissa_out_of_its_plane_is_named(tmp_path):
    path = OnRail().write(tmp_path)
    text = path.read_text()
    path.write_text(text.replace('name="whisker10"', 'name="whisker10" euler="0.15 0 0"'))
    said = next(fault for fault in Inspection(inspect_model(path)).faults if fault.remedy)
    assert "0.078 L off the plane" in said.text


@pytest.mark.parametrize(("axis", "said"), [("0 0.1 1", None), ("0 0.4 1", "lean 22 degrees")])
def test_hinges_that_lean_along_it_are_named(tmp_path, axis, said):
    path = OnRail().write(tmp_path, ('<joint axis="0 0 1"', f'<joint axis="{axis}"'))
    faults = Inspection(inspect_model(path)).faults
    assert [fault.subject for fault in faults] == ([] if said is None else ["plane"])
    assert all(said in fault.text for fault in faults)


@pytest.mark.parametrize("degrees", [1, 5, 20, 60])
def test_hinges_that_are_turned_about_it_are_no_fault_of_slide_or_sensors(tmp_path, degrees):
    """They bend it out of the plane in which slide and sensors are."""
    turn = np.deg2rad(degrees)
    axis = f"{np.sin(turn)} 0 {np.cos(turn)}"
    path = OnRail().write(tmp_path, ('<joint axis="0 0 1"', f'<joint axis="{axis}"'))
    (said,) = Inspection(inspect_model(path)).faults
    assert f"{degrees} degrees out of the plane in which the vibrissa bends ('rail')" in said.text
    assert "axes of the vibrissa's joints" in said.remedy
    assert not said.edits


@pytest.mark.parametrize(
    ("way", "degrees"), [("1 0.1 0", "5.7"), ("-1 0.3 0", "17"), ("0.1 1 0", "84"), ("0 1 0", "90")]
)
def test_a_slide_that_leans_is_named_by_its_own_name(tmp_path, way, degrees):
    """By more than 2.5 degrees nothing could move the foot, it was said, and its clamp gave way."""
    path = OnRail().write(tmp_path, ('type="slide" axis="1 0 0"', f'type="slide" axis="{way}"'))
    (said,) = Inspection(inspect_model(path)).faults
    assert f"its slide is {degrees} degrees from across the vibrissa" in said.text
    assert "('rail')" in said.text


@pytest.mark.parametrize("turn", [lambda s: s, lambda s: s - 0.5, lambda s: 2 * s**2])
def test_a_smooth_course_is_sound_and_its_case_has_it(tmp_path, turn):
    """Of curvatures as others measure them: none at the clamp, or an S."""
    found = inspect_model(curved(tmp_path, turn))
    assert Inspection(found).sound
    s, own = np.array(curvature(found, 21)).T
    np.testing.assert_allclose(own, turn(s / found.length) / found.length, atol=0.05)
    assert "natural_curvature = [[0," in case_of(found, tmp_path / "whisker.xml", {})
    stated = replace(STATED, natural_curvature=turn)
    assert Inspection(found, stated).sound
    mean = Beam(natural_curvature=found.natural_curvature)
    assert faults_in(Inspection(found, mean)) == {"natural curvature"}


@pytest.mark.parametrize("turned", [-1.5, 1.0, 2.0])
@pytest.mark.parametrize("links", [12, 20])
def test_an_arc_whose_foot_goes_on_as_its_first_link_is_sound(tmp_path, turned, links):
    """The piece on the foot points elsewhere by a link's turn, and is its first half cell."""
    found = inspect_model(curved(tmp_path, lambda s: turned, links))
    assert Inspection(found).sound
    assert found.length == pytest.approx(1)
    assert found.natural_curvature == pytest.approx(turned)


def test_an_arc_is_one_number(tmp_path):
    assert curvature(inspect_model(OnRail(curvature=0.5).write(tmp_path)), 21) == pytest.approx(0.5)


DEGREE = np.pi / 180


@pytest.mark.parametrize(
    ("curvature", "stated", "faults", "said"),
    [
        (1 / DEGREE, None, {"springref"}, ("2.865 rad at a joint", 'springref="0.05"')),
        (DEGREE, Beam(natural_curvature=1.0), {"natural curvature"}, ('springref="2.865"',)),
        (DEGREE, None, set(), ('springref="2.865"',)),
        (0.3, Beam(natural_curvature=1.0), {"natural curvature"}, ()),
        (3.0, None, set(), ()),
    ],
)
def test_degrees_for_radians_in_springref_are_one_line(tmp_path, curvature, stated, faults, said):
    found = Inspection(inspect_model(OnRail(curvature=curvature).write(tmp_path)), stated)
    assert faults_in(found) == faults
    (line,) = map(str, found.remarks)
    assert all(words in line for words in said)
    assert bool(said) == ("springref" in line)


@pytest.mark.parametrize("links", [12, 40])
@pytest.mark.parametrize(
    ("turns", "kinked"),
    [({0.5: 0.05}, True), ({0.8: 0.05}, True), ({0.5: 0.015}, False),
     ({0.3: 0.016, 0.6: -0.016, 0.8: 0.016}, True)],
)  # fmt: skip
def test_a_kink_by_which_readings_are_off_is_named(tmp_path, links, turns, kinked):
    """By 0.05 rad in the middle of twenty links they were 0.8 per cent off, and it was sound."""
    path = OnRail(links=links).write(tmp_path)
    text = path.read_text()
    for share, turn in turns.items():
        start = f'<body name="whisker{round(share * links)}" '
        text = text.replace(start, f'{start}euler="0 0 {turn}" ')
    path.write_text(text)
    assert faults_in(Inspection(inspect_model(path))) == ({"centreline"} if kinked else set())
