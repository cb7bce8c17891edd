"""What a walk over an engine's stations makes of the states that it is given."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import Case, InputError, Sweep, circle
from engines.stations import Row, sweep_stations

CASE = Case(profile=circle(1.0, (0.0, 0.4)), sweep=Sweep(20))
LOADED = Row(force_x=-0.5, force_y=1.0, moment_z=0.3, phase="tip", contact_angle=0.1, tip_angle=1.6)


class Given:
    """Rest in one state up to a place, and in another one from there on."""

    def __init__(self, after: Row | None, turns: float) -> None:
        self._after, self._turns = after, turns

    def at(self, foot_x: float) -> Row | None:
        return LOADED if foot_x > self._turns else self._after

    def accept(self) -> None:
        pass


def swept(after):
    turns = float(CASE.foot_x[10]) - 0.01
    return turns, sweep_stations(CASE, lambda _: Given(after, turns), "given", {"engine": "given"})


def test_an_engine_that_lets_go_snaps_off_there():
    turns, found = swept(Row(tip_angle=np.pi / 2))
    assert abs(found.provenance["events"]["snap_off"] - turns) < 1e-4
    assert found.trusted.all() and (found.table["phase"][11:] == "free").all()


def test_what_the_engine_itself_doubts_is_no_snap_off():
    """Free or not: from there on stations are unsettled, for the engine's own reason."""
    for doubted in (Row(tip_angle=np.pi / 2), replace(LOADED, contact_angle=1.2)):
        _, found = swept(replace(doubted, doubt="springs and clamp disagree"))
        assert found.provenance["events"]["snap_off"] is None
        assert (found.table["status"][11:] == "unsettled").all()
        assert found.provenance["unsettled"] == {"springs and clamp disagree": 9}


def test_no_state_at_all_is_said_in_other_words():
    _, found = swept(None)
    (reason,) = found.provenance["unsettled"]
    assert "no neighbour" in reason and found.provenance["events"]["snap_off"] is None


def test_a_state_without_a_number_is_said_to_be_one():
    """In contact or free: neither a snap-off nor a solver that found nothing."""
    for row in (replace(LOADED, force_x=np.nan, moment_z=np.inf), Row(*[np.nan] * 3)):
        turns, found = swept(row)
        (reason,) = found.provenance["unsettled"]
        assert reason.startswith(f"at(foot_x={turns:.4g}) gave no number in force_x")
        assert "moment_z" in reason and found.provenance["events"]["snap_off"] is None


def test_what_is_no_state_is_named():
    assert Row(force_x=np.array([-0.5])).force_x == -0.5
    with pytest.raises(InputError, match=r"Row.moment_z = \[1, 2\]: must be a number"):
        Row(moment_z=[1, 2])
    with pytest.raises(InputError, match="what `at` returned = a tuple: must be a Row"):
        swept((0.0, 0.0, 0.0))
