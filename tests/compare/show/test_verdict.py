"""Sentences to act on: they fit whoever made the candidate, and say why something is missing."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CLAMP_READINGS, Case, Readings, Sweep, circle, ellipse, solve_sweep
from compare import compare
from compare.explain.likely import to_find_out
from compare.show.verdict import absent_transitions, why
from tests.compare.show import sweeps
from tests.compare.show.pages import written_page


def by(source: str, change) -> Readings:
    """Readings of a source, each of them changed."""
    exact = sweeps.exact("catenary")
    values = {name: change(i) * exact.values(name) for i, name in enumerate(CLAMP_READINGS, 1)}
    return replace(exact, table=exact.table.assign(**values), source=source, provenance={})


@pytest.fixture(scope="module")
def bent():
    """A comparison with a sweep that looks like no known fault."""
    foot_x = sweeps.exact("catenary").values("foot_x")
    off = by("mine", lambda i: 1 + 0.1 * np.sin(5 * i * foot_x))
    found = compare(sweeps.exact("catenary"), off)
    assert found.likely is None
    return found


@pytest.mark.parametrize(
    ("source", "advice", "others"),
    [
        ("measured, rig.csv", "check its units", ("refine", "budget")),
        ("mine", "refine one thing at a time", ("budget",)),
        ("mujoco chain", "vibrissa run CASE --budget", ("refine", "check its units")),
    ],
)
def test_advice_fits_the_source(bent, source, advice, others):
    found = replace(bent, candidate=replace(bent.candidate, source=source))
    vars(found)["likely"] = None  # for nothing else has changed
    assert advice in why(found)
    assert not any(other in why(found) for other in others)


@pytest.mark.parametrize(
    ("reference", "motion", "advised"),
    [
        ({}, None, True),
        ({"others": [[[0.0, 1.0], [0.0, 1.0]]]}, None, False),
        ({"support": {"friction": 0.0}}, {"average": 1.0}, True),
        ({"support": {"friction": 0.2}}, {"average": 1.0}, False),
    ],
)
def test_a_budget_is_advised_where_there_is_one(bent, reference, motion, advised):
    """With friction it was advised, and refused."""
    moved = replace(bent.candidate, source="mujoco chain", provenance={"motion": motion})
    said = to_find_out(replace(bent.reference, provenance=reference), moved)
    assert ("--budget" in said) == advised


@pytest.mark.parametrize(("radii", "said"), [(0.04, False), (0.08, True)])
def test_a_contact_that_sinks_is_said_where_nothing_else_shows(bent, radii, said):
    """Past a corner, 0.05 radii in rms are the least limit; 0.4 moved readings by 8e-2."""
    depth = np.where(bent.reference.table["phase"] == "free", 0.0, radii * 0.005)
    soft = replace(bent.candidate, table=bent.candidate.table.assign(penetration=depth))
    advice = to_find_out(bent.reference, soft)
    assert ("the contact sinks by up to 0.08 radii (at foot_x = " in advice) == said
    assert ("3.2 times as stiff, in motion in steps 0.56 times as long" in advice) == said


def test_the_cause_comes_first_and_the_remark_once():
    found = compare(sweeps.exact("catenary"), by("mine", lambda i: 1.02))
    for text in (repr(found), written_page(found)):
        assert text.lower().index("likely: flexural") < text.index("force_x")
        assert text.count("a convention for this source") == 1
    assert found._below().count("<br>") == len([*found.lines()]) - 1 < 24
    assert [len(ax.lines) for ax in found.plot()] == [2, 2, 2]


@pytest.mark.parametrize(
    ("contour", "said"),
    [
        (circle(0.3, (0.0, 0.2)), "no start of Phase B: the first contact is tangential already"),
        (ellipse((1.0, 0.5), (0.0, 0.9)), "analytic has no Phase B: the contact stays at the tip"),
        (circle(1.0, (0.0, 0.4)), ""),
    ],
)
def test_why_a_sweep_has_no_start_or_end_of_phase_b(contour, said):
    exact = solve_sweep(Case(profile=contour, sweep=Sweep(stations=60)))
    lines = [*absent_transitions(compare(exact, exact))]
    assert all(said in line for line in lines)
    assert bool(lines) == bool(said)
