"""What a disagreement in space looks like: mistakes that need no body to be recognised."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import permutations, product

import numpy as np

from analytic.from_clamp.noise import scatter
from analytic.numerics.arrays import Floats
from analytic.space import reconstruct_space, wrench_complaint
from analytic.space.problem.readings import FOOT, FORCE, MOMENT
from compare.align.frames import COMPONENTS, clamp_axes
from compare.explain.stations import agree_to, lone, without_contact
from compare.explain.wiring import scaled_alike
from compare.judge.allowance import SpatialAllowance
from compare.judge.tolerances import SpatialTolerances
from compare.measure.in_space import SpatialMeasurement

_NEARLY_ALL = 0.05  # of the disagreement's rms: what a mistake may leave of it, beside noise
_HIDES = 0.3  # of that rms; more noise hides which mistake it is
_SCATTER = 0.8  # of that rms: with less that jumps from station to station, more than noise is off
_DRAWN = 1.2  # times a noise that is stated: what some forty stations of it may show
_FIRST = 0.9  # times what one leaves: a later mistake that leaves as much is the same
_FEWEST = 5  # stations: fewer fit too much
_UNITS = {1e3: "1000", 1e-3: "1/1000"}
_SAME_UNIT = 0.02  # of such a factor; as far as a simulator's own error may move it


def likely_in_space(
    found: SpatialMeasurement, limits: SpatialTolerances, noise: SpatialAllowance
) -> str | None:
    """The mistake that explains nearly all of it, or what no vibrissa's clamp can read."""
    if not found.compared.any():
        return None
    both = found.error[:, found.compared]
    single = lone(found, both, found.travel[found.compared], limits, noise)
    if single or agree_to(both, limits, noise):
        return single or without_contact(found, limits, noise)
    true, seen = (
        np.stack([side.values(*names)[found.compared] for names in (FORCE, MOMENT)])
        for side in (found.reference, found.candidate)
    )
    scale = np.array([found.disagreement[names[0]].scale for names in (FORCE, MOMENT)])
    error = (seen - true) / scale[:, None, None]
    off = _rms(error)
    jumps = _DRAWN * _rms(np.array([*noise.level.values()]))
    best, least = None, np.hypot(_NEARLY_ALL * off, jumps) / _FIRST
    tried = true.shape[1] >= _FEWEST and jumps <= _HIDES * off
    for text, read in _mistakes(found, true, seen) if tried else ():
        if (left := _rms((seen - read) / scale[:, None, None])) < _FIRST * least:
            best, least = text, left
    seen_jumps = _rms(np.array([scatter(row) for one in error for row in one.T]))
    if best is None and seen_jumps > max(_SCATTER * off, jumps):
        return (
            f"noise: differences jump from station to station by {seen_jumps:.1e}; "
            "see `--noise auto`"
        )
    if best is not None or wrench_complaint(reconstruct_space(found.reference)) is not None:
        return best
    return wrench_complaint(reconstruct_space(found.candidate))


def _mistakes(
    found: SpatialMeasurement, true: Floats, seen: Floats
) -> Iterator[tuple[str, Floats]]:
    """What each makes of the true force and moment, shape (2, stations, 3)."""
    feet = found.reference.values(*FOOT)[found.compared]
    yield "signs: they are the vibrissa's action on the clamp, not the clamp's on it", -true
    for i, name in enumerate(("forces", "moments")):
        yield (
            f"opposite sign of the {name}",
            true * np.where(np.arange(2) == i, -1, 1)[:, None, None],
        )
    for i, name in enumerate(COMPONENTS):
        kind, axis = divmod(i, 3)
        for factor, text in ((-1.0, f"opposite sign of {name}"), (0.0, f"{name} stays at zero")):
            read = true.copy()
            read[kind, :, axis] *= factor
            yield text, read
    yield from _sizes(true, seen)
    leaning = true @ clamp_axes(found.reference.clamp_tangent).T
    yield (
        "components are in the clamp's frame, not the world's; of a file take `--frame clamp`",
        leaning,
    )
    about = true.copy()
    about[1] += np.cross(feet, true[0])
    yield "moments are about the world's origin, not the foot", about
    for axes, signs in product(permutations(range(3)), product((1, -1), repeat=3)):
        turned = np.eye(3)[[*axes]] * np.array(signs)[:, None]
        said = ", ".join(
            f"{'-' if sign < 0 else ''}{'xyz'[axis]}"
            for axis, sign in zip(axes, signs, strict=True)
        )
        read = true @ turned.T
        read[1] *= np.linalg.det(turned)
        yield f"axes: its x, y and z are {said} of the world's (y is up, right-handed)", read


def _sizes(true: Floats, seen: Floats) -> Iterator[tuple[str, Floats]]:
    """All components alike, or forces or moments in another unit."""
    sizes = (seen * true).sum(axis=(1, 2)) / (true * true).sum(axis=(1, 2))
    both = float(sizes.mean())
    if both:
        yield scaled_alike(both, "components"), both * true
    for factor, said in _UNITS.items():
        for i, name in enumerate(("forces", "moments")):
            if abs(sizes[i] / factor - 1) < _SAME_UNIT:
                gains = np.where(np.arange(2) == i, sizes[i], 1.0)[:, None, None]
                yield f"{name} in another unit: {said} times what is due", gains * true


def _rms(off: Floats) -> float:
    return float(np.sqrt(np.mean(off**2)))
