"""What the terminal says of stations that are not to be trusted."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CLAMP_READINGS, reconstruct
from compare.commands.sweeping import note_rows, print_reconstruction, print_sweep
from compare.sense.record import without_dropouts
from tests.conftest import exact_sweep


@pytest.mark.parametrize("known", [True, False])
def test_no_readings_is_said_of_none_only(known, capsys):
    """MuJoCo has readings where the vibrissa touches again, the closed form has none."""
    exact = exact_sweep("parabola")
    again = np.arange(200) // 20 == 4
    table = exact.table.assign(status=np.where(again, "touches again", "ok"))
    if not known:
        table.loc[again, list(CLAMP_READINGS)] = np.nan
    print_sweep(replace(exact, table=table))
    said = capsys.readouterr().out
    assert "20 touches again (foot_x" in said
    assert "another part of the vibrissa touches the object, or would lie in it" in said
    assert ("no readings" in said) != known


def test_points_are_counted_by_phase(capsys):
    exact = exact_sweep("parabola")
    status = np.where(np.arange(200) == 90, "unsettled", "ok")
    spoilt = replace(exact, table=exact.table.assign(status=status))
    points = reconstruct(spoilt)
    print_reconstruction(spoilt, points, "elastica")
    said = capsys.readouterr().out
    for phase in ("free", "tip", "tangent"):
        assert f"{(points['phase'] == phase).sum()} {phase}" in said
    assert "1 not used" in said


def test_dropouts_are_named(capsys):
    exact = exact_sweep("parabola")
    table = exact.table.copy()
    table.loc[range(60, 110, 5), list(CLAMP_READINGS)] = 0.0
    note_rows(without_dropouts(replace(exact, table=table)))
    assert "10 rows filled with zeros amid contact were left out" in capsys.readouterr().err
