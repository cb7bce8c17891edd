"""Faults of the physics that leave a signature which no numerical part has."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from analytic import Case, Readings, Sweep, solve_sweep
from analytic.problem.arrays import Floats

_STEP = 1e-3  # relative change of each quantity, from which its signature is taken
_CONVINCING = 0.8  # share of the unexplained that a suspect must account for


@dataclass(frozen=True)
class Suspect:
    """A quantity of the physics that seems to differ between the two sweeps.

    `change` is by how much in the candidate, relative to its value (``foot_x``: to the length);
    `share` is how much of the unexplained disagreement's square it accounts for.
    """

    name: str
    change: float
    share: float


def variations(case: Case) -> dict[str, Readings]:
    """The exact sweep over the case's stations with one quantity larger by a thousandth each."""
    beam, length = case.beam, case.beam.length
    start, stop = (float(x) for x in case.foot_x[[0, -1]])
    shift = _STEP * length
    cases = {
        "flexural_rigidity": replace(
            case, beam=replace(beam, flexural_rigidity=beam.flexural_rigidity * (1 + _STEP))
        ),
        "length": replace(case, beam=replace(beam, length=length * (1 + _STEP))),
        "radius": replace(case, beam=replace(beam, radius=beam.radius * (1 + _STEP))),
        "foot_x": replace(case, sweep=Sweep(case.sweep.stations, start + shift, stop + shift)),
    }
    # Nearby cases start a little elsewhere by default; all are swept over the same stations.
    found = {}
    for name, varied in cases.items():
        grid = varied.sweep if name == "foot_x" else Sweep(case.sweep.stations, start, stop)
        found[name] = solve_sweep(replace(varied, sweep=grid))
    return found


def suspects(
    unexplained: Floats, signatures: Mapping[str, Floats], unresolved: float
) -> tuple[Suspect, ...]:
    """Which signatures account for the unexplained disagreement, the best first.

    Parameters
    ----------
    unexplained : array, shape (3, stations)
        Relative to each reading's largest magnitude.
    signatures : mapping
        What each quantity does to the readings, of the same shape, for a change of `_STEP`.
    unresolved : float
        Norm of what may stay unexplained; below, nobody is suspected.
    """
    if np.linalg.norm(np.sqrt(np.mean(unexplained**2, axis=-1))) <= unresolved:
        return ()
    found = []
    for name, signature in signatures.items():
        known = np.isfinite(signature).all(axis=0)
        s, u = signature[:, known].ravel(), unexplained[:, known].ravel()
        size = float(s @ u / (s @ s))
        share = float(1 - np.sum((u - size * s) ** 2) / np.sum(u**2))
        if share >= _CONVINCING:
            found.append(Suspect(name, size * _STEP, share))
    return tuple(sorted(found, key=lambda suspect: -suspect.share))
