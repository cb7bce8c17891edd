"""An engine in a process of its own: whatever it does there, there is an outcome in time."""

import math
from dataclasses import dataclass
from multiprocessing import get_context

import numpy as np
from pebble import ProcessExpired, ProcessPool

from analytic.problem.case import Case
from analytic.problem.columns import CLAMP_READINGS, SENSED
from analytic.problem.errors import InputError
from analytic.problem.readings import Readings
from engines.found import find_engine
from mujoco_models.settings import Settings

TIMEOUT = 600.0
"""Seconds that a sweep may take unless something else is said: a slow engine needs one or two."""


@dataclass(frozen=True)
class Outcome:
    """What became of an engine's sweep.

    Attributes
    ----------
    engine : str
        Its name.
    readings : Readings or None
        None if there are none.
    trouble : str or None
        Why there are none, in a line.
    """

    engine: str
    readings: Readings | None = None
    trouble: str | None = None


def sweep_apart(name: str, case: Case, settings: Settings, timeout: float = TIMEOUT) -> Outcome:
    """Sweep a case with an engine in a process of its own.

    Parameters
    ----------
    name : str
        Of the engine.
    case : Case
        The problem.
    settings : Settings
        The numerics.
    timeout : float
        The longest that it may take [s].

    Returns
    -------
    Outcome
        Also if the engine is missing, refuses the case, raises, hangs, dies, or returns what are
        no readings of this case.
    """
    pool = ProcessPool(1, context=get_context("spawn"))
    try:
        return pool.schedule(_sweep, (name, case, settings), timeout=timeout).result()
    except TimeoutError:
        return Outcome(name, trouble=f"not finished after {timeout:g} s ([engine] timeout)")
    except ProcessExpired as error:
        return Outcome(name, trouble=f"its process ended without a word, code {error.exitcode}")
    except Exception as error:  # what it found cannot be sent
        return Outcome(name, trouble=_one_line(error))
    finally:
        pool.stop()  # type: ignore[no-untyped-call]
        pool.join()


def _sweep(name: str, case: Case, settings: Settings) -> Outcome:
    """In the other process."""
    try:
        case.require_sweep(f"the engine {name}")
        return Outcome(name, checked(find_engine(name).sweep(case, settings), case))
    except InputError as error:
        return Outcome(name, trouble=str(error))
    except BaseException as error:  # an engine may raise, or exit
        return Outcome(name, trouble=_one_line(error))


def _one_line(error: BaseException) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())[:400]


def checked(found: object, case: Case) -> Readings:
    """What an engine returned, if those are readings of the case."""
    if not isinstance(found, Readings):
        raise InputError("readings", f"a {type(found).__name__}", "Readings", "see Engine.sweep")
    foot_x = found.values("foot_x")
    if len(foot_x) != len(case.foot_x) or not np.allclose(
        foot_x, case.foot_x, rtol=0, atol=1e-12 * case.beam.length
    ):
        raise InputError(
            "stations",
            f"{len(foot_x)} from {foot_x[0]:g} to {foot_x[-1]:g}",
            f"the {len(case.foot_x)} of the case, from {case.foot_x[0]:g} to {case.foot_x[-1]:g}",
            "return a row a station, untrusted ones with another status",
        )
    if not math.isclose(found.beam.length, case.beam.length, rel_tol=1e-12):
        raise InputError(
            "length of the vibrissa", found.beam.length, f"{case.beam.length:g}", "return case.beam"
        )
    claimed = np.ones(len(foot_x), dtype=bool)
    if "status" in found.table:
        claimed = (found.table["status"] == "ok").to_numpy()
    lacking = claimed & ~np.isfinite(found.table[list(SENSED)].to_numpy(dtype=float)).all(axis=1)
    if lacking.any():
        first = foot_x[np.argmax(lacking)]
        raise InputError(
            f"stations without a number in {', '.join(CLAMP_READINGS)}, but with status ok",
            f"{int(lacking.sum())} of {len(foot_x)}, the first at foot_x = {first:g}",
            "none",
            "give them the status diverged or unsettled",
        )
    return found
