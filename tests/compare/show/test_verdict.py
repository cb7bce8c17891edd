"""Sentences to act on: they fit whoever made the candidate, and say why something is missing."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import (
    CLAMP_READINGS,
    Case,
    Readings,
    Sweep,
    circle,
    ellipse,
    named_case,
    solve_sweep,
)
from compare import compare
from compare.show.verdict import absent_transitions, why
from tests.compare.show.pages import written_page


def by(source: str, sweep: Readings) -> Readings:
    return replace(sweep, source=source, provenance={})


@pytest.fixture(scope="module")
def exact() -> Readings:
    return solve_sweep(replace(named_case("catenary"), sweep=Sweep(stations=60)))


@pytest.mark.parametrize(
    ("source", "advice", "others"),
    [
        ("measured, rig.csv", "check its units", ("refine", "budget")),
        ("mine", "refine one thing at a time", ("budget",)),
        ("mujoco chain", "vibrissa run CASE --budget", ("refine", "check its units")),
    ],
)
def test_advice_fits_the_source(exact, source, advice, others):
    bent = {
        name: exact.values(name) * (1 + 0.1 * np.sin(5 * (i + 1) * exact.values("foot_x")))
        for i, name in enumerate(CLAMP_READINGS)
    }
    found = compare(exact, by(source, replace(exact, table=exact.table.assign(**bent))))
    assert found.likely is None
    assert advice in why(found)
    assert not any(other in why(found) for other in others)


def test_the_cause_comes_first_and_the_remark_once(exact):
    stiff = exact.table.assign(**{name: 1.02 * exact.values(name) for name in CLAMP_READINGS})
    found = compare(exact, by("mine", replace(exact, table=stiff)))
    for text in (repr(found), written_page(found)):
        assert text.lower().index("likely: flexural") < text.index("force_x")
        assert text.count("a convention for this source") == 1


def test_why_a_sweep_has_no_start_or_end_of_phase_b():
    low = solve_sweep(Case(profile=circle(0.3, (0.0, 0.2)), sweep=Sweep(stations=60)))
    said = " ".join(absent_transitions(compare(low, low)))
    assert "no start of Phase B: the first contact is tangential already" in said
    high = solve_sweep(Case(profile=ellipse((1.0, 0.5), (0.0, 0.9)), sweep=Sweep(stations=60)))
    for line in absent_transitions(compare(high, high)):
        assert line == "analytic has no Phase B: the contact stays at the tip"
    both = solve_sweep(named_case("catenary"))
    assert not [*absent_transitions(compare(both, both))]
