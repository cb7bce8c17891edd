"""Files as rigs write them."""

import numpy as np
import pandas as pd
import pytest

from analytic import (
    SENSED,
    Beam,
    Case,
    InputError,
    Readings,
    Sweep,
    circle,
    reconstruct,
    solve_sweep,
)
from analytic.problem.support import Support
from compare import read_measured, read_sweeps
from compare.read.dialect import read_text_table
from tests.conftest import exact_sweep

FOOT = np.linspace(1, -1, 40)
TABLE = pd.DataFrame(
    np.c_[FOOT, np.sin(FOOT), np.cos(FOOT), FOOT**2], columns=["stage", "Fx", "Fy", "Mz"]
)
BEAM = Beam()  # these readings are of no vibrissa: one must be given, or they are refused
COLUMNS = [f"{name}={column}" for name, column in zip(SENSED, TABLE.columns, strict=True)]


def assert_same(readings, table=TABLE):
    found = readings.table[list(SENSED)].to_numpy()
    np.testing.assert_allclose(found, table.to_numpy(), rtol=1e-15, atol=1e-15)


@pytest.mark.parametrize("ending", ["\n", "\r\n"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "latin-1"])
@pytest.mark.parametrize(
    ("separator", "decimal"), [(",", "."), (";", "."), (";", ","), ("\t", "."), ("\t", ","),
                               ("   ", "."), ("  ", ",")],
)  # fmt: skip
def test_any_separator_decimal_mark_and_encoding(tmp_path, separator, decimal, encoding, ending):
    lines = TABLE.to_csv(index=False, sep="|", decimal=decimal).replace("|", separator).split("\n")
    text = ending.join(["# Prüfstand 3", "", *lines])
    (tmp_path / "rig.txt").write_bytes(text.encode(encoding))
    assert_same(read_measured(tmp_path / "rig.txt", beam=BEAM, columns=COLUMNS))


def separated(table: pd.DataFrame, mark: str, **how) -> str:
    return table.to_csv(sep=mark, index=False, **how)


NAMES = [*TABLE.columns]
TIMED = TABLE.assign(t="09:00:00.010")[["t", *NAMES]]
LABVIEW = "LabVIEW Measurement\nSeparator\tTab\n***End_of_Header***\t\nSamples\t40\t40\t40\t40\n"
NUMBERS = "".join(f"{name}\t9\t9\t9\n" for name in ("Samples", "X0", "Delta_X"))
HEADS = {
    "labview": LABVIEW + "\t".join((*NAMES, "Comment\n")) + separated(TABLE, "\t", header=False),
    # They were taken for rows.
    "numbers": f"Channels\t3\n{NUMBERS}***End***\t\n" + separated(TABLE, "\t"),
    "preamble": "Program 7;;;;\nDate;2026-01-01;;;\nrate;100\n\n" + separated(TIMED, ";"),
    # The line of units was taken for names: "column 'stage' missing".
    "clock": "Run;7;;;\n" + separated(TIMED, ";").replace("\n", "\nhh:mm:ss;m;N;N;N m\n", 1),
}


@pytest.mark.parametrize("text", HEADS.values(), ids=HEADS)
def test_what_stands_above_the_rows(tmp_path, text):
    (tmp_path / "rig.csv").write_text(text)
    beam = Beam(si="N m" in text)
    assert_same(read_measured(tmp_path / "rig.csv", beam=beam, columns=COLUMNS))
    if ":" in text:
        clock = read_text_table(tmp_path / "rig.csv").frame["t"]
        assert clock.eq(9 * 3600 + 0.01).all()


def test_no_header_and_a_first_cell_that_is_no_number(tmp_path):
    path = tmp_path / "rig.csv"
    path.write_text(separated(TABLE, ",", header=False))
    columns = [f"{name}={i}" for i, name in enumerate(SENSED, 1)]
    assert_same(read_measured(path, beam=BEAM, columns=columns))
    path.write_text("foot_x,force_x,moment_z\nERR,1,2\n0.1,1,2\n0.2,1,2\n")
    assert len(read_text_table(path).frame) == 3


def test_rows_that_lack_numbers_may_come_first(tmp_path):
    """With a text in each row they were taken for names: "column 'stage' missing"."""
    table = TABLE.assign(run="p1")[["run", *NAMES]]
    table.loc[:4, ["Fx", "Fy", "Mz"]] = np.nan
    (tmp_path / "rig.csv").write_text(separated(table, ";"))
    found = read_measured(tmp_path / "rig.csv", beam=BEAM, columns=COLUMNS)
    assert (len(found.table), int(found.trusted.sum())) == (40, 35)


def test_tables_and_units():
    columns = ["foot_x=stage:mm", "force_x=Fx:mN", "force_y=Fy:mN", "moment_z=Mz:mN mm"]
    expected = TABLE * [1e-3, 1e-3, 1e-3, 1e-6]
    assert_same(read_measured(TABLE, beam=BEAM, columns=columns), expected)
    assert_same(read_measured(TABLE.to_dict("list"), beam=BEAM, columns=columns), expected)


@pytest.mark.parametrize(
    ("columns", "said"),
    [
        (COLUMNS, "column Fy, line 3 of rig"),
        ([*COLUMNS[:2], COLUMNS[1]], "the only one for force_x"),
        (["foot_x=stage:0 m"], "'0 m'"),
        (["foot_x=stag"], "one of stage, Fx, Fy, Mz"),
        (["foot=stage"], "NAME=COLUMN"),
    ],
)
@pytest.mark.parametrize("decimal", [".", ","])
def test_what_cannot_be_read_is_named(tmp_path, columns, said, decimal):
    table = TABLE.astype(str)
    table.iloc[1, 2] = "ERR"
    path = tmp_path / "rig.csv"
    path.write_text(table.to_csv(index=False, sep=";").replace(".", decimal))
    with pytest.raises(InputError) as refused:
        read_measured(path, beam=BEAM, columns=columns)
    assert said in str(refused.value).replace(f"{path}", "rig.csv")


def test_a_line_with_another_number_of_cells(tmp_path):
    path = tmp_path / "rig.csv"
    for line in ("1,2", "1,2,3,4,5"):
        path.write_text(TABLE.to_csv(index=False) + line + "\n")
        with pytest.raises(InputError, match=r"line 42 .* cells: must be 4"):
            read_measured(path, beam=BEAM, columns=COLUMNS)


def test_there_and_back_are_two_sweeps():
    both = pd.concat([TABLE, TABLE[::-1]])
    (left, one), (right, two) = read_sweeps(both, beam=BEAM, columns=COLUMNS)
    assert (left, right) == ("left", "right")
    assert one.values("foot_x")[0] == two.values("foot_x")[-1] == 1
    assert len(read_measured(both, beam=BEAM, columns=COLUMNS, direction="right").table) == 39
    with pytest.raises(InputError, match="one to the left, one to the right"):
        read_measured(both, beam=BEAM, columns=COLUMNS)


def test_rows_out_of_order_and_repeated_positions():
    shuffled = read_measured(TABLE.sample(frac=1, random_state=1), beam=BEAM, columns=COLUMNS)
    assert_same(shuffled)
    assert min(shuffled.provenance["rows"][name] for name in ("out_of_order", "retreats")) > 0
    thrice = TABLE.loc[np.repeat(TABLE.index, 3)]
    thrice["Fx"] += np.tile([-0.5, 0.0, 0.5], 40)
    repeated = read_measured(thrice, beam=BEAM, columns=COLUMNS)
    assert_same(repeated)
    assert repeated.provenance["rows"] == {"out_of_order": 0, "retreats": 0, "averaged": 80}
    jitter = TABLE.assign(stage=FOOT + 0.03 * np.random.default_rng(0).standard_normal(40))
    found = read_measured(jitter, beam=BEAM, columns=COLUMNS)
    assert (np.diff(found.values("foot_x")) < 0).all()


def test_what_an_engine_wrote_is_taken_as_it_is(tmp_path):
    sweep = exact_sweep("parabola")
    for name in ("own.csv", "own.parquet"):
        found = read_measured(sweep.write(tmp_path / name))
        pd.testing.assert_frame_equal(found.table, Readings.read(tmp_path / name).table)
        assert found.provenance == sweep.provenance
    sweep.table.to_csv(tmp_path / "bare.csv", index=False)
    assert list(read_measured(tmp_path / "bare.csv").table["phase"]) == list(sweep.table["phase"])


def test_clamp_and_friction_come_with_the_beam(tmp_path):
    """From the file that names the vibrissa; a later file overrides what readings record."""
    held = {"clamp_stiffness": 6.0, "friction": 0.25}
    curved = Beam(natural_curvature=-0.4)
    exact = solve_sweep(Case(curved, circle(1.0, lowest=(0, 0.4)), Sweep(60), **held))
    exact.table[list(SENSED)].to_csv(tmp_path / "rig.csv", index=False)
    beam = tmp_path / "beam.toml"
    beam.write_text(
        "[beam]\nnatural_curvature = -0.4\n[support]\nrotational_stiffness = 6\n"
        "[contact]\nfriction = 0.25\n"
    )
    found = reconstruct(read_measured(tmp_path / "rig.csv", beam))
    there = np.isfinite(found["contact_x"])
    assert there.sum() == (exact.table["phase"] != "free").sum()
    assert np.abs(found["contact_x"] - exact.values("contact_x"))[there].max() < 1e-12
    exact.write(tmp_path / "ours.parquet")
    assert read_measured(tmp_path / "ours.parquet").support == Support(6.0, 0.25)
    beam.write_text("[beam]\nnatural_curvature = -0.4\n[contact]\nfriction = 0.0\n")
    assert read_measured(tmp_path / "ours.parquet", beam).support == Support()
    beam.write_text("[beam]\n[support]\nrotational_stiffness = 1e-9\n")
    with pytest.raises(InputError, match="hundredth"):
        read_measured(tmp_path / "rig.csv", beam)


def test_a_channel_without_a_number_is_named():
    with pytest.raises(InputError, match="moment_z of table = without any number"):
        read_measured(TABLE.assign(Mz=np.nan), beam=BEAM, columns=COLUMNS)
