"""All methods on the same readings."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from analytic import Beam, Case, InputError, Readings, Sweep, circle, named_case, solve_sweep
from analytic.from_clamp.earlier import NAMES, OWN
from compare.read.case import load_job
from docs.figures.methods import (
    CONDITIONS,
    as_believed,
    chosen_conditions,
    compare_methods,
    method_errors,
)

EXACT = ("elastica", "decision", "scholz-rahn", "clements-rahn")
CIRCLE = Case(profile=circle(1.0, (0.0, 0.4)), sweep=Sweep(60))


def test_those_that_know_the_elastica_are_exact_without_noise():
    found = method_errors(solve_sweep(CIRCLE), EXACT, noise=[0.0])
    assert (found["answered"] == 1).all()
    assert found["worst"].max() < 1e-10


def test_every_method_answers_or_says_that_it_cannot():
    found = method_errors(solve_sweep(CIRCLE), noise=[0.0, 0.01])
    assert set(found["method"]) == set(NAMES)
    assert len(found) == len(NAMES) * 2 * 2
    assert found["answered"].between(0, 1).all()
    # Nowhere a wild number: the farthest wrong answer is still on the vibrissa.
    assert found["worst"].max() < 2.2
    assert (found["median"].isna() == (found["answered"] == 0)).all()


def test_noise_is_felt_in_proportion():
    found = method_errors(solve_sweep(named_case("catenary")), OWN, noise=[1e-4, 1e-3])
    tangent = found[(found["phase"] == "tangent") & (found["method"] == "elastica")]
    small, large = tangent["median"]
    assert large / small == pytest.approx(10, rel=0.3)


@pytest.mark.parametrize("name", NAMES)
def test_a_sweep_to_the_right_is_found_as_well_as_its_mirror_image(name):
    left = solve_sweep(named_case("catenary"))
    right = solve_sweep(replace(named_case("catenary"), sweep=Sweep(200, direction="right")))
    one, other = (method_errors(sweep, [name], noise=[0.0]) for sweep in (left, right))
    assert other["answered"].to_numpy() == pytest.approx(one["answered"].to_numpy())
    np.testing.assert_allclose(other["worst"], one["worst"], rtol=1e-6, atol=1e-12)


def test_units_do_not_matter():
    case = named_case("catenary")
    length = 0.05
    beam = replace(case.beam, length=length, flexural_rigidity=1e-5, radius=0.005 * length)
    scaled = solve_sweep(replace(case, beam=beam, profile=case.profile.scaled(length)))
    one, other = (method_errors(s, noise=[0.0]) for s in (solve_sweep(case), scaled))
    np.testing.assert_allclose(other["median"], one["median"], rtol=1e-6, atol=1e-12)


@pytest.mark.parametrize("name", [name for name in CONDITIONS if name != "exact"])
def test_what_a_method_does_not_know_makes_it_err_and_what_it_knows_does_not(name):
    truth = solve_sweep(CONDITIONS[name].true(CIRCLE))
    believed = as_believed(truth, CIRCLE)
    taken = method_errors(believed, ["elastica"], [0.0])
    assert method_errors(truth, ["elastica"], [0.0])["worst"].max() < 1e-10
    assert taken["worst"].max() > 1e-4
    if name == "friction":  # only the angle is off: by the radius times that
        assert taken["worst"].max() < 2 * CIRCLE.beam.radius


def test_conditions_by_name():
    assert chosen_conditions(["all"]) == [*CONDITIONS, "mujoco"]
    assert chosen_conditions(["friction", "exact", "friction"]) == ["friction", "exact"]
    with pytest.raises(InputError, match="readings = 'frictoin'"):
        chosen_conditions(["frictoin"])


def test_readings_without_contacts_cannot_judge():
    sweep = solve_sweep(CIRCLE)
    bare = Readings(sweep.table[["foot_x", "force_x", "force_y", "moment_z"]], sweep.beam)
    with pytest.raises(InputError, match="contacts of the readings"):
        method_errors(bare)


WIRE = Case(Beam(0.05, 2e-6, 2.5e-4), named_case("parabola").profile.scaled(0.05))


@pytest.mark.parametrize(
    ("name", "changed"),
    [
        ("exact", WIRE),
        ("curved", replace(WIRE, beam=replace(WIRE.beam, natural_curvature=-4.0))),
        ("tapered", replace(WIRE, beam=replace(WIRE.beam, tip_radius=2e-4))),
        ("soft-clamp", replace(WIRE, clamp_stiffness=4e-4)),
        ("friction", replace(WIRE, friction=0.2)),
    ],
)
def test_each_is_as_large_as_it_says_in_any_units(name, changed):
    true = CONDITIONS[name].true(WIRE)
    assert true.beam.natural_curvature == pytest.approx(changed.beam.natural_curvature, rel=1e-12)
    assert true.beam.radius_at(0.05) == pytest.approx(changed.beam.radius_at(0.05), rel=1e-12)
    assert true.clamp_stiffness == pytest.approx(changed.clamp_stiffness, rel=1e-12)
    assert true.friction == changed.friction
    # It is as large in a case that is of such a vibrissa already.
    again = CONDITIONS[name].true(true)
    assert again.beam.natural_curvature == pytest.approx(true.beam.natural_curvature, rel=1e-12)
    assert again.friction == true.friction


def test_a_case_and_a_file_of_its_readings_are_alike(tmp_path):
    case = load_job("parabola")
    solve_sweep(case.case).write(tmp_path / "parabola.parquet")
    tables = []
    for given in (case, tmp_path / "parabola.parquet"):
        compare_methods(given, tmp_path, ["kaneko", "elastica"], [0.0, 0.01], ["exact"])
        tables.append(pd.read_csv(tmp_path / "methods.csv").drop(columns="seconds"))
    pd.testing.assert_frame_equal(*tables)
    assert (tmp_path / "methods.png").exists()


def test_readings_of_other_vibrissae(tmp_path, capsys):
    compare_methods(
        load_job("parabola"), tmp_path, ["binary", "elastica"], [0.0], ["exact", "friction"]
    )
    assert "contacts" in capsys.readouterr().out
    table = pd.read_csv(tmp_path / "methods.csv")
    assert set(table["readings"]) == {"exact", "friction"}
    informed = table[table["method"] == "elastica-informed"]
    assert set(informed["readings"]) == {"friction"}
    assert informed["worst"].max() < 1e-10
