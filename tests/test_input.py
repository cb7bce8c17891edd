"""Bad input: one line that names the value, what is allowed, and what to do."""

import re

import numpy as np
import pandas as pd
import pytest

import analytic
import compare as compared
import mujoco_models
from analytic import (
    Beam,
    Case,
    InputError,
    Readings,
    Sweep,
    catenary,
    circle,
    named_case,
    parabola,
    solve_contact,
    solve_sweep,
    space,
)
from compare import Input, Uncertainties, compare, validate
from mujoco_models import OwnModel, Settings, from_solref, inspect_model, simulate_sweep

EXACT = solve_sweep(Case())
CLOUD = space.Cloud(np.zeros((1, 3)), np.eye(3)[:1])
BALL = space.sphere(1.0, centre=(0, 1.4, 0))


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: Beam(length=-1), "beam.length = -1"),
        (lambda: Beam(length="50 mm"), "units are read in case files alone"),
        (lambda: Beam(length=np.array(1.0)), "it is a ndarray: give a plain number"),
        (lambda: Beam(length=np.inf), "beam.length = inf"),
        (lambda: Beam(flexural_rigidity=0), "beam.flexural_rigidity = 0"),
        (lambda: Beam(flexural_rigidity=np.nan), "beam.flexural_rigidity = nan"),
        (lambda: Beam(radius=-0.01), "beam.radius = -0.01"),
        (lambda: Beam(radius=0.5), "beam.radius = 0.5"),
        (lambda: Beam(length=0.1, radius=0.05), "beam.radius = 0.05"),
        (lambda: parabola(-1, 0.5), "profile.a = -1"),
        (lambda: catenary(0.5, np.nan), "profile.c = nan"),
        (lambda: circle(0, (0, 0.5)), "profile.radius = 0"),
        (lambda: circle(1, (0, np.inf)), "lowest[1] = inf"),
        (lambda: Sweep(stations=1), "sweep.stations = 1"),
        (lambda: Sweep(start=np.nan), "sweep.start = nan"),
        (lambda: Case(profile=circle(1, (0, 1.2))), "1.195 L"),
        (lambda: Case(profile=circle(1, (0, 0.004))), "-0.001 L"),
        (lambda: Case(profile=circle(1, (0, 0.4)), sweep=Sweep(start=0)), "sweep.start = 0"),
        (lambda: Case(profile=circle(1, (0, 0.4)), sweep=Sweep(stop=3)), "sweep.stop = 3"),
        (lambda: named_case("mine.toml"), "`compare.load_case` reads a TOML file"),
        (lambda: solve_sweep(named_case("parabola")).values("forcex"), "did you mean force_x?"),
        (lambda: Readings.of({"foot_x": [1, 2]}), "add force_x, force_y"),
        (lambda: solve_contact(catenary(0.5, -0.8), [2.0]), "alpha = 2.0 rad"),
        (lambda: Settings(segments=1), "mujoco.segments = 1"),
        (lambda: Settings(contact_stiffness=-1), "mujoco.contact_stiffness = -1"),
        (lambda: Settings(corner_radius=0.0), "mujoco.corner_radius = 0.0"),
        (lambda: Settings(beam="rod", springs="arc"), "mujoco.springs = 'arc'"),
        (lambda: mujoco_models.simulate_model(Case(), "a.xml"), "as OwnModel('my_whisker.xml')"),
        (lambda: mujoco_models.simulate_motion(Case(), Settings()), "motion = a Settings"),
        (lambda: inspect_model("sound-chian"), "did you mean sound-chain?"),
        (lambda: OwnModel("sound-chain", contact="our"), "did you mean ours?"),
        (lambda: OwnModel("sound-chain", damping=-1), "model.damping = -1"),
        (lambda: compare(EXACT, EXACT).validated(Case(), {"length": 1}), "stated = a dict"),
        (lambda: inspect_model(3), "model = an int"),
        (lambda: analytic.certify(Case()), "readings = a Case"),
        (lambda: compared.classify(Case()), "readings = a Case"),
        (lambda: analytic.deflected_shapes(Case()), "readings = a Case"),
        (lambda: space.polyhedron(np.zeros((2, 3, 4))), "body.points"),
        (lambda: space.polyhedron([0.0, 1.0]), "must be points (x, y, z)"),
        (lambda: space.fit_body([]), "readings = none"),
        (lambda: space.convex_band([]), "readings = none"),
        (lambda: space.point_cloud(EXACT), "found = a Readings"),
        (lambda: space.point_cloud(EXACT.table), "found = without contacts and normals"),
        (lambda: space.misses(BALL, BALL, 1.0), "cloud = an Ellipsoid"),
        (lambda: space.misses(CLOUD, BALL, -1.0), "length = -1"),
        (lambda: space.deflected_rods(EXACT), "readings = a Readings: must be a SpatialReadings"),
        (lambda: analytic.relative_noise(0.01, EXACT), "readings = a float"),
        (lambda: analytic.find_many_events([], [Beam()]), "beams = 1 of 0 profiles"),
        (lambda: from_solref((0.02, 1), (0.9, 0.95, 1e-3), -1), "inverse_mass = -1"),
        (lambda: from_solref((0.02, 1), (0.9, 0.95, 1e-3), 1, depth=-1e-3), "depth = -0.001"),
        (lambda: from_solref((0.02, 1), (0.9,), 1), "solimp = (0.9,)"),
        (lambda: mujoco_models.to_solref("100", 1, 1), "stiffness = 100"),
        (lambda: space.solve_space(Case()), "case = a Case: must be a SpatialCase"),
        (lambda: space.reconstruct_space(Case()), "readings = a Case: must be a SpatialReadings"),
        (lambda: compared.separate_lag(1, 2), "left = an int: must be an Offset; as compare("),
        (lambda: compared.write_report(1, 2), "folder = an int: must be a path"),
        (lambda: compared.write_report("nowhere"), "DIR = nowhere"),
        (lambda: validate(1, 2, 3), "found = an int"),
        (
            lambda: validate(compare(EXACT, EXACT), Case(), Uncertainties(), simulation="data"),
            "simulation = 'data': must be one of reference, candidate",
        ),
        (lambda: Input(1e-3, "unifrom"), "did you mean uniform?"),
        (
            lambda: simulate_sweep(Case(beam=Beam(radius=0.0), profile=circle(1, (0, 0.4)))),
            "beam.radius = 0",
        ),
    ],
)
def test_values(make, said):
    with pytest.raises(InputError) as refused:
        make()
    message = str(refused.value)
    assert said in message
    assert "\n" not in message
    assert "must be" in message
    assert ";" in message  # and then what to do


@pytest.mark.parametrize(
    ("of", "name", "said"),
    [
        (analytic, "solve_swep", "analytic has no 'solve_swep'; did you mean solve_sweep?"),
        (compared, "measure_budgt", "did you mean measure_budget?"),
        (mujoco_models, "zzz", "dir(mujoco_models) lists what it has"),
        (EXACT, "force_x", "take table['force_x']"),
        (EXACT, "plt", "did you mean plot?"),
    ],
)
def test_names_that_are_nearly_right(of, name, said):
    with pytest.raises(AttributeError, match=re.escape(said)):
        getattr(of, name)


def test_profiles_that_are_not_convex():
    with pytest.raises(InputError, match=r"chord between alpha = .* strictly convex"):
        analytic.Profile(xi=lambda a: np.sin(a), eta=lambda a: np.cos(a), alpha_range=(-1, 1))
    with pytest.raises(InputError, match="not finite at alpha = "):
        analytic.Profile(xi=lambda a: 1 / (a - a), eta=lambda a: a * np.nan, alpha_range=(-1, 1))
    with pytest.raises(InputError, match="alpha_range"):
        analytic.Profile(xi=np.sin, eta=np.cos, alpha_range=(1, -1))
    with pytest.raises(InputError, match="same shape"):
        analytic.Profile(xi=lambda a: 1.0, eta=lambda a: a, alpha_range=(-1, 1))


def test_readings_that_are_none(tmp_path):
    sweep = solve_sweep(named_case("parabola"))
    with pytest.raises(InputError, match="add moment_z"):
        Readings(sweep.table.drop(columns="moment_z"))
    with pytest.raises(InputError, match="phase"):
        Readings(sweep.table.assign(phase="sideways"))
    with pytest.raises(InputError, match="a number"):
        Readings(sweep.table.assign(force_x="strong"))
    with pytest.raises(InputError, match="two or more"):
        Readings(sweep.table.head(1))
    whole = sweep.write(tmp_path / "whole.parquet").read_bytes()
    for name, content in {
        "missing.parquet": None,
        "truncated.parquet": whole[: len(whole) // 2],
        "empty.parquet": b"",
        "empty.csv": b"",
        "binary.csv": whole,
        "readings.txt": b"foot_x",
    }.items():
        if content is not None:
            (tmp_path / name).write_bytes(content)
        with pytest.raises(InputError, match=r"readings file") as refused:
            Readings.read(tmp_path / name)
        assert "\n" not in str(refused.value), name


def test_readings_that_cannot_be_compared():
    one = solve_sweep(named_case("parabola"))
    table = one.table.assign(foot_x=one.table["foot_x"] + 10)
    with pytest.raises(InputError, match="overlapping"):
        compare(one, Readings(table, one.beam))
    with pytest.raises(InputError, match="the same"):
        compare(one, Readings(one.table, Beam(flexural_rigidity=2)))


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: analytic.find_events(named_case("catenary")), "or a case's profile"),
        (lambda: solve_contact(None, [0.1]), "profile = a NoneType"),
        (lambda: solve_contact(catenary(0.5, -0.8), "x"), "alpha = 'x'"),
        (lambda: solve_contact(catenary(0.5, -0.8), [0.1], 1.0), "beam = a float"),
        (lambda: solve_sweep("catenary"), "case = 'catenary': must be a Case"),
        (lambda: simulate_sweep(named_case("catenary"), {"segments": 3}), "settings = a dict"),
        (lambda: analytic.reconstruct(pd.DataFrame()), "readings = a DataFrame"),
        (lambda: analytic.relative_noise(EXACT.table, 0.01), "readings = a DataFrame"),
        (lambda: Readings.read(3), "readings file = an int: must be a path"),
        (lambda: Readings.read_table(None), "readings file = a NoneType"),
        (lambda: analytic.mesh_section([1]), "mesh file = a list: must be a path"),
        (lambda: compared.read_measured(None), "readings file = a NoneType"),
        (lambda: compared.read_measured({}, direction="up"), "direction = 'up'"),
    ],
)
def test_things_of_another_kind(call, said):
    with pytest.raises(InputError) as refused:
        call()
    assert said in str(refused.value)


@pytest.mark.parametrize("name", ["", " ", "\n", "a\tb", "\u202e", "x\x00"])
def test_names_that_do_not_show_are_quoted(name):
    assert ascii(name) in str(InputError("file", name, "a name", "choose one"))
    assert "größe" in str(InputError("file", "größe", "a name", "choose one"))
