"""Mistakes planted in files, their keys in a file apart: how often a comparison names them.

``python -m tests.fuzz.hidden make N SEED DIR`` writes N pairs of sweeps and ``DIR.keys.csv``;
``... name DIR`` writes what the comparison says of each into ``DIR/named.csv`` and sees no key;
``... judge DIR`` puts the two together. This file knows the names of mistakes, and nothing of how
they are found. Visible is what moves a reading by three times its noise and own error together.
"""

import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TypeAlias

import numpy as np
import pandas as pd
from scipy.ndimage import gaussian_filter1d, shift

from analytic import (
    CLAMP_READINGS,
    SENSED,
    Beam,
    Case,
    InputError,
    Readings,
    Sweep,
    ellipse,
    parabola,
    solve_sweep,
)
from compare import compare
from tests.fuzz.draws import log_uniform

FORCES = CLAMP_READINGS[:2]
_VISIBLE = 3.0
_TWO = 0.3  # of the plantings are two mistakes at once
_BOTH = "two things at once: "
Table: TypeAlias = pd.DataFrame
Act: TypeAlias = Callable[[Table, np.random.Generator], Table]


def _size(rng: np.random.Generator, low: float, high: float) -> float:
    """Of either sign, evenly spread in its logarithm."""
    return float(log_uniform(rng, low, high) * rng.choice([-1, 1]))


def _largest(values: pd.Series) -> float:
    return float(values.abs().max())


def _channel(act: Callable[[pd.Series, np.random.Generator], "pd.Series | np.ndarray"]) -> Act:
    """In one channel."""

    def made(table: Table, rng: np.random.Generator) -> Table:
        name = str(rng.choice(CLAMP_READINGS))
        return table.assign(**{name: act(table[name], rng)})

    return made


def _all(act: Callable[[pd.Series, np.random.Generator], "pd.Series | np.ndarray"]) -> Act:
    def made(table: Table, rng: np.random.Generator) -> Table:
        return table.assign(**{name: act(table[name], rng) for name in CLAMP_READINGS})

    return made


def _exchange(*names: str) -> Act:
    return lambda table, rng: table.assign(
        **dict(zip(names, table[list(names[::-1])].to_numpy().T, strict=True))
    )


def _turn(table: Table, rng: np.random.Generator) -> Table:
    turned = (table[FORCES[0]] + 1j * table[FORCES[1]]) * np.exp(1j * np.deg2rad(_size(rng, 3, 12)))
    return table.assign(**{FORCES[0]: turned.map(np.real), FORCES[1]: turned.map(np.imag)})


def _late(table: Table, rng: np.random.Generator) -> Table:
    by = float(rng.uniform(2, 6))
    return table.assign(
        **{n: shift(table[n].to_numpy(), by, order=1, mode="nearest") for n in CLAMP_READINGS}
    )


def _leak(table: Table, rng: np.random.Generator) -> Table:
    into, out = rng.permutation(CLAMP_READINGS)[:2]
    scale = _size(rng, 0.05, 0.25) * _largest(table[into]) / _largest(table[out])
    return table.assign(**{into: table[into] + scale * table[out]})


def _hum(table: Table, rng: np.random.Generator) -> Table:
    waves = np.sin(np.arange(len(table)) * rng.uniform(0.5, 2.6) + rng.uniform(0, 6))
    return table.assign(
        **{
            n: table[n] + rng.uniform(0.02, 0.05) * _largest(table[n]) * waves
            for n in CLAMP_READINGS
        }
    )


def _empty(value: float) -> Act:
    def made(table: Table, rng: np.random.Generator) -> Table:
        table, first = table.copy(), int(rng.uniform(0.3, 0.6) * len(table))
        rows = slice(first, first + int(rng.uniform(0.05, 0.12) * len(table)))
        table.iloc[rows, [list(table).index(name) for name in CLAMP_READINGS]] = value
        return table

    return made


def _spike(values: pd.Series, rng: np.random.Generator) -> np.ndarray:
    spiked = values.to_numpy().copy()
    at = rng.choice(np.arange(len(spiked) // 4, len(spiked) // 2), 2, replace=False)
    spiked[at] += _size(rng, 1, 30) * _largest(values)
    return spiked


def _ended(table: Table, rng: np.random.Generator) -> Table:
    loaded = np.flatnonzero(table["force_y"].abs() > 0.05)
    last, table = loaded[int(rng.uniform(0.6, 0.9) * len(loaded))], table.copy()
    table.iloc[last:, [list(table).index(name) for name in CLAMP_READINGS]] = 0.0
    return table


def _foot(act: Callable[[pd.Series, np.random.Generator], pd.Series]) -> Act:
    return lambda table, rng: table.assign(foot_x=act(table["foot_x"], rng))


SENSOR: dict[str, Act] = {
    "force_x and force_y swapped": _exchange(*FORCES),
    "and moment_z swapped": lambda table, rng: _exchange(str(rng.choice(FORCES)), "moment_z")(
        table, rng
    ),
    "opposite sign of {0}": _channel(lambda v, rng: -v),
    "all three readings have the opposite sign": _all(lambda v, rng: -v),
    "{0} in another unit": _channel(lambda v, rng: v * rng.choice([1e3, 1e-3, 4.4482216, 9.80665])),
    "gain of {0}": _channel(lambda v, rng: v * (1 + _size(rng, 0.05, 0.35))),
    "zero of {0}": _channel(lambda v, rng: v + _size(rng, 0.03, 0.12) * _largest(v)),
    "gain of {0} & zero of {0}": _channel(
        lambda v, rng: v * (1 + _size(rng, 0.08, 0.3)) + _size(rng, 0.04, 0.1) * _largest(v)
    ),
    "drift of all": _all(
        lambda v, rng: v + _size(rng, 0.06, 0.2) * _largest(v) * np.linspace(0, 1, len(v))
    ),
    "drift of {0}": _channel(
        lambda v, rng: v + _size(rng, 0.06, 0.2) * _largest(v) * np.linspace(0, 1, len(v))
    ),
    "{0} lags": _channel(
        lambda v, rng: shift(v.to_numpy(), rng.uniform(2, 6), order=1, mode="nearest")
    ),
    "or a lag": _late,
    "cubic": _channel(lambda v, rng: v * (1 + _size(rng, 0.08, 0.3) * (v / _largest(v)) ** 2)),
    "crosstalk": _leak,
    "sensor turned by": _turn,
    "along the vibrissa off the clamp": lambda table, rng: table.assign(
        moment_z=table["moment_z"] + _size(rng, 0.03, 0.1) * table["force_x"]
    ),
    "the same at all stations": _foot(lambda v, rng: v + _size(rng, 0.01, 0.04)),
    "scale of the stage": _foot(lambda v, rng: v * (1 + _size(rng, 0.012, 0.05))),
}
FILE: dict[str, Act] = {
    "dead channel": _channel(lambda v, rng: 0 * v),
    "filled with zeros": _empty(0.0),
    "lack a number": _empty(np.nan),
    "single stations": _channel(_spike),
    "cut off at the extreme": _channel(
        lambda v, rng: v.clip(*(np.array([-1, 1]) * v.abs().quantile(rng.uniform(0.7, 0.88))))
    ),
    "quantised": _channel(
        lambda v, rng: (v / (s := rng.uniform(0.03, 0.08) * _largest(v))).round() * s
    ),
    "hum": _hum,
    "ends early": _ended,
    "rows reversed": lambda table, rng: table.iloc[::-1].reset_index(drop=True),
    "foot_x counts the other way": _foot(lambda v, rng: -v),
    "rows out of order": lambda table, rng: table.sample(
        frac=1, random_state=int(rng.integers(1 << 31))
    ).reset_index(drop=True),
}


def _other(case: Case, **beam: float) -> Readings:
    """The sweep of another vibrissa in the same way, begun clear of the object."""
    start, stop = (float(x) for x in case.foot_x[[0, -1]])
    sweep = replace(case.sweep, start=start + 0.15, stop=stop)
    return replace(
        solve_sweep(replace(case, beam=replace(case.beam, **beam), sweep=sweep)), beam=case.beam
    )


WORLD: dict[str, Callable[[Case, np.random.Generator], Readings]] = {
    "flexural rigidity": lambda case, rng: _other(
        case, flexural_rigidity=1 + _size(rng, 0.05, 0.3)
    ),
    "length of the vibrissa": lambda case, rng: _other(case, length=1 + _size(rng, 0.012, 0.04)),
    "natural curvature": lambda case, rng: _other(case, natural_curvature=_size(rng, 0.06, 0.4)),
    "tip radius": lambda case, rng: _other(
        case, tip_radius=float(rng.uniform(0.5, 0.9)) * case.beam.radius
    ),
    "clamp stiffness": lambda case, rng: solve_sweep(
        replace(case, clamp_stiffness=float(rng.uniform(5, 40)))
    ),
    "friction about": lambda case, rng: solve_sweep(
        replace(case, friction=float(rng.uniform(0.06, 0.25)))
    ),
    "half a cell": lambda case, rng: solve_sweep(
        replace(case, clamp_stiffness=2.0 * int(rng.integers(8, 30)))
    ),
    "height of the object|object's surface": lambda case, rng: solve_sweep(
        replace(
            case,
            profile=case.profile.raised(_size(rng, 0.006, 0.025)),
            sweep=replace(
                case.sweep, start=float(case.foot_x[0]) + 0.05, stop=float(case.foot_x[-1])
            ),
        )
    ),
}
PAIRED = (
    *("gain of {0}", "zero of {0}", "drift of {0}", "opposite sign of {0}"),
    *("crosstalk", "the same at all stations"),
)


def _case(rng: np.random.Generator) -> Case:
    height = rng.uniform(0.35, 0.65)
    if rng.integers(3):
        contour = ellipse(
            (rng.uniform(0.3, 2.5), rng.uniform(0.4, 1.5)), (rng.uniform(-0.2, 0.2), height)
        )
    else:
        contour = parabola(rng.uniform(0.2, 1.2), height)
    return Case(Beam(), contour, Sweep(int(rng.integers(90, 240))))


def planted(rng: np.random.Generator) -> tuple[Readings, Readings, str, bool]:
    """Reference, candidate, the words that name the mistake, and whether it can be seen."""
    first = str(rng.choice([*SENSOR, *FILE, *WORLD]))
    second = str(rng.choice(PAIRED)) if rng.random() < _TWO else ""
    signs = "opposite sign" in first and "opposite sign" in second  # which undo each other
    if first in FILE or signs or second.startswith(first[:7]):
        second = ""
    while True:
        case = _case(rng)
        try:
            reference = solve_sweep(case)
            true = WORLD[first](case, rng) if first in WORLD else reference
            break
        except InputError:
            continue
    table, level = true.table[list(SENSED)].copy(), float(rng.uniform(0, 4e-3))
    own = {}
    for name in CLAMP_READINGS:
        rough = gaussian_filter1d(rng.standard_normal(len(table)), len(table) / 12)
        loaded = np.where(table[name] != 0, rough / np.std(rough), 0.0)
        own[name] = loaded * rng.uniform(2e-4, 1e-3) * _largest(table[name])
    table = table.assign(**{name: table[name] + own[name] for name in CLAMP_READINGS})
    words = []
    for kind in filter(None, (first, second)):
        before = table
        if kind in SENSOR:
            table = SENSOR[kind](table, rng)
        changed = [one for one in CLAMP_READINGS if not table[one].equals(before[one])]
        words.append(kind.format(*changed))
    scale = {name: level * _largest(table[name]) for name in CLAMP_READINGS}
    noise = {name: scale[name] * rng.standard_normal(len(table)) for name in CLAMP_READINGS}
    table = table.assign(**{name: table[name] + noise[name] for name in CLAMP_READINGS})
    if first in FILE:
        table = FILE[first](table, rng)
    seen = False
    for name in CLAMP_READINGS:
        moved = np.interp(
            -reference.values("foot_x"), -table["foot_x"], table[name].fillna(0)
        ) - reference.values(name)
        grain = np.hypot(scale[name], np.std(own[name]))
        seen |= bool(np.sqrt(np.mean(moved**2)) > _VISIBLE * grain)
    return (
        reference,
        Readings(table, case.beam, "rig"),
        " & ".join(words),
        seen,
    )


def make(count: int, seed: int, folder: Path) -> None:
    """Files of sweeps, and their keys beside the folder."""
    folder.mkdir(parents=True)
    keys = []
    for number in range(count):
        reference, candidate, key, seen = planted(np.random.default_rng([seed, number]))
        reference.write(folder / f"{number:03d}-reference.parquet")
        candidate.write(folder / f"{number:03d}-candidate.parquet")
        keys.append((number, key, seen))
    pd.DataFrame(keys, columns=["number", "key", "seen"]).to_csv(f"{folder}.keys.csv", index=False)


def name(folder: Path) -> None:
    """What is said of each pair."""
    said = []
    for file in sorted(folder.glob("*-reference.parquet")):
        reference = Readings.read(file)
        candidate = Readings.read(folder / file.name.replace("reference", "candidate"))
        try:
            found = compare(reference, candidate)
            words = found.likely or "; ".join(found.records["candidate"].defects()) or ""
        except InputError as refused:
            words = str(refused)
        said.append((int(file.name[:3]), words))
    pd.DataFrame(said, columns=["number", "said"]).to_csv(folder / "named.csv", index=False)


def judge(folder: Path) -> pd.DataFrame:
    """A row a mistake: of those that can be seen, named rightly, one of two, not, or wrongly."""
    both = pd.read_csv(f"{folder}.keys.csv").merge(pd.read_csv(folder / "named.csv"), on="number")
    both = both[both["seen"]].fillna({"said": ""})
    both["how"] = [_judged(key, said) for key, said in zip(both["key"], both["said"], strict=True)]
    return both


def _judged(key: str, said: str) -> str:
    """What names nothing that was planted is wrong, also beside what does."""
    words = [word.split("|") for word in key.split(" & ")]
    pieces = said.removeprefix(_BOTH).split("; and ") if said.startswith(_BOTH) else [said]

    def is_in(text: str) -> list[bool]:
        return [any(word in text for word in either) for either in words]

    if not said:
        return "silent"
    if not all(any(is_in(piece)) for piece in pieces):
        return "wrong"
    return "right" if all(is_in(said)) else "one of two"


def main() -> None:
    """One of the three steps."""
    step, *rest = sys.argv[1:]
    folder = Path(rest[-1])
    if step == "make":
        make(int(rest[0]), int(rest[1]), folder)
    elif step == "name":
        name(folder)
    else:
        found = judge(folder)
        print(
            pd.crosstab(
                found["key"]
                .str.replace("(force|moment)_[xyz]", "*", regex=True)
                .str.split(" & ")
                .str[0],
                found["how"],
            ).to_string()
        )
        print(
            found.loc[
                found["how"].isin(["wrong", "one of two"]), ["number", "key", "said"]
            ].to_string(max_colwidth=110)
        )
        print(found["how"].value_counts(normalize=True).to_string(), len(found))


if __name__ == "__main__":
    main()
