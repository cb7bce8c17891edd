"""The passes of a rig: what was kept, what was dropped, how far they repeat."""

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from analytic import CLAMP_READINGS
from analytic.from_clamp.object.lag import Lag
from analytic.from_clamp.passes import Consistency
from compare.measure.repeats import Repeats
from compare.read.passes import Pass
from compare.show.document import Block, Table, Text

_DRIFTS = 0.01  # of the largest reading: more than the noise of most sensors


def passes_summary(passes: Sequence[Pass], found: Sequence[Repeats]) -> Iterator[Block]:
    """What a terminal shows: what was not used and why, drift, and how far passes repeat."""
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
    """What ``passes.json`` holds."""
    said = ("name", "direction", "rows", "kept", "dropped", "sorted", "zero", "drift", "bends")
    return {
        "passes": [
            {
                **{name: getattr(one, name) for name in said},
                "gaps": one.record.gaps,
                "widest_step": one.record.widest,
            }
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
                "chi_square": repeated.shifts.chi_square,
                "probability": repeated.shifts.probability,
            }
            for repeated in found
        ],
    }
