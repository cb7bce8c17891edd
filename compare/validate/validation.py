"""The verdict of a validation: is the disagreement larger than what is uncertain about it?"""

import math
from dataclasses import asdict, dataclass, field, replace
from typing import Any, ClassVar, Literal, TypeAlias, get_args

import numpy as np
import pandas as pd
from pydantic import ConfigDict

from analytic import CLAMP_READINGS, Case, InputError, Readings
from analytic.from_clamp.correlated import estimate
from analytic.numerics.arrays import Floats
from analytic.problem.errors import require, unknown
from compare.explain.budget import Budget
from compare.judge.allowance import NoiseAllowance
from compare.judge.tolerances import Tolerances
from compare.measure.disagreement import before_snap_off, rms
from compare.measure.measurement import Measurement
from compare.sense.noise import shown_noise
from compare.validate.sensitivities import sensitivities
from compare.validate.spread import NOISE, NUMERICS, SECOND_ORDER, Spread
from compare.validate.stated import Uncertainties

Side: TypeAlias = Literal["reference", "candidate"]

_SAMPLES = 64  # of the inputs: what second-order terms add is known to a sixth of itself
_MOST = 10_000  # stations that count; of more, every second or third one and so on
_LARGEST = 1e6  # of a reading's largest magnitude; whoever states more means another unit
_SNAP = 3.0  # standard uncertainties of the snap-off's place in which nothing is linear
_MOST_ALIKE = 0.98  # correlation from station to station: fewer than two degrees of freedom in 100
_DOMINATES = 0.5  # fraction of the variance


@dataclass(frozen=True)
class Difference:
    """A disagreement and its uncertainty as root mean squares, relative to the readings."""

    error: float  # of E = S - D, simulation less data
    u_num: float  # standard uncertainties by numerics, inputs and noise
    u_input: float  # standard uncertainties by numerics, inputs and noise
    u_data: float  # standard uncertainties by numerics, inputs and noise
    u_val: float  # all three together: the root of the sum of their squares
    # K, by which u_val is expanded: E of a right model stays below k u_val in 95.45 %.
    coverage: float
    # How much of u_val squared each input, the numerics and the noise make.
    shares: dict[str, float]

    @property
    def limit(self) -> float:
        """The expanded uncertainty, k u_val."""
        return self.coverage * self.u_val

    @property
    def resolved(self) -> bool:
        """Whether the disagreement is larger than its uncertainty: then the model is in error."""
        return self.error > self.limit

    def to_dict(self) -> dict[str, Any]:
        return {**asdict(self), "limit": self.limit, "resolved": self.resolved}


@dataclass(frozen=True, repr=False)
class Validation:
    """The verdict of a validation in the sense of ASME V&V 20.

    Attributes
    ----------
    simulation : {"reference", "candidate"}
        Which of the two sweeps is the simulation S; the other one is the data D.
    whole : Difference
        Of all readings and stations.
    by_reading : dict of Difference
        Of each clamp reading.
    dominant : str
        The input, or ``"noise"`` or ``"numerics"``, that makes most of u_val.
    shrink : float or None
        By what its uncertainty has to be multiplied for the disagreement to be resolved, whatever
        its error is; 1 if it is resolved already, None if that error, or what else is uncertain,
        may make all of it.
    shrink_all : float or None
        The same for all uncertainties together.
    standard : dict
        Standard uncertainty of each input, in the unit of the case.
    noise : dict
        Standard deviation of each reading's noise, relative to its largest magnitude.
    noise_source : str
        Where that is from: ``"stated"``, ``"estimated"``, or both by reading.
    numerics_source : str
        What u_num is from.
    second_order : float
        What the sensitivities miss of the change of the readings under the stated errors, as a
        fraction of it, from samples. It is part of u_input.
    samples : int
        How many samples there are.
    stations : int
        How many stations count.
    left_out : dict
        How many compared stations do not, by reason.
    table : pandas.DataFrame
        A row a reading and station: ``foot_x`` [length], ``phase``, ``reading``, and relative to
        the reading's largest magnitude ``error`` (with its sign), ``u_num``, ``u_input``,
        ``u_data``, ``u_val``.
    """

    __pydantic_config__: ClassVar = ConfigDict(arbitrary_types_allowed=True)  # the table is one

    simulation: Side
    whole: Difference
    by_reading: dict[str, Difference]
    dominant: str
    shrink: float | None
    shrink_all: float | None
    standard: dict[str, float]
    noise: dict[str, float]
    noise_source: str
    numerics_source: str
    second_order: float
    samples: int
    stations: int
    left_out: dict[str, int]
    table: pd.DataFrame = field(compare=False)

    def __repr__(self) -> str:
        found = "resolved" if self.resolved else "not resolved"
        whole = f"E {self.whole.error:.2g}, k u_val {self.whole.limit:.2g}"
        return f"Validation({found}: {whole}, most by {self.dominant})"

    @property
    def resolved(self) -> bool:
        """Whether the disagreement of all readings is larger than its uncertainty."""
        return self.whole.resolved

    @property
    def dominates(self) -> bool:
        """Whether the dominant part alone makes more than half of u_val squared."""
        return self.whole.shares[self.dominant] > _DOMINATES

    def to_dict(self) -> dict[str, Any]:
        """What ``comparison.json`` holds; the table has a file of its own.

        Returns
        -------
        dict
            JSON can hold it.
        """
        found = {name: value for name, value in vars(self).items() if name != "table"}
        return {
            **found,
            "whole": self.whole.to_dict(),
            "by_reading": {name: one.to_dict() for name, one in self.by_reading.items()},
            "resolved": self.resolved,
            "dominates": self.dominates,
        }


def validate(
    found: Measurement,
    case: Case,
    stated: Uncertainties,
    *,
    simulation: Side = "reference",
    budget: Budget | None = None,
    noise: NoiseAllowance | None = None,
    window: float = Tolerances.snap_off_window,
    samples: int = _SAMPLES,
) -> Validation:
    """Hold a disagreement against what is uncertain about it.

    After ASME V&V 20-2009, Standard for verification and validation in computational fluid dynamics
    and heat transfer, sections 1 and 3 to 5: E = S - D, u_val^2 = u_num^2 + u_input^2 + u_D^2. An
    error of an input is the same at all stations, so the whole sweep is judged by the covariance of
    its differences (`compare.validate.spread.Spread`).

    Parameters
    ----------
    found : Measurement
        Simulation and data, set side by side.
    case : Case
        What was simulated: the nominal inputs.
    stated : Uncertainties
        What is uncertain about them.
    simulation : {"reference", "candidate"}
        Which of the two sweeps is the simulation.
    budget : Budget, optional
        Of the simulation's numerics; without it the closed form's residuals count, and any other
        simulation is taken for exact, which is said.
    noise : NoiseAllowance, optional
        Noise that was asked for in the comparison, for readings without a stated one.
    window : float
        Stretch before the snap-off, of the sweep's length, that does not count. It is widened by
        three standard uncertainties of the snap-off's place.
    samples : int
        Of the inputs, to check the sensitivities with.

    Returns
    -------
    Validation
        The verdict, and what it is made of.

    Raises
    ------
    InputError
        If no compared station has a sensitivity, or the case cannot be solved with its inputs off.
    """
    require("found", found, Measurement, "as compare(reference, candidate)")
    if simulation not in get_args(Side):
        raise unknown("simulation", simulation, get_args(Side))
    require("case", case, Case, "as compare.load_case(file).case").require_sweep("a validation")
    reach = sensitivities(case, stated, samples)
    whole_table = found.alignment.table
    table = whole_table.iloc[:: -(-len(whole_table) // _MOST) or 1].reset_index(drop=True)
    here = reach.at(table["at"].to_numpy())
    sweep = float(np.ptp(found.reference.values("foot_x")))
    place = float(np.sqrt(reach.snap_off @ stated.correlation @ reach.snap_off))
    widened = window + _SNAP * place / sweep
    near = before_snap_off(found.reference, here.foot_x, found.snap_off, widened)
    blind = np.isnan(here.readings).any(axis=(0, 1)) & ~near
    kept = ~near & ~blind
    if not kept.any():
        what = f"none of {len(table)} compared"
        allowed = "some away from the snap-off whose sensitivity is known"
        remedy = "state smaller uncertainties, or add stations"
        raise InputError("stations of the validation", what, allowed, remedy)
    table = table[kept].reset_index(drop=True)
    scale = np.array([found.disagreement[name].scale for name in CLAMP_READINGS])
    error = _values(table, "reference") - _values(table, "candidate")
    error *= (1.0 if simulation == "reference" else -1.0) / scale[:, None]
    data = found.candidate if simulation == "reference" else found.reference
    level, noise_source = _noise(data, stated, noise, scale)
    numerics, numerics_source = _numerics(found, simulation, budget, table)
    first, second = (
        part[:, :, kept] / scale[:, None]
        for part in (here.readings, np.nan_to_num(here.samples - here.predicted))
    )
    spread = _spread(stated, first, second, numerics, level)
    spread = replace(spread, alike=_alike(error, spread))
    whole = _difference(error.ravel(), spread)
    dominant = max(
        (name for name in whole.shares if name != SECOND_ORDER), key=whole.shares.__getitem__
    )
    rows = len(table)
    return Validation(
        simulation,
        whole,
        {
            name: _difference(error[i], spread.part(slice(i * rows, (i + 1) * rows)))
            for i, name in enumerate(CLAMP_READINGS)
        },
        dominant,
        spread.shrink(error.ravel(), [dominant]),
        spread.shrink(error.ravel(), whole.shares),
        {name: one.standard for name, one in stated.inputs.items()},
        dict(zip(CLAMP_READINGS, level.tolist(), strict=True)),
        noise_source,
        numerics_source,
        _ratio(second, first),
        len(second),
        rows,
        {
            "before_snap_off": int(near.sum()),
            "without_sensitivity": int(blind.sum()),
            "thinned": len(whole_table) - len(near),
        },
        _table(table, error, spread),
    )


def _values(table: pd.DataFrame, which: Side) -> Floats:
    return np.stack([table[f"{name}_{which}"].to_numpy() for name in CLAMP_READINGS])


def _noise(
    data: Readings, stated: Uncertainties, asked: NoiseAllowance | None, scale: Floats
) -> tuple[Floats, str]:
    """Standard deviation of the noise of the data, over each reading's largest magnitude."""
    sizes = dict(zip(CLAMP_READINGS, scale.tolist(), strict=True))
    by = "the scatter between passes" if "scatter" in data.provenance else "estimated from the data"
    known = {n: (by, x / sizes[n]) for n, x in shown_noise(data).level.items()}
    if asked is not None:
        known |= {n: ("of the comparison", x) for n, x in asked.level.items() if x > 0}
    known |= {n: ("stated", x / sizes[n]) for n, x in stated.noise.items()}
    sources, levels = zip(*(known[name] for name in CLAMP_READINGS), strict=True)
    if len(set(sources)) == 1:
        return np.array(levels), sources[0]
    said = (f"{name} {source}" for name, source in zip(CLAMP_READINGS, sources, strict=True))
    return np.array(levels), ", ".join(said)


def _numerics(
    found: Measurement, simulation: Side, budget: Budget | None, table: pd.DataFrame
) -> tuple[Floats, str]:
    """Errors of the simulation's numerics, shape (parts, 3, stations), and where they are from.

    Of a budget's parts only sizes are known, by reading and phase; each is taken for one error that
    is the same at all stations.
    """
    shape = (len(CLAMP_READINGS), len(table))
    if budget is not None:

        def size(part: str, reading: str, phase: str) -> float:
            one = budget.parts[part][reading]
            return math.hypot(budget.by_phase[part][reading].get(phase, one.rms), one.uncertainty)

        parts = [name for name in budget.by_phase if name != "unexplained"]
        sizes = [[[size(p, r, n) for n in table["phase"]] for r in CLAMP_READINGS] for p in parts]
        return np.reshape(sizes, (len(parts), *shape)), "the budget's parts"
    source = found.reference if simulation == "reference" else found.candidate
    columns = [name for name in ("residual_boundary", "residual_moment") if name in source.table]
    if columns:
        worst = float(np.nanmax(source.table[columns].to_numpy(dtype=float), initial=0.0))
        return np.full((1, *shape), worst), "the closed form's residuals"
    return np.zeros((0, *shape)), "nothing: the simulation is taken for exact"


def _spread(
    stated: Uncertainties, first: Floats, second: Floats, numerics: Floats, level: Floats
) -> Spread:
    """All that makes the differences uncertain; the arrays have the shape (..., 3, stations)."""
    inputs, differences = len(first), int(np.prod(first.shape[1:]))
    modes = [first, numerics, second / np.sqrt(max(len(second), 1))]
    stacked = np.concatenate([part.reshape(len(part), differences) for part in modes])
    largest = max(float(np.abs(stacked).max(initial=0.0)), float(level.max()))
    if not largest < _LARGEST:
        what, remedy = f"{largest:.3g} of a reading's largest magnitude", "check the units"
        raise InputError("[uncertainty]", what, f"less than {_LARGEST:g}", remedy)
    correlation = np.eye(len(stacked))
    correlation[:inputs, :inputs] = stated.correlation
    names = (*stated.inputs, *[NUMERICS] * len(numerics), *[SECOND_ORDER] * len(second))
    noise = np.repeat(level, first.shape[-1])
    return Spread(names, stacked, correlation, noise, np.ones_like(noise))


def _alike(error: Floats, spread: Spread) -> Floats:
    """How much each reading's noise remembers, by what known errors leave of the difference."""
    if not spread.noise.all():
        return spread.alike
    over = spread.noise.reshape(error.shape)
    modes = spread.modes.reshape(-1, *error.shape) / over
    none = np.empty((*error.T.shape, 0))
    found = estimate((error / over).T, none, modes.transpose(2, 1, 0), np.ones(len(modes)))
    rho = np.minimum(found.noise.correlation, _MOST_ALIKE)
    return np.repeat((1 + rho**2) / (1 - rho**2), error.shape[1])


def _difference(error: Floats, spread: Spread) -> Difference:
    u_val, expand = spread.limits()
    shares = spread.shares()
    others = (shares.get(NUMERICS, 0.0), shares[NOISE])
    of_inputs = max(1 - sum(others), 0.0) if u_val > 0 else 0.0
    u_num, u_data, u_input = (u_val * math.sqrt(share) for share in (*others, of_inputs))
    return Difference(float(rms(error)), u_num, u_input, u_data, u_val, expand, shares)


def _ratio(second: Floats, first: Floats) -> float:
    """Root mean square of what is of second order, over that of first order."""
    linear = float(np.sum(first**2))
    return float(np.sqrt(np.sum(second**2) / max(len(second), 1) / linear)) if linear > 0 else 0.0


def _table(table: pd.DataFrame, error: Floats, spread: Spread) -> pd.DataFrame:
    numerics = np.array([name == NUMERICS for name in spread.names])
    by_numerics = np.sum(spread.modes[numerics] ** 2, axis=0)
    by_modes = spread.variance()
    rows = len(table)
    return pd.DataFrame(
        {
            "foot_x": np.tile(table["at"], len(CLAMP_READINGS)),
            "phase": np.tile(table["phase"], len(CLAMP_READINGS)),
            "reading": np.repeat(CLAMP_READINGS, rows),
            "error": error.ravel(),
            "u_num": np.sqrt(by_numerics),
            "u_input": np.sqrt(np.maximum(by_modes - by_numerics, 0.0)),
            "u_data": spread.noise,
            "u_val": np.sqrt(by_modes + spread.noise**2),
        }
    )
