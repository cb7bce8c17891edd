"""Units are never evaluated, nor is a vibrissa assumed where it cannot be."""

import math

import numpy as np
import pandas as pd
import pytest

from analytic import CASE_NAMES, SENSED, Beam, Case, InputError, Readings, circle, solve_sweep
from compare import read_measured
from compare.read.assumed import ASSUMED
from compare.read.units import OWN_UNITS, in_si, is_unit, unit_in_si
from tests.conftest import exact_sweep

BEAM = Beam(0.05, 2e-6, 0.25e-3)  # m, N m^2, m
FILE_UNITS = (1e-3, 1e-3, 1e-3, 1e-6)  # mm, mN, mN, mN mm
CASE = "[beam]\nlength = {}\nflexural_rigidity = {}\nradius = {}\n"


@pytest.fixture(scope="module")
def exact() -> Readings:
    return solve_sweep(Case(BEAM, circle(0.04, lowest=(0.0, 0.02))))


@pytest.fixture
def rig(exact) -> pd.DataFrame:
    return exact.table[list(SENSED)] / np.array(FILE_UNITS)


COLUMNS = [f"{n}={n}:{u}" for n, u in zip(SENSED, ("mm", "mN", "mN", "mN mm"), strict=True)]


def noisy(sweep: Readings, noise: float) -> pd.DataFrame:
    table = sweep.table[list(SENSED)].copy()
    scatter = np.random.default_rng(0).standard_normal(table.shape)
    return table + noise * scatter * [0, *table.abs().max()[1:]]


@pytest.mark.parametrize("length", [1e3, 1e2, 1.0])
@pytest.mark.parametrize("force", [1e3, 1.0])
@pytest.mark.parametrize("noise", [0.0, 0.01])
def test_readings_of_no_vibrissa_of_length_and_rigidity_one(exact, length, force, noise):
    """A rig of 50 mm in mm, cm or m and mN or N, whose numbers are of no such vibrissa."""
    with pytest.raises(InputError, match="vibrissa = none given"):
        read_measured(noisy(exact, noise) * [length, force, force, force * length])


@pytest.mark.parametrize("case", CASE_NAMES)
@pytest.mark.parametrize("noise", [0.0, 0.01, 0.05])
def test_dimensionless_readings_go_on_working(case, noise):
    """Also with a spike and gaps, which are no wrong vibrissa."""
    table = noisy(exact_sweep(case), noise)
    for _ in range(2):
        found = read_measured(table)
        assert found.beam == Beam()
        assert found.provenance[ASSUMED] == "L = EI = 1"
        table.loc[100, ["force_x", "force_y"]] = 1e6
        table.loc[50:55, "moment_z"] = np.nan


def test_a_vibrissa_in_plain_numbers_beside_units(tmp_path, rig):
    path = tmp_path / "beam.toml"
    path.write_text(CASE.format(50, 2, 0.25))
    with pytest.raises(InputError, match="without units"):
        read_measured(rig, path, COLUMNS)
    path.write_text(CASE.format('"50 mm"', '"2e-6 N m^2"', '"0.25 mm"'))
    found = read_measured(rig, path, COLUMNS)
    assert found.beam.si
    assert found.provenance["units"]["moment_z"] == "mN mm"
    path.write_text(CASE.format('"50 mm"', "2", '"0.25 mm"'))
    with pytest.raises(InputError, match="flexural_rigidity = without a unit"):
        read_measured(rig, path, COLUMNS)


@pytest.mark.parametrize("separator", [";", "\t", ",", "   "])
@pytest.mark.parametrize("brackets", ["{}", "[{}]"])
def test_a_line_of_units_below_the_names(tmp_path, exact, rig, separator, brackets):
    names, units = ("Weg", "Kraft x", "Kraft y", "Moment"), ("mm", "mN", "mN", "mN mm")
    head = "Messung 7\n" + separator.join(names) + "\n"
    head += separator.join(brackets.format(unit) for unit in units) + "\n"
    body = rig.to_csv(index=False, header=False, sep="|").replace("|", separator)
    path = tmp_path / "rig.txt"
    path.write_text(head + body)
    columns = [f"{name}={column}" for name, column in zip(SENSED, names, strict=True)]
    found = read_measured(path, BEAM, columns)
    assert found.provenance[OWN_UNITS]["moment_z"] == "mN mm"
    expected = exact.table[list(SENSED)].to_numpy()
    np.testing.assert_allclose(
        found.table[list(SENSED)].to_numpy(), expected, rtol=1e-12, atol=1e-15
    )
    with pytest.raises(InputError, match="vibrissa = none given"):
        read_measured(path, columns=columns)
    # A unit that is named may not contradict the file, whose own names need not be given.
    with pytest.raises(InputError, match=r"column 'Moment' = in N m: must be in mN mm, as"):
        read_measured(path, BEAM, [*columns[:3], "moment_z=Moment:N m"])
    path.write_text(path.read_text().replace(separator.join(names), separator.join(SENSED)))
    assert read_measured(path, BEAM).values("foot_x") == pytest.approx(found.values("foot_x"))
    assert read_measured(path, BEAM, ["foot_x=foot_x:mm"]).source == found.source
    with pytest.raises(InputError, match="column 'foot_x' = in m: must be in mm, as the file says"):
        read_measured(path, BEAM, ["foot_x=foot_x:m"])


def test_a_line_of_units_of_which_some_are_none(tmp_path, rig):
    """Counters, ratios and temperatures beside what is sensed; a unit in a column's own name."""
    table = rig.set_axis(["Weg", "Fx", "Fy", "Mz [mN mm]"], axis=1).assign(Nr=1, T=23.5, ok=100)
    path = tmp_path / "rig.csv"
    head = ";".join(table) + "\nmm;mN;mN;mN mm;-;°C;%\n"
    path.write_text(head + table.to_csv(index=False, header=False, sep=";"))
    columns = [f"{n}={c}" for n, c in zip(SENSED, table, strict=False)]
    assert read_measured(path, BEAM, columns).provenance[OWN_UNITS]["foot_x"] == "mm"
    path.write_text(table.to_csv(index=False, sep=";"))
    with pytest.raises(InputError, match=r"'Mz \[mN mm\]' = in N m: must be in"):
        read_measured(path, BEAM, ["foot_x=Weg:mm", "moment_z=Mz [mN mm]:N m"])


def test_names_that_are_units_by_chance_are_names(tmp_path, rig):
    """A preamble as wide as the table is no line of names."""
    path = tmp_path / "rig.csv"
    path.write_text("Date;2026;;\nm;N;V;s\n" + rig.to_csv(index=False, header=False, sep=";"))
    found = read_measured(path, BEAM, [f"{n}={c}" for n, c in zip(SENSED, "mNVs", strict=True)])
    assert "units" not in found.provenance


def test_columns_that_nobody_named(tmp_path, rig):
    path = tmp_path / "rig.csv"
    names = ["Zeit [s]", "Kraft (mN)", "Weg [mm]", "Mz [N mm]"]
    rig.set_axis(names, axis=1).to_csv(path, index=False)
    for columns, missing in (([], "foot_x=COLUMN:m"), (["foot_x=Weg [mm]"], "force_x=COLUMN:N")):
        with pytest.raises(InputError, match=f"--column {missing}"):
            read_measured(path, columns=columns)


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("50 mm", "m", 0.05),
        ("2 N*m**2", "N m^2", 2.0),
        ("3 kg m^3/s^2", "N m^2", 3.0),
        ("4 m^-1", "1/m", 4.0),
        # As engineers and instruments write them.
        ("1 N·mm²", "N m^2", 1e-6),
        ("1 GPa mm^4", "N m^2", 1e-3),
        ("180°", "rad", math.pi),
        ("1 mNmm", "N m", 1e-6),
    ],
)
def test_quantities(text, dimension, value):
    assert in_si(text, dimension) == pytest.approx(value, rel=1e-14)


@pytest.mark.parametrize(
    "text",
    ["9**9**9 m", "m**9**9", "1 m**9**9", "((((1 m", "1 m)", '"""', "m", "5", "", "1 kg", "1 degC",
     "1 parsnip", "1e999 m", "nan m", "1 m" + "*m" * 1000, "1 " + "(" * 50,
     "1 m;2", "1 m\n2", "2 2 m"],
)  # fmt: skip
def test_what_is_no_quantity_is_refused_at_once(text):
    with pytest.raises(InputError) as refused:
        in_si(text, "m")
    assert len(str(refused.value)) < 300


def test_a_unit_has_no_number():
    assert is_unit("N·mm²")
    assert not is_unit("Weg")
    for unit in ("0 m", "2 m", "", "m m"):
        with pytest.raises(InputError):
            unit_in_si(unit, "m")
