"""At rest only springs and contacts count: nothing that belongs to the way there."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CASE_NAMES, CLAMP_READINGS, named_case
from mujoco_models import Settings, available_beams, simulate_sweep
from tests.conftest import simulated_sweep


def changed(quantity, factor):
    """`add_options`, with the time step, all masses or all armatures changed by a factor."""
    from mujoco_models.model import model

    usual = model.add_options

    def add_options(spec):
        usual(spec)
        if quantity == "time step":
            spec.option.timestep *= factor
        elif quantity == "mass":
            for geom in spec.geoms:
                geom.mass *= factor
        else:
            for joint in spec.joints:
                joint.armature *= factor

    return add_options


@pytest.fixture(scope="module", params=available_beams())
def usual(request):
    case = named_case("parabola")
    case = replace(case, sweep=replace(case.sweep, stations=25))
    settings = Settings(beam=request.param, segments=20)
    return case, settings, simulate_sweep(case, settings)


@pytest.mark.parametrize("factor", [0.1, 10])
@pytest.mark.parametrize("quantity", ["time step", "mass", "armature"])
def test_readings_do_not_depend_on(quantity, factor, usual, monkeypatch):
    case, settings, expected = usual
    monkeypatch.setattr("mujoco_models.model.model.add_options", changed(quantity, factor))
    found = simulate_sweep(case, settings)
    assert (found.table["status"] == "ok").all()
    # Both are out of balance by up to the tolerance; levers are of the order of L.
    for name in CLAMP_READINGS:
        scale = 1 + np.abs(expected.values(name)).max()
        error = np.abs(found.values(name) - expected.values(name))
        assert error.max() < 10 * settings.tolerance * scale, name
    assert abs(found.snap_off - expected.snap_off) < 2e-5  # two of the smallest steps


@pytest.mark.parametrize(
    "finer",
    [
        {
            "mujoco_models.sweep.rest._FALL_INERTIA": 1000.0,
            "mujoco_models.sweep.rest._FALL_STEPS": 50_000,
        },
        {"mujoco_models.sweep.sweep._SMALLEST_STEP": 1e-6},
    ],
    ids=["gentler fall", "smaller steps"],
)
def test_snap_off_stays_when_the_way_to_it_is_refined(finer, usual, monkeypatch):
    case, settings, expected = usual
    for name, value in finer.items():
        monkeypatch.setattr(name, value)
    assert abs(simulate_sweep(case, settings).snap_off - expected.snap_off) < 1e-4


@pytest.mark.slow
@pytest.mark.parametrize("segments", [40, 80])
@pytest.mark.parametrize("name", CASE_NAMES)
@pytest.mark.parametrize("beam", available_beams())
def test_stations_settle(beam, name, segments):
    table = simulated_sweep(name, Settings(beam=beam, segments=segments)).table
    settled = table["status"] == "ok"
    assert settled.mean() >= 0.995, f"unsettled at {table.loc[~settled, 'foot_x'].tolist()}"
