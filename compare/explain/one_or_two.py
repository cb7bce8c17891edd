"""The one mistake or fault that fits a disagreement clearly best, or the two that do together."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from analytic import CLAMP_READINGS, Readings
from analytic.numerics.arrays import Floats, Words
from compare.explain.causes import Cause, physical_faults, sensor_faults
from compare.explain.fit import Explanation, fitted
from compare.explain.wiring import Misreading, about_the_origin, misread
from compare.measure.measurement import Measurement

CONVINCING = 0.9
"""Fraction of the disagreement, its scatter apart, that one cause must explain."""
_DISTINCT = 2.0  # the next cause must leave so many times the square that the best one leaves
_REST = 0.1  # fraction of the disagreement, rms, that a named cause may leave without saying so
_LITTLE = 0.02  # the same, that is not looked into for a second cause
_ALIKE = 0.3  # fraction that a signature must explain for the fault to be solved at its size
_SECANTS, _SETTLED = 5, 1e-3  # sweeps at most for that, and the last change of its size
_BETTER = 6.0  # the same as _DISTINCT, for three constants to be preferred to one cause
_TWO_BETTER = 10.0  # and for two causes
_SHORTLIST = 4  # pairs that are solved at their sizes
_GROSS = 0.1  # of the largest magnitude in either sweep, rms: no cause leaves so much
_UNSURE = 1.3  # times the scatter's square, to be on the safe side of its estimate
_FEWEST = 10  # stations


@dataclass(frozen=True)
class Weigh:
    """How well a disagreement is explained, by sums of squares."""

    all: float
    noise: float  # what jumps in it
    most: float = np.inf  # that a cause may leave, jumps and all

    def beyond(self, one: Explanation) -> float:
        """What it leaves, its scatter apart."""
        return max(one.left - _UNSURE * self.noise, 0.0)

    def rest(self, one: Explanation) -> float:
        """Fraction of the disagreement that it leaves, rms."""
        return float(np.sqrt(self.beyond(one) / self.all))

    def convinces(self, one: Explanation) -> bool:
        enough = self.all - one.left >= CONVINCING * (self.all - self.noise)
        return enough and one.left <= self.most

    def alike(self, best: Explanation, other: Explanation) -> bool:
        """Whether another one leaves hardly more than the best."""
        return other.left - _UNSURE * self.noise <= _DISTINCT * self.beyond(best)


def one_or_two(
    found: Measurement,
    table: pd.DataFrame,
    true: Floats,
    seen: Floats,
    scale: Floats,
    jumps: Floats,
) -> str | None:
    """What fits clearly best, over the stations where all faults are known.

    Readings have shape (3, stations) and are over their largest magnitudes, `scale`.
    """
    physical = list(physical_faults(found, table, true, scale))
    known = np.asarray(np.isfinite([fault.signature for fault in physical]).all(axis=(0, 1)))
    if known.sum() < _FEWEST:
        return None
    true, seen = true[:, known], seen[:, known]
    foot_x = table["at"].to_numpy()[known]
    physical = [fault.over(known) for fault in physical]
    faults = [*sensor_faults(true), *physical]
    wirings = list(misread(true, seen, scale, found.reference.beam.length))
    if found.reference.running == "foot_x":
        wirings.append(about_the_origin(true, foot_x, scale))
    weigh = Weigh(
        float(np.sum((seen - true) ** 2)),
        float(np.sum(jumps**2) * known.sum()),
        float(np.sum((_GROSS * np.maximum(np.abs(seen).max(axis=1), 1.0)) ** 2) * known.sum()),
    )
    tried = _alone(faults, wirings, true, seen, weigh)
    shapes = _shapes(true, found.reference, physical)
    tried += _in_one_phase(table["phase"].to_numpy()[known], shapes, seen - true, weigh)
    best, rival = best_alone(tried, weigh)
    if best is None or weigh.rest(best) > _LITTLE:
        pairs = list(_both(faults, tried[: len(faults)], seen - true, foot_x))
        wired = list(_wired(wirings, physical, true, seen))
        two = _clearly(pairs + wired, weigh)
        less = 1.0 if best and best.sizes > 1 else _TWO_BETTER
        if two and (best is None or weigh.beyond(two) * less < weigh.beyond(best)):
            return two.text
        least = min(map(weigh.beyond, pairs))
        if best and weigh.rest(best) > _REST and least * _TWO_BETTER < weigh.beyond(best):
            return None  # two do far better, and which two is not clear
    if best is None:
        return None
    rest = weigh.rest(best)
    if found.offset.uncertainty > 0:
        # What is off may have moved the fitted offset: it counts beside any other cause.
        error, offset = seen - true, len(faults) - len(physical) + 1
        pairs_left = _left_by_two(faults, error)
        left = np.minimum(pairs_left[offset], pairs_left[:, offset])
        others = (x for x, own in zip(left, tried, strict=False) if own is not best)
        if rest > _REST or any(weigh.alike(best, Explanation("", x, 2)) for x in others):
            return None
    if rival is not None:
        return f"either {best.text}; or {rival.text}" if rest <= _REST else None
    if rest <= _REST:
        return best.text
    solved = any(fault.needs_contour for fault in physical)
    return f"{best.text}; {rest:.0%} of the disagreement is left" if solved else None


def _alone(
    faults: list[Cause], wirings: list[Misreading], true: Floats, seen: Floats, weigh: Weigh
) -> list[Explanation]:
    """Every fault, then everything else that may be wrong alone."""
    error = seen - true
    left = [float(np.sum((seen - one.of(true)) ** 2)) for one in wirings]
    others = [Explanation(x.text, of, x.sizes) for x, of in zip(wirings, left, strict=True)]
    others += _of_all(error)
    fits = [_linear(fault, error) for fault in faults]
    best, _ = best_alone([*fits, *others], weigh)
    unclear = best is None or weigh.rest(best) > _REST
    solved = [
        _exact(fault, fit, error) if unclear or weigh.convinces(fit) else fit
        for fault, fit in zip(faults, fits, strict=True)
    ]
    return [*solved, *others]


def best_alone(
    tried: list[Explanation], weigh: Weigh
) -> tuple[Explanation | None, Explanation | None]:
    """The best one and its rival; None if it does not convince, or has more than one rival.

    One of several sizes has to leave less by far than those of one, and then is compared with its
    like alone.
    """
    tried = sorted(tried, key=lambda one: one.left)
    best, *others = (one for one in tried if one.sizes <= 1)
    for one in tried:
        if one.sizes > 1 and weigh.beyond(one) * _BETTER < weigh.beyond(best):
            best, others = one, [best]
    rivals = [one for one in others if weigh.alike(best, one)]
    if not weigh.convinces(best) or len(rivals) > 1:
        return None, None
    return best, rivals[0] if rivals else None


def _of_all(error: Floats) -> Iterator[Explanation]:
    """A load or a drift that is another one in each reading."""
    stations = error.shape[1]
    for shape, text in (
        (np.ones(stations), "constant load at all stations ({}): gravity or zero of the sensor, "
         "not taken off"),
        (np.linspace(0, 1, stations), "drift of all readings over the sweep ({})"),
    ):  # fmt: skip
        sizes = error @ shape / (shape @ shape)
        named = ", ".join(f"{n} {x:+.1e}" for n, x in zip(CLAMP_READINGS, sizes, strict=True))
        left = float(np.sum((error - sizes[:, None] * shape) ** 2))
        yield Explanation(text.format(f"{named} of their largest magnitudes"), left, len(sizes))


def _shapes(true: Floats, reference: Readings, physical: list[Cause]) -> dict[str, Floats]:
    """What a model may do wrong at one kind of contact, by its text."""
    shapes = {"all readings {:+.2%} off": true}
    for offset in physical[1:2]:
        said = f"{reference.running} {{:+.2e}} {reference.running_unit[1]} off"
        shapes[said] = offset.signature
    for only, name in zip(np.eye(3)[:, :, None], CLAMP_READINGS, strict=True):
        shapes[f"{name} {{:+.2%}} off"] = only * true
        shapes[f"{name} off by {{:+.2e}} of its largest magnitude"] = only + 0 * true
    return shapes


def _in_one_phase(
    phase: Words, shapes: Mapping[str, Floats], error: Floats, weigh: Weigh
) -> Iterator[Explanation]:
    """What is wrong in one phase alone, as no vibrissa, stage or sensor is."""
    tried, moved = [], []
    for one, place in {"tip": "at", "tangent": "short of"}.items():
        here = phase == one
        if here.all() or not here.any():
            continue
        text = f"{{}}, in phase {one} alone: see what the model does in contact {place} the tip"
        left = float(np.sum(error[:, ~here] ** 2))
        for said, shape in shapes.items():
            fit = fitted(error[:, here], shape[:, here])
            tried.append(Explanation(text.format(said.format(fit.size)), left + fit.left, 2))
        mean = error[:, here].mean(axis=1, keepdims=True)
        sizes = ", ".join(f"{n} {x:+.1e}" for n, x in zip(CLAMP_READINGS, mean[:, 0], strict=True))
        said = text.format(f"readings shifted ({sizes} of their largest magnitudes)")
        moved.append(Explanation(said, left + float(np.sum((error[:, here] - mean) ** 2)), 3))
    if not tried:
        return
    best, *others = sorted(tried, key=lambda each: each.left)
    further = min(moved, key=lambda each: each.left)
    if weigh.beyond(further) * _BETTER < weigh.beyond(best):
        yield further
    elif not any(weigh.alike(best, each) for each in others):
        yield best


def _linear(fault: Cause, error: Floats) -> Explanation:
    """A fault by its signature, at a size that it can have."""
    size = float(np.clip(fitted(error, fault.signature).size, fault.lowest, fault.highest))
    left = float(np.sum((error - size * fault.signature) ** 2))
    return Explanation(fault.text(size), left, size=size)


def _exact(fault: Cause, best: Explanation, error: Floats) -> Explanation:
    """A fault solved at its size, which secants find, if that explains more than its signature."""
    size, _, fraction = fitted(error, fault.signature)
    if fault.change is None or fraction < _ALIKE:
        return best
    last, before = 0.0, np.zeros_like(error)
    for _ in range(_SECANTS):
        size = float(np.clip(size, fault.lowest, fault.highest))
        added = fault.added(size) if size != last else None
        if added is None:
            break
        left = float(np.sum((error - added) ** 2))
        if left < best.left:
            best = Explanation(fault.text(size), left, size=size)
        step = fitted(error - added, (added - before) / (size - last)).size
        last, before = size, added
        size += step
        if abs(step) < _SETTLED * abs(size):
            break
    return best


def _both(
    faults: list[Cause], alone: list[Explanation], error: Floats, foot_x: Floats
) -> Iterator[Explanation]:
    """Two faults that leave least, by their signatures or beside the best one at its size."""
    first = min(range(len(faults)), key=lambda i: alone[i].left)
    size = alone[first].size
    solved = faults[first].added(size) if size else None
    beside = list(faults)
    if solved is not None:
        beside[first] = replace(faults[first], signature=solved / size)
    left = _left_by_two(beside, error)
    best, with_first = np.argsort(left, axis=None), np.argsort(left[first] + left[:, first])
    tried = {tuple(sorted((first, int(i)))) for i in with_first[:_SHORTLIST] if i != first}
    tried |= {divmod(int(at), len(faults)) for at in best[:_SHORTLIST]}
    for i, j in tried:
        yield _together(beside[i], beside[j], error, foot_x)
    # All others, which are not solved at their sizes, do no better than the best of them.
    rest = [at for at in best[: 2 * _SHORTLIST + 1] if divmod(int(at), len(faults)) not in tried]
    yield Explanation("", float(left.flat[rest[0]]), 2)


def _wired(
    wirings: list[Misreading], physical: list[Cause], true: Floats, seen: Floats
) -> Iterator[Explanation]:
    """A mistake of the wiring and any fault beside it."""
    tried = []
    for one in wirings:
        truth = one.of(true)
        here = [*sensor_faults(truth), *(fault.through(one.mixes) for fault in physical)]
        fits = [_linear(fault, seen - truth) for fault in here]
        best, fault = min(zip(fits, here, strict=True), key=lambda each: each[0].left)
        yield from (Explanation("", fit.left, 2) for fit in fits if fit is not best)
        tried.append((best, fault, one.text, seen - truth))
    for place, (best, fault, text, error) in enumerate(sorted(tried, key=lambda x: x[0].left)):
        exact = _exact(fault, best, error) if place < 2 * _SHORTLIST else best
        yield Explanation(_said(text, exact.text), exact.left, 2)


def _clearly(tried: list[Explanation], weigh: Weigh) -> Explanation | None:
    """The two at once that leave least, if that is little and no others leave hardly more."""
    best, *others = sorted(tried, key=lambda each: each.left)
    little = weigh.rest(best) <= _REST and best.left <= weigh.most
    clear = little and not any(weigh.alike(best, one) for one in others)
    return best if best.text and clear else None


def _left_by_two(faults: list[Cause], error: Floats) -> Floats:
    """What every two signatures leave, shape (faults, faults); infinite if alike."""
    signatures = np.stack([fault.signature.ravel() for fault in faults])
    lowest, highest = (np.array([getattr(f, n) for f in faults]) for n in ("lowest", "highest"))
    gram, due = signatures @ signatures.T, signatures @ error.ravel()
    i, j = np.triu_indices(len(faults), 1)
    inner = gram[i, i] * gram[j, j] - gram[i, j] ** 2
    with np.errstate(divide="ignore", invalid="ignore"):
        first = (gram[j, j] * due[i] - gram[i, j] * due[j]) / inner
        second = (gram[i, i] * due[j] - gram[i, j] * due[i]) / inner
    apart = inner > _SETTLED * gram[i, i] * gram[j, j]
    left = np.full(gram.shape, np.inf)
    for one, size, other in ((i, first, j), (j, second, i)):
        # What would go too far goes as far as it can, and the other makes the best of that.
        size = np.clip(size, lowest[one], highest[one])
        beside = (due[other] - gram[i, j] * size) / gram[other, other]
        beside = np.clip(beside, lowest[other], highest[other])
        explained = size * (2 * due[one] - size * gram[one, one]) + beside * (
            2 * due[other] - beside * gram[other, other] - 2 * size * gram[i, j]
        )
        both = apart & (size != 0) & (beside != 0)
        left[i, j] = np.where(
            both, np.minimum(left[i, j], np.sum(error**2) - explained), left[i, j]
        )
    return left


def _together(one: Cause, other: Cause, error: Floats, foot_x: Floats) -> Explanation:
    """Two faults solved at their sizes; one may act on what the other adds."""
    columns, best = [one.signature, other.signature], Explanation("", np.inf, 2)
    for _ in range(_SECANTS):
        stacked = np.stack([column.ravel() for column in columns], axis=1)
        sizes = np.linalg.lstsq(stacked, error.ravel(), rcond=None)[0]
        sizes = np.clip(sizes, [one.lowest, other.lowest], [one.highest, other.highest])
        first, second = (f.added(float(x)) for f, x in zip((one, other), sizes, strict=True))
        if first is None or second is None or not sizes.all():
            break
        if one.acts is not None:
            first = first + one.acts(float(sizes[0]), second, foot_x) - second
        elif other.acts is not None:
            second = second + other.acts(float(sizes[1]), first, foot_x) - first
        left = float(np.sum((error - first - second) ** 2))
        if left < best.left:
            texts = [fault.text(float(x)) for fault, x in zip((one, other), sizes, strict=True)]
            best = Explanation(_said(*texts), left, 2)
        columns = [first / sizes[0], second / sizes[1]]
    return best


def _said(one: str, other: str) -> str:
    return f"two things at once: {one}; and {other}"
