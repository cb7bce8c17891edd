"""The budget puts every planted fault under its right name, and blames nobody without one."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from analytic import (
    CASE_NAMES,
    CLAMP_READINGS,
    Beam,
    Case,
    InputError,
    Readings,
    Sweep,
    named_case,
    polygon,
    solve_sweep,
    with_friction,
)
from compare.explain.budget import Budget, budget, controlled_changes
from compare.explain.parts import SMALL, UNRESOLVED
from compare.explain.variations import on_polygon, variations
from compare.simulate.budgets import has_corners, has_primitive, measure_budget
from mujoco_models import Settings, simulate_sweep

pytestmark = pytest.mark.usefixtures("in_turn")

CASE = named_case("parabola")
GRID = Sweep(80, float(CASE.foot_x[0]), float(CASE.foot_x[-1]))
known = cache(variations)
swept = cache(simulate_sweep)  # refined, one budget's base is often another's


def measured(claimed: Case, made: Case, settings: Settings) -> Budget:
    """The budget of sweeps of the case `made`, which claim to be of the case `claimed`."""
    runs = {
        name: replace(swept(made, changed), beam=claimed.beam)
        for name, changed in controlled_changes(settings).items()
    }
    return budget(solve_sweep(claimed), runs, known(claimed))


def total(found: Budget, part: str) -> float:
    return max(found.parts[part][reading].rms for reading in CLAMP_READINGS)


def stations_of(name):
    return 200 if name == "shallow-catenary" else 60


@pytest.mark.parametrize(
    "segments",
    [pytest.param(40, marks=pytest.mark.slow), pytest.param(80, marks=pytest.mark.trial)],
)
def test_named_cases_are_explained(case, segments):
    """At 60 stations, which show what 200 do: the part that is left is no smaller at fewer.

    Past the shallow catenary the contact stays near one place of the vibrissa: 60 stations see too
    little of where it is in its link, and N = 80 an order of 1.51, N = 70 and 90 one of 2.

    Observed at most 3.8e-5, in the catenary's force_y at N = 40.

    With beads no closer than L/4000 the finest sweeps of N = 80 past two circles had an error that
    falls with no power of h: 8.5e-6 of force_y were left, and an order of 1.69.
    """
    case = replace(case, sweep=replace(case.sweep, stations=stations_of(case.name)))
    found, _ = measure_budget(case, Settings(segments=segments))
    assert found.closes
    assert found.suspects == ()
    assert found.blame in ("discretisation", "facets")
    assert 1.8 < found.order <= 2  # observed at least 1.98
    for reading in CLAMP_READINGS:
        unexplained = found.parts["unexplained"][reading]
        assert unexplained.rms <= 3e-5, reading
        assert unexplained.rms <= np.hypot(unexplained.uncertainty, UNRESOLVED), reading


@pytest.mark.slow
def test_the_limit_is_the_exact_solution_on_the_same_polygon(case):
    """With 12,800 facets; observed at most 8.3e-5, and 1.05e-4 in the force_x of two-circles.

    With 3,200 the load sinks in by 2e-6 L where a facet is 7e-8 L high, and spreads over several:
    MuJoCo is then nearer to the smooth contour than to its own polygon, by up to 3e-4 in force_x.
    Beyond 12,800 nothing is gained: a polygon has several equilibria at one station, a facet apart,
    and MuJoCo may rest on another one than the exact sweep has come to. On the flat circle of
    two-circles, where the tip slides farthest, that is most of what is left.
    """
    points = 12_800
    sweeps = {n: Settings(segments=n, contour_points=points) for n in (80, 160)}
    allowed = 1.2e-4 if case.name == "two-circles" else 1e-4
    runs = {str(n): simulate_sweep(case, settings) for n, settings in sweeps.items()}
    exact = on_polygon(case, points)
    kept = exact.trusted & (exact.table["phase"] != "free").to_numpy()
    kept &= case.foot_x - exact.snap_off > 5e-3 * np.ptp(case.foot_x)
    for name in CLAMP_READINGS:
        middle, fine = (runs[str(n)].values(name) for n in sweeps)
        limit = fine + (fine - middle) / 3
        error = (limit - exact.values(name))[kept] / np.abs(exact.values(name)).max()
        assert np.sqrt(np.mean(error**2)) < allowed, name


@pytest.fixture(scope="module")
def sound() -> Budget:
    case = replace(CASE, sweep=GRID)
    return measured(case, case, Settings(segments=20))


@pytest.mark.slow
def test_a_sound_run_is_explained(sound):
    assert sound.closes
    assert sound.suspects == ()
    assert sound.blame == "discretisation"
    assert sound.order > 1.8
    assert total(sound, "unrest") < 1e-7
    assert total(sound, "sensor") < 1e-6
    assert total(sound, "extension") < 1e-12
    assert "corner" not in sound.parts  # nor is there one


@pytest.mark.slow
def test_the_closed_form_predicts_softness(sound):
    """Where the load rests on one bead. Observed: within 12 %, with as much uncertainty."""
    case = named_case("tip-only")
    case = replace(case, sweep=replace(case.sweep, stations=40))
    found = measured(case, case, Settings(segments=20))
    for reading in CLAMP_READINGS:
        softness = found.parts["softness"][reading].rms
        assert found.checks["softness"][reading] == pytest.approx(softness, rel=0.25)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("blamed", "segments", "wrong"),
    [
        ("discretisation", 20, {"clamp": "naive"}),  # of first order
        ("facets", 40, {"contour_points": 60}),
        # The sound run's 3e-5 is how harder beads hand on the load.
        ("softness", 40, {"contact_stiffness": 1e4}),
        ("unrest", 40, {"tolerance": 1e-2}),
    ],
)
def test_a_planted_fault_of_the_numerics_is_blamed(sound, blamed, segments, wrong):
    case = replace(CASE, sweep=GRID)
    found = measured(case, case, Settings(segments=segments, **wrong))
    assert found.blame == blamed
    if blamed == "discretisation":
        assert found.order < 1.3
        assert total(found, blamed) > 1e-2
        return
    assert total(found, blamed) > 10 * total(sound, blamed)
    if blamed != "softness":  # a part that is all scatter is as uncertain as large
        assert found.closes or (blamed == "unrest" and found.undecided)
    else:
        hard, soft = (max(one.checks["softness"].values()) for one in (sound, found))
        assert soft > 100 * hard


WRONG_BEAMS = {
    "flexural_rigidity": (Beam(flexural_rigidity=1.01), 0.01),
    "radius": (Beam(radius=0.0025), -0.5),
    "length": (Beam(length=1.004), 0.004),
    "natural_curvature": (Beam(natural_curvature=-0.05), -0.05),
    "tip_radius": (Beam(tip_radius=0.0045), -0.1),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", WRONG_BEAMS)
def test_wrong_physics_is_unexplained_and_suspected(name):
    beam, change = WRONG_BEAMS[name]
    claimed = replace(CASE, sweep=replace(GRID, start=GRID.start + 0.01))
    found = measured(claimed, replace(claimed, beam=beam), Settings(segments=20))
    assert found.blame == "unexplained"
    assert not found.closes
    assert found.suspects[0].name == name
    assert found.suspects[0].change == pytest.approx(change, rel=0.2)


@pytest.mark.slow
def test_a_clamp_that_turns_is_suspected():
    """And kept apart from less rigidity, which leaves hundreds of times as much of the square."""
    claimed = replace(CASE, sweep=GRID)
    found = measured(claimed, replace(claimed, clamp_stiffness=50.0), Settings(segments=20))
    assert found.blame == "unexplained"
    first, *others = found.suspects
    assert first.name == "clamp_compliance"
    assert first.change == pytest.approx(0.02, rel=0.2)
    assert first.size.endswith(" L/EI")
    assert all(1 - other.share > 30 * (1 - first.share) for other in others)


@pytest.mark.slow
def test_a_shifted_stage_is_suspected():
    case = replace(CASE, sweep=GRID)
    wrong = replace(case, sweep=replace(GRID, start=GRID.start + 0.005, stop=GRID.stop + 0.005))
    shifted = {
        name: Readings(
            simulate_sweep(wrong, changed).table.assign(foot_x=case.foot_x),
            case.beam,
            provenance={"settings": {"segments": changed.segments}},
        )
        for name, changed in controlled_changes(Settings(segments=20)).items()
    }
    found = budget(solve_sweep(case), shifted, known(case))
    assert found.suspects[0].name == "foot_x"
    assert found.suspects[0].change == pytest.approx(0.005, rel=0.1)


FRICTION = 0.005


@pytest.mark.slow
def test_friction_left_on_is_suspected():
    """Added to frictionless sweeps is what a sweep in closed form reads more if it rubs."""
    case = replace(CASE, sweep=GRID)
    smooth, rough = solve_sweep(case), solve_sweep(replace(case, friction=FRICTION))
    both = (smooth.table["phase"] != "free") & (rough.table["phase"] != "free")
    more = {n: np.where(both, rough.values(n) - smooth.values(n), 0) for n in CLAMP_READINGS}
    runs = {
        name: swept(case, changed)
        for name, changed in controlled_changes(Settings(segments=20)).items()
    }
    rubbing = {
        name: replace(run, table=run.table.assign(**{n: run.values(n) + more[n] for n in more}))
        for name, run in runs.items()
    }
    found = budget(smooth, rubbing, known(case))
    assert found.blame == "unexplained"
    assert found.suspects[0].name == "friction"
    assert found.suspects[0].change == pytest.approx(FRICTION, rel=0.2)


@pytest.mark.slow
def test_friction_holds_back_and_is_the_mirror_image_to_the_right():
    with_it = with_friction(CASE, 0.1)
    inside = CASE.foot_x > solve_sweep(CASE).snap_off + 0.2
    touching = inside & (with_it.table["phase"] != "free").to_numpy()
    # The object pulls the vibrissa on to the right, so the clamp pulls it more to the left.
    change = with_it.values("force_x") - solve_sweep(CASE).values("force_x")
    assert (change[touching][1:] < 0).all()  # where it has just touched it is still straight
    other_way = with_friction(CASE.mirrored(), 0.1)
    np.testing.assert_allclose(
        other_way.values("force_x"), -with_it.values("force_x"), rtol=0, atol=1e-9
    )
    with pytest.raises(InputError, match=r"from -0\.5 to 0\.5"):
        with_friction(CASE, 2.0)


@pytest.mark.slow
def test_a_polygon_has_no_facet_error():
    case = Case(
        profile=polygon([(-1.4, 1.0), (-0.6, 0.5), (0.2, 0.4), (1.0, 0.8), (1.6, 1.4)]),
        sweep=Sweep(stations=24),
    )
    assert not has_primitive(case)
    found, _ = measure_budget(case, Settings(segments=10))
    assert total(found, "facets") < 1e-8  # two states at rest
    assert found.blame == "discretisation"


TRIANGLE = Case(profile=polygon([(-0.6, 0.9), (0.0, 0.35), (0.6, 0.9)]), sweep=Sweep(stations=40))


@pytest.mark.slow
def test_a_blunt_corner_is_the_corner():
    """What it does is proportional to its radius: 7.4e-7 of force_x at 1e-6 L, 7.4e-4 at 1e-3 L."""
    sound, _ = measure_budget(TRIANGLE, Settings())
    assert sound.closes
    assert sound.blame == "discretisation"
    assert total(sound, "corner") < 1e-6
    blunt, _ = measure_budget(TRIANGLE, Settings(corner_radius=1e-3))
    assert blunt.closes
    assert blunt.blame == "corner"
    assert total(blunt, "corner") == pytest.approx(1000 * total(sound, "corner"), rel=0.05)
    for name in ("discretisation", "softness"):
        assert total(blunt, name) == pytest.approx(total(sound, name), rel=0.01)


def test_only_sharp_corners_have_a_part():
    assert has_corners(TRIANGLE, Settings())
    assert not has_corners(CASE, Settings())
    assert "sharp" not in controlled_changes(Settings())
    sharp = controlled_changes(Settings(), smooth=False, corners=True)["sharp"]
    assert sharp == Settings(corner_radius=1e-7)


def test_no_room_to_refine():
    with pytest.raises(InputError, match="segments of a budget = 500: must be at most 250"):
        controlled_changes(Settings(segments=500))
    with pytest.raises(InputError, match="corner_radius of a budget = 1e-09: must be at least"):
        controlled_changes(Settings(corner_radius=1e-9), smooth=False, corners=True)


VIBRISSAE = {
    "cone": {"tip_radius": 0.4 * 0.005},
    "curved away": {"natural_curvature": -0.5},
    "curved towards": {"natural_curvature": 0.5},
    "on a spring": {},
}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "vibrissa"),
    [
        ("catenary", "cone"),  # observed 1.8e-5; a tip 0.2 % thicker leaves 3.4e-4
        ("parabola", "curved towards"),  # 4e-6
        ("catenary", "on a spring"),  # 1.2e-5
    ],
)
def test_a_general_vibrissa_closes(name, vibrissa):
    # A cone past a polygon is solved corner by corner: of 100, in a quarter of the time of 400.
    points = 100 if vibrissa == "cone" else 400
    assert_closed(name, vibrissa, segments=40, stations=40, least=30, points=points)


@pytest.mark.trial
@pytest.mark.parametrize("segments", [40, 80])
@pytest.mark.parametrize("vibrissa", VIBRISSAE)
@pytest.mark.parametrize("name", CASE_NAMES)
def test_all_general_vibrissae_close(name, vibrissa, segments):
    """Observed at most 4.1e-5 and 1.5e-5, the order 1.71 to 2.

    It is 2 with a scatter, by where in its link the contact is: of the cone past the shallow
    catenary 1.79 at N = 36, 1.71 at 40, 1.83 at 44 and 2 at 80.
    """
    # A flat object is touched twice on most of its way by one that is curved towards it.
    twice = vibrissa == "curved towards" and name.endswith("catenary")
    assert_closed(name, vibrissa, segments, stations_of(name), least=10 if twice else 45)


def assert_closed(name, vibrissa, segments, stations, least, points=1600):
    case = named_case(name)
    beam = replace(case.beam, **VIBRISSAE[vibrissa])
    stiffness = 8.0 if vibrissa == "on a spring" else float("inf")
    sweep = replace(case.sweep, stations=stations)
    case = replace(case, beam=beam, clamp_stiffness=stiffness, sweep=sweep)
    # The closed form past as many corners, a check, takes long where the vibrissa varies.
    found, _ = measure_budget(case, Settings(contour_points=points, segments=segments))
    assert found.closes
    assert found.stations >= least  # some are free, or within the window before the snap-off
    assert found.blame in ("discretisation", "facets")
    assert found.order > 1.7
    for part in found.parts["unexplained"].values():
        assert part.rms < SMALL
