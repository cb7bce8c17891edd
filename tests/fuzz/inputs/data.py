"""Files of readings as rigs, accidents and other programs write them."""

import io
import json

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from tests.fuzz.inputs.dice import Dice
from tests.fuzz.inputs.sound import good_csv, sweep_table
from tests.fuzz.inputs.trial import Trial

LINES = (
    "# a comment", "", "ERR,ERR,ERR,ERR", "1,2", "date;time", '"', "true,false,true,true",
    "1e999,1,1,1", "\x00", "0.5;0.5;0.5;0.5", "NaN,NaN,NaN,NaN", ",,,", "1,2,3,4,5",
    "# vibrissa {}", "# vibrissa {", "9" * 400 + ",1,1,1", "=1+1,1,1,1", "1_0,1,1,1",
)  # fmt: skip
COLUMNS = (
    "foot_x=stage:mm", "force_x=1", "foot_x=a:b:c", "x=y", "moment_z=Mz:N m", "force_y=Fy:0 N",
    "foot_x=foot_x:parsec", "=", "foot_x=", "foot_x=foot_x:m", "force_x=force_x:N",
    "force_y=force_y:N", "moment_z=moment_z:N mm", "moment_z=moment_z:N", "force_x=force_y",
)  # fmt: skip
FITTED = ("flexural_rigidity", "clamp_stiffness", "natural_curvature", "friction", "offset", "x")


def data(dice: Dice) -> Trial:
    """A file of a rig, and a command that reads it."""
    if dice.chance(0.25):
        name, content = "rig.parquet", _parquet(dice)
    else:
        name = dice.pick("rig.csv", "rig.csv", "rig.txt", "rig.dat", "rig.tsv", "rig.xls", "rig")
        content = _text(dice)
    if dice.chance(0.2):
        content = dice.damaged(content)
    files = {
        name: content,
        "good.csv": good_csv(),
        "more.csv": good_csv(),
        "beam.toml": b"[beam]\nlength = 1.0\n",
    }
    words = dice.pick(
        ["reconstruct", name],
        ["calibrate", name, dice.pick("parabola", "catenary")],
        ["compare", "good.csv", name],
        ["compare", name, "good.csv"],
        ["compare", "good.csv", name, "more.csv"],
        ["compare", name, "good.csv", "more.csv"],
    )
    for spec in dice.some(COLUMNS, 2) if dice.chance(0.4) else []:
        words += ["--column", spec]
    if dice.chance(0.3):
        words += ["--beam", dice.pick("beam.toml", "good.csv", "nowhere.toml")]
    words += dice.some(("--direction=left", "--direction=right"), 1)
    if words[0] == "calibrate":
        words += ["--fit", ",".join(dice.some(FITTED, 2)) or dice.pick(*FITTED)]
    if "more.csv" not in words:
        words += dice.some(("--noise=0.01", "--noise=0", "--noise=auto", "--noise=-1"), 1)
    if words[0] == "compare" and "more.csv" not in words:
        words += dice.some(("--offset=auto", "--offset=0.1", "--offset=1e300"), 1)
    return Trial("data", [*words, "--out", "out"], files)


def _table(dice: Dice) -> pd.DataFrame:
    """A sweep with some accident."""
    table = sweep_table().copy()
    match dice.below(12):
        case 0:
            table = table.sample(frac=1, random_state=dice.below(1000))
        case 1:
            table = table.iloc[np.r_[0 : len(table), len(table) - 1 : -1 : -1]]
        case 2:
            table = table.iloc[np.repeat(np.arange(len(table)), 3)]
        case 3:
            table["foot_x"] = table["foot_x"].round().astype(int)
        case 4:
            table = table * 10.0 ** dice.rng.integers(-300, 300)
        case 5:
            table = table.head(int(dice.rng.integers(0, 4)))
        case 6:
            table.iloc[:, dice.below(4)] = dice.pick(np.nan, np.inf, 0.0, 1.0)
        case 7:
            noise = dice.rng.standard_normal(table.shape) * table.abs().max().to_numpy()
            table = table + noise * dice.pick(0.01, 0.1, 10)
        case 8:
            table[dice.pick("phase", "status", "contact_x", "tip_angle")] = dice.pick(
                "ok", "tip", 1, "", "x"
            )
        case 9:
            table.iloc[:, 1:] = table.iloc[:, 1:].where(dice.rng.random((len(table), 3)) < 0.7)
    return table


def _text(dice: Dice) -> bytes:
    """A table in some dialect, with strange lines in it."""
    mark, decimal = dice.pick((",", "."), (";", ","), (";", "."), ("\t", ","), (" ", "."),
                              (",", ","), ("|", "."))  # fmt: skip
    text = _table(dice).to_csv(sep=mark, decimal=decimal, index=False, header=dice.chance(0.9))
    lines = text.splitlines()
    for _ in range(dice.rng.integers(0, 3)):
        at = int(dice.rng.integers(len(lines))) if lines else 0
        lines.insert(at, dice.pick(*LINES))
    text = dice.pick("\n", "\n", "\r\n", "\r").join(lines)
    encoding = dice.pick("utf-8", "utf-8", "utf-8-sig", "utf-16", "latin-1")
    return text.encode(encoding, "replace")


def _parquet(dice: Dice) -> bytes:
    """A table with a column of another type, or with metadata that nobody wrote."""
    table = pa.Table.from_pandas(_table(dice), preserve_index=False)
    if dice.chance(0.6) and table.num_columns:
        n = table.num_rows
        strange = dice.pick(
            pa.array([True] * n), pa.array([[1.0]] * n), pa.array([{"a": 1}] * n),
            pa.array(["x"] * n).dictionary_encode(), pa.array([None] * n),
            pa.array(["1.5"] * n), pa.array([b"\xff"] * n), pa.array([2**63 - 1] * n),
            pa.array([0] * n, pa.timestamp("ns")), pa.array([0] * n, pa.duration("s")),
            pa.array([0.5] * n, pa.float32()), pa.array([1] * n, pa.decimal128(10, 2)),
        )  # fmt: skip
        at = dice.below(table.num_columns)
        table = table.set_column(at, table.column_names[at], strange)
    said = dice.pick(
        {}, [], None, 1, {"beam": {}}, {"beam": {"length": "1"}}, {"beam": {"length": -1}},
        {"source": 1}, {"provenance": []}, {"provenance": {"contour": 1}}, {"source": "$$ [/b]"},
        {"provenance": {"contour": [[0, 1], [2]], "events": 3, "settings": []}},
        {"provenance": {"events": {"snap_off": "x"}, "seconds": "long"}}, {"extra": 1},
        {"provenance": {"events": {"snap_off": {"foot_x": None}}, "settings": {"segments": "x"}}},
    )  # fmt: skip
    text = dice.pick(json.dumps(said), json.dumps(said), "{" * 3000, "[" * 100_000, "\xff", "")
    if dice.chance(0.7):
        table = table.replace_schema_metadata({b"vibrissa": text.encode("latin-1")})
    file = io.BytesIO()
    pq.write_table(table, file)
    return file.getvalue()
