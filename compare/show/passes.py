"""The passes of a rig: what was kept, what was dropped, how far they repeat, and lag."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, replace
from typing import Any

import numpy as np

from analytic import CLAMP_READINGS, Beam, Readings
from analytic.from_clamp.object.lag import Lag
from analytic.from_clamp.passes import Consistency
from compare.measure.repeats import Repeats
from compare.read.passes import Pass
from compare.show.document import Block, Table, Text
from compare.show.numbers import picked, quantity

_DRIFTS = 0.01  # of the largest reading: more than the noise of most sensors
_UNLIKE = 0.05  # of the contact; where the vibrissa lets go passes are unlike, too
_LAG = "lag"  # in the provenance of a pass
_OFF = 0.02  # of the rigidity; less is within what most vibrissae are known to


def passes_summary(passes: Sequence[Pass], found: Sequence[Repeats]) -> Iterator[Block]:
    rows, drifts = [], []
    for one in passes:
        lost = (f"{n} {name.replace('_', ' ')}" for name, n in one.dropped.items() if n)
        counts = (one.rows, one.kept, one.sorted, one.record.gaps)
        rows.append((one.name, one.direction, *(str(n) for n in counts), ", ".join(lost)))
        largest = {n: np.nanmax(np.abs(one.readings.values(n)), initial=0.0) for n in one.drift}
        drift = [one.drift[n] / largest[n] if largest[n] > 0 else np.nan for n in one.drift]
        drifts.append((one.name, *("not known" if np.isnan(x) else f"{x:+.1e}" for x in drift)))
    counted = ("pass", "to the", "rows", "kept", "sorted", "gaps", "not kept")
    yield Table("Passes: rows, and why some are not used", counted, rows, words=(0, 1, 6))
    head = ("pass", *CLAMP_READINGS)
    yield Table("Drift of the zero, over the largest reading", head, drifts)
    if np.isnan([*passes[0].zero.values()]).all():
        yield Text("no zero is taken off: state free_before and free_after, where nothing touches")
    yield from _not_taken_off(passes)
    if any(one.bends for one in passes):
        yield Text("the zeros drift along a curve, which is taken off; the intervals know how well")
    for one_way in found:
        yield from repeats_summary(one_way)


def _not_taken_off(passes: Sequence[Pass]) -> Iterator[Text]:
    """The largest drift that a single free stretch shows, of which nothing is taken off."""
    shares = []
    for one in passes:
        sizes = [np.nanmax(np.abs(one.readings.values(n)), initial=0.0) for n in CLAMP_READINGS]
        pairs = zip(CLAMP_READINGS, one.drawn.ahead, sizes, strict=True)
        shares += [(abs(x / size), n, one.name) for n, x, size in pairs if size > 0]
    share, name, of = max(shares, default=(0.0, "", ""))
    if share > _DRIFTS:
        yield Text(
            f"{name} of {of} drifts where it is free, by {share:.0%} of its largest value over the "
            "pass if it goes on so, and nothing of that is taken off: state both free_before and "
            "free_after"
        )


def repeats_summary(found: Repeats) -> Iterator[Block]:
    """How far passes are from their mean, and whether they say the same."""
    length, foot_x = found.mean.beam.length, found.mean.values("foot_x")
    shifts = found.shifts.numbers[:, 0] / length
    halves = 1.96 * found.uncertainty / length
    worst = (rms.max(axis=1) for rms in (found.rms, found.rms_without_shift))
    each = zip(found.names, shifts, halves, *worst, strict=True)
    yield Table(
        f"Passes to the {'right' if foot_x[-1] > foot_x[0] else 'left'} against their mean: by how "
        "much foot_x reads more for equal readings, and root mean squares over the largest reading",
        ("pass", "foot_x [L]", "+- 95 %", "apart", "without that"),
        [
            (name, f"{shift:+.1e}", f"{half:.0e}", f"{apart:.1e}", f"{left:.1e}")
            for name, shift, half, apart, left in each
        ],
    )
    yield Text(f"foot_x: {consistency_line(found.shifts, found.names)}")
    if not found.by_noise:
        name = CLAMP_READINGS[int(np.argmax(found.rms_without_shift.max(axis=0)))]
        yield Text(
            f"but {name} differs by {found.rms_without_shift.max():.0%} of its largest value, which"
            " no noise does: a sign, a unit, a gain, another object or vibrissa"
        )
    if found.others:
        yield Text(
            f"not in their mean: {', '.join(found.others)}, as of another object or vibrissa"
        )
    if found.left_out > _UNLIKE:
        yield Text(
            f"in {found.left_out:.0%} of the contact passes differ by far more than that, most of "
            f"all {found.names[found.farthest]}: left out of their mean; a clock that jumps, a "
            "sensor that saturates and another object or vibrissa do so"
        )


def consistency_line(found: Consistency, names: Sequence[str] | None = None) -> str:
    count = len(found.numbers)
    of = f"chi square {found.chi_square:.3g} of {found.degrees} degrees of freedom"
    said = f"{of}, p = {found.probability:.2g}"
    if found.consistent:
        return f"{count} passes say the same ({said})"
    farthest = f"pass {found.farthest + 1}" if names is None else names[found.farthest]
    return (
        f"{count} passes do not say the same ({said}): something changes between them, most of "
        f"all in {farthest}"
    )


def passes_document(
    passes: Sequence[Pass], found: Sequence[Repeats], lag: Lag | None
) -> dict[str, Any]:
    said = ("name", "direction", "rows", "kept", "dropped", "sorted", "zero", "drift", "bends")
    return {
        "passes": [
            picked(one, *said) | {"gaps": one.record.gaps, "widest_step": one.record.widest}
            for one in passes
        ],
        "lag": lag and asdict(lag),
        "repeats": [
            {
                "passes": list(repeated.names),
                "shift": repeated.shifts.numbers[:, 0].tolist(),
                "shift_uncertainty": (1.96 * repeated.uncertainty).tolist(),
                "rms": repeated.rms.tolist(),
                "rms_without_shift": repeated.rms_without_shift.tolist(),
                **picked(repeated.shifts, "chi_square", "probability"),
            }
            for repeated in found
        ],
    }


def lag_summary(passes: Sequence[Pass], found: Lag | None, taken: float) -> Iterator[Text]:
    """What passes in both directions say, and what to do about it; nothing of one direction.

    A lag that the rig's description states was taken off already.
    """
    if len({one.direction for one in passes}) < 2:
        return
    if found is None:
        yield Text(
            "whether readings lag behind the foot is not known: no convex contour explains the "
            "passes in both directions (several objects, friction, a gain, sign or zero that is "
            "off, a vibrissa or clamp that is not as stated?)"
        )
        return
    beam = passes[0].readings.beam
    if found.way is None:
        yield Text(
            f"no lag, but {_otherwise(asdict(found)['otherwise'])}: that explains the passes"
        )
    elif not found.shows:
        said = _lag_of(asdict(found)["way"], beam)
        yield Text(f"no lag of the readings shows: {said}, by passes in both directions")
    else:
        yield from _shown(passes, found, taken)
    if abs(found.rigidity.value - 1) > _OFF:
        yield Text(f"  the passes fit a vibrissa of {found.rigidity.value:.3g} times [beam]'s EI")


def _shown(passes: Sequence[Pass], found: Lag, taken: float) -> Iterator[Text]:
    """A lag, in time if that is known, and what else it may be."""
    assert found.way is not None
    beam, ways = passes[0].readings.beam, (found.way.value, found.way.lowest, found.way.highest)
    said = _lag_of(asdict(found)["way"], beam)
    speeds = [x for one in passes if (x := one.readings.provenance.get("speed"))]
    if speeds:
        speed = float(np.median(speeds))
        late, least, most = (1e3 * way / speed for way in ways)
        in_time = f"{late:.3g} ms (95 %: {least:.3g} to {most:.3g} ms)"
        said = f"{in_time} at {quantity(speed, 'length', beam)}/s" if beam.si else said
    which = "after" if ways[0] > 0 else "before"
    in_all = ways[0] + taken
    stated = f'"{1e3 * in_all:.4g} mm"' if beam.si else f"{in_all:.4g}"
    either = f"; or {_otherwise(asdict(found)['otherwise'])}" if found.otherwise else ""
    yield Text(f"{'either ' * bool(either)}the readings come {which} the positions: {said}{either}")
    yield Text(
        "  a stage's play or friction looks alike, an offset does not; passes at another speed "
        f"show which it is. To take it off, write under [passes]: lag = {stated}"
    )


def _otherwise(causes: Mapping[str, Mapping[str, float]]) -> str:
    """Mistakes that look like a lag."""
    said = {
        "length": "a vibrissa of {:.4g} times [beam]'s length (95 %: {:.4g} to {:.4g})",
        "lever": "moment_z about a point {:+.2g} L along the vibrissa off the clamp (95 %: {:+.2g} "
        "to {:+.2g} L)",
    }
    each = (
        (name, [x[end] for end in ("value", "lowest", "highest")]) for name, x in causes.items()
    )
    return "; or ".join(said[name].format(*numbers) for name, numbers in each)


def with_lag(readings: Readings, found: Lag) -> Readings:
    return replace(readings, provenance={**readings.provenance, _LAG: asdict(found)})


def lag_remembered(passes: Sequence[Readings]) -> str | None:
    """What to say of the lag that a rig's passes have, if they are in both directions."""
    known = [x for one in passes if (x := one.provenance.get(_LAG))]
    if not known or len({one.runs_right for one in passes}) < 2:
        return None
    way, causes = known[0]["way"], []
    if way is not None and way["lowest"] <= 0 <= way["highest"]:
        return None
    if way is not None:
        which = "after" if way["value"] > 0 else "before"
        causes = [f"the readings come {which} the positions: {_lag_of(way, passes[0].beam)}"]
    if known[0]["otherwise"]:
        causes.append(_otherwise(known[0]["otherwise"]))
    return f"as `rig` said, {'; or '.join(causes)}"


def _lag_of(way: dict[str, float], beam: Beam) -> str:
    lowest, highest = (quantity(way[end], "length", beam) for end in ("lowest", "highest"))
    return f"{quantity(way['value'], 'length', beam)} (95 %: {lowest} to {highest})"
