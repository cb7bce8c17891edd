"""Random meshes from files, MuJoCo in space against the closed form."""

import pytest

from tests.fuzz.space import KINDS, main


@pytest.mark.slow
@pytest.mark.parametrize(
    "seed",
    [
        *(100, 101, 107, 148),  # a ball, an egg, a hull, a capsule
        2006,  # a contact that leaves a face slowly, next to its edge
        138,  # a side that slides over corners, on several links at a time
        *(pytest.param(seed, marks=pytest.mark.trial) for seed in (105, 120)),  # the last two again
        122,  # along an edge, so slowly that the foot goes on
        2008,  # a tip that lands next to the limit of 0.12 L
        93094,  # a vibrissa drawn off an edge, whose tip lands on a face
        99024,  # what lands at 0.1203 L: its motion says whether it does
        92107,  # a side that comes over a corner: an edge holds it, and a face beyond its tip
        108040,  # a tip goes over a face and is a side where the next edge holds it
        102020,  # the way down ends at a tip: Newton's method begins with its rotation
        100038,  # a side that turns about a corner, faster than its contact moves on the parallel
        700054,  # an edge that is there twice: its two triangles are not quite in one plane
        900125,  # a tip on an edge whose faces lead to each other
        900069,  # faces lead too far away, where the way down has an edge that holds
        900247,  # a fall from a corner that begins slowly
        110081,  # a station where a tip passes an edge
    ],
)
def test_a_mesh_has_no_silent_error(seed):
    (outcome,) = main(1, seed)
    wrong = {"silent", "lost", "rms", "slip-off", "unsettled"}
    assert not wrong & set(outcome.flags), outcome


@pytest.mark.trial
@pytest.mark.parametrize("kind", KINDS)
def test_no_station_is_ok_and_on_another_branch(kind):
    outcomes = main(10, 1_000, kind)
    assert not any({"silent", "lost", "rms"} & set(outcome.flags) for outcome in outcomes)
    assert sum(outcome.statuses.get("unsettled", 0) for outcome in outcomes) <= 6  # of 600
    # Which facet a side comes to that slides over a corner may hang on the last 1e-4 L.
    assert sum("slip-off" in outcome.flags for outcome in outcomes) <= 1
