"""Out of the plane: where MuJoCo's beams leave it, and that until then nothing shows it."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from analytic import (
    CLAMP_READINGS,
    Beam,
    Case,
    InputError,
    Sweep,
    circle,
    find_events,
    named_case,
    reconstruct,
    sideways_stiffness,
    solve_sweep,
)
from mujoco_models import Settings, available_beams, simulate_sweep
from mujoco_models.beams.cable import Cable
from mujoco_models.beams.layout import bead_spacing
from mujoco_models.model.model import BeamModel
from mujoco_models.obstacles.kinds import place
from mujoco_models.sweep.out_of_plane import sideways
from mujoco_models.sweep.spatial_walk import GENTLE_STEP
from mujoco_models.sweep.sweep import set_out
from mujoco_models.sweep.walk import Walk

BEAMS = available_beams()
CIRCLE = Case(Beam(), circle(1, lowest=(0, 0.4)), name="circle")
SHORT = replace(CIRCLE, sweep=Sweep(stations=24, stop=-0.95))
COARSE = Settings(segments=10, contour_points=1600, planar=False)


@cache
def swept(beam):
    return simulate_sweep(SHORT, replace(COARSE, beam=beam))


def before(readings):
    return (readings.table["foot_x"] > readings.provenance["events"]["out_of_plane"]).to_numpy()


def check_sweep(case, found, settings, place, stiffness):
    """Everything that a sweep in space promises."""
    planar = simulate_sweep(case, replace(settings, planar=True))
    exact = find_events(case.profile, case.beam)
    events, table = found.provenance["events"], found.table
    assert events["out_of_plane"] == pytest.approx(exact.out_of_plane.foot_x, abs=place)
    # Nothing is there to bend out to, so the beam goes as soon as it leaves the plane.
    assert events["snap_off"] == events["out_of_plane"]
    assert (table["status"] == "ok").all()
    assert (table["residual"] < settings.tolerance).all()
    assert (table["out_of_plane"] < 1e-9).all()  # before it goes and after
    held = before(found)
    for name in CLAMP_READINGS:
        scale = planar.table[name].abs().max()
        apart = (table[name] - planar.table[name])[held].abs().max()
        # Two states at rest to 1e-8 EI/L; observed 4e-9 of the largest reading.
        assert apart < 2e-8 * scale, name
    predicted = sideways_stiffness(solve_sweep(case))
    touching = held & table["sideways_stiffness"].notna().to_numpy()
    error = (table["sideways_stiffness"] - predicted)[touching].abs().max()
    assert error < stiffness * np.nanmax(predicted)


@pytest.mark.parametrize("beam", BEAMS)
def test_leaves_where_the_contact_passes_the_lowest_point(beam):
    # 10 segments and facets of 1.5e-3 rad.
    check_sweep(SHORT, swept(beam), replace(COARSE, beam=beam), place=4e-3, stiffness=2e-2)


# A rod in space has three times as many coordinates, and so fewer cases.
PASSES = [
    (beam, name)
    for beam in BEAMS
    for name in ("catenary", "two-circles", "tip-only")
    if beam != "rod" or name == "catenary"
]


@pytest.mark.slow
@pytest.mark.parametrize(("beam", "case_name"), PASSES)
def test_leaves_where_predicted(beam, case_name):
    # Observed at most 4e-4 and 5e-3: contact angles are good to the facets' 4e-4 rad, and on the
    # catenary the foot moves by 4 L a radian. The place is located between stations, however few.
    case = replace(named_case(case_name), sweep=Sweep(24))
    settings = Settings(beam=beam, planar=False)
    check_sweep(case, simulate_sweep(case, settings), settings, place=8e-4, stiffness=8e-3)


@pytest.mark.slow
def test_place_converges_with_the_mesh_and_does_not_depend_on_the_segments():
    """Every discrete beam turns freely at alpha = 0, so only its reach there is approximate."""
    exact = find_events(CIRCLE.profile, CIRCLE.beam).out_of_plane.foot_x
    for segments in (10, 20, 40):
        settings = Settings(segments=segments, contour_points=12_800, planar=False)
        found = simulate_sweep(SHORT, settings).provenance["events"]["out_of_plane"]
        assert found == pytest.approx(exact, abs=0.3 / segments**2 + 2e-4)


@pytest.mark.parametrize("beam", BEAMS)
def test_motion_returns_to_the_plane_before_that_place_and_grows_beyond(beam):
    """MuJoCo's own motion after a nudge, on planar equilibria on either side of the place."""
    model = set_out(CIRCLE, replace(COARSE, beam=beam)).model
    walk = Walk(model, CIRCLE, 1e-8)  # keeps to the plane, come what may
    place = find_events(CIRCLE.profile, CIRCLE.beam).out_of_plane.foot_x
    for foot_x, grows in ((place + 0.05, False), (place - 0.05, True)):
        walk.go_to(foot_x)
        held = sideways(model)
        assert held.stable != grows
        rest = model.data.qpos.copy()
        for size in (1e-5, 1e-3):  # rad, of the softest mode
            model.turn(rest, size * held.softest(model.model.nv))
            out = []
            for _ in range(4):
                out.append(model.out_of_plane())
                for _ in range(50):
                    model.creep(GENTLE_STEP)
                model.evaluate()
            assert (np.diff(out[1:]) > 0).all() if grows else (np.diff(out[1:]) < 0).all()
        model.turn(rest, np.zeros(model.model.nv))


def test_it_comes_to_rest_on_the_other_side_bent_the_other_way():
    """As a sweep to the right from the far side would find it, with what the clamp reads there."""
    found = swept("chain")
    table = found.table[~before(found) & (found.table["phase"] != "free").to_numpy()]
    assert len(table) >= 3
    assert (table["moment_z"] < 0).all()
    assert (table["contact_angle"] < 0).all()
    assert (table["sideways_stiffness"] > 0).all()
    stations = {"stations": 400, "start": -0.95, "stop": float(table["foot_x"].max())}
    other = solve_sweep(replace(CIRCLE, sweep=Sweep(direction="right", **stations))).table
    for name in CLAMP_READINGS:
        expected = np.interp(table["foot_x"], other["foot_x"], other[name])
        # 10 segments: 1e-2 of the largest reading of the whole sweep.
        np.testing.assert_allclose(table[name], expected, atol=1e-2 * found.table[name].abs().max())
    # The clamp determines the contact on either side; at first contact, where hardly a force acts,
    # with an error of the vibrissa's radius.
    points = reconstruct(found).loc[table.index]
    for name in ("contact_x", "contact_y"):
        np.testing.assert_allclose(points[name], table[name], atol=CIRCLE.beam.radius)


@pytest.mark.skipif("cable" not in BEAMS, reason="only the cable's torsional stiffness can be set")
@pytest.mark.slow
def test_torsional_stiffness_does_not_matter_to_second_order():
    """With GJ = EI not at all; else the plugin's moments derive from no energy."""

    def error(twist, segments):
        settings = replace(COARSE, beam="cable", segments=segments)
        obstacle = place(CIRCLE, settings)
        spacing = bead_spacing(segments, CIRCLE.radius, obstacle.largest_curvature)
        cable = Cable(settings, spacing, twist=twist)
        model = BeamModel(cable, CIRCLE.radius, obstacle, settings.contact_stiffness)
        walk = Walk(model, CIRCLE, 1e-8)
        for foot_x in np.linspace(0.9, -0.459, 25):
            walk.go_to(float(foot_x))
        row = walk.row()
        centre = row["contact_x"] + CIRCLE.beam.radius * np.sin(row["contact_angle"])
        pendulum = -row["force_x"] / (centre + 0.459)
        return sideways(walk.model).stiffness / pendulum - 1

    assert max(abs(error(1.0, n)) for n in (10, 40)) < 1e-4  # observed 4e-5
    for twist in (0.1, 10.0):
        errors = np.abs([error(twist, n) for n in (20, 40, 80)])
        assert errors[1] < 0.04
        assert (np.log2(errors[:-1] / errors[1:]) > 1.7).all()


def test_planar_is_a_yes_or_no():
    with pytest.raises(InputError, match=r"mujoco\.planar = 'no'"):
        Settings(planar="no")
