"""What was fitted to clamp readings, a vibrissa or an object, for people and as JSON."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from analytic import CLAMP_READINGS, Beam, Calibration, FittedObject
from analytic.from_clamp.calibration.best import below_the_noise
from analytic.from_clamp.calibration.calibrate import Estimate
from analytic.from_clamp.calibration.unknowns import LAG, OF_THE_FOOT
from analytic.from_clamp.passes import Consistency
from analytic.problem.quantities import QUANTITIES
from analytic.space import ConvexBand, FittedBody
from analytic.space.from_clamp.hull import volume
from analytic.space.from_clamp.reconstruct import COMPONENTS
from compare.show.document import Block, Table, Text
from compare.show.numbers import picked, quantity
from compare.show.passes import consistency_line

_PLAIN = ("exponent", "log", "axis", "friction")  # numbers without a unit
_NOT_JUDGED = (
    "noise that remembers leaves that, and so does what is not as stated: too few rows without "
    "contact show how large the noise is; record more of them, or state it"
)
_CONSISTENCY = ("chi_square", "degrees", "probability", "alike")  # of passes


def calibration_summary(calibration: Calibration) -> Iterator[Block]:
    passes, si = calibration.passes, calibration.case.beam.si
    if calibration.misfit_shows and not calibration.judged:
        misfit = f"The fit leaves {calibration.misfit:.2g} times what jumps from row to row"
        yield Text(f"{misfit}: {_NOT_JUDGED}")
    elif calibration.misfit_shows:
        yield Text(
            f"The fit leaves {calibration.misfit:.2g} times the noise: something else is not as "
            "the case says (a sign, a unit, the object's place), and what follows is not to be "
            "trusted. `vibrissa compare` looks for the cause."
        )
    rows = []
    for name, found in calibration.found.items():
        unit = QUANTITIES["foot_x" if name in OF_THE_FOOT else name].dimension if si else ""
        row = [*_interval(name, found), unit]
        if passes is not None:  # of a lag a pass alone says nothing
            scatter = calibration.scatter
            row.append(_number(scatter[name]) if name in scatter else "")
        rows.append(row)
    head, of = ["found", "value", "95 % from", "to", ""], ""
    if passes is not None:
        head, of = [*head, "passes scatter by"], f" of {len(passes.numbers)} passes"
    yield Table(f"From {calibration.stations} stations{of}", head, rows, words=(0, 4))
    if passes is not None:
        yield from _of_passes(calibration, passes)
        if not passes.consistent:
            yield Text(
                "what the passes scatter by says more than the intervals, which are of noise"
            )
    names = [*calibration.found]
    pairs = [(i, j) for j in range(len(names)) for i in range(j)]
    if pairs:
        i, j = max(pairs, key=lambda pair: abs(calibration.correlation[pair]))
        alike = calibration.correlation[i, j]
        yield Text(f"trading off most: {names[i]} and {names[j]}, correlation {alike:+.2f}")
    if calibration.undistinguished is not None:
        yield from map(Text, calibration.undistinguished.said())
    yield from _left(calibration)
    if not calibration.explains and calibration.both_ways and LAG not in calibration.found:
        yield Text("passes both ways show whether readings lag behind the foot: fit lag too")
    if calibration.jitter:
        unit = " m" if si else ""
        yield Text(f"the foot jitters by {calibration.jitter:.2g}{unit}; the intervals know it")


def object_summary(found: FittedObject | FittedBody, si: bool) -> Iterator[Block]:
    unit = "m" if si else ""
    rows = [
        (*_interval(name, one), "" if name.startswith(_PLAIN) else unit)
        for name, one in found.found.items()
    ]
    head = ("found", "value", "95 % from", "to", "")
    caption = f"{found.family.capitalize()}, from {found.stations} stations"
    yield Table(caption, head, rows, words=(0, 4))
    if isinstance(found, FittedObject):
        widest = quantity(float(found.band["half_width"].max()), "length", found.case.beam)
        yield Text(
            f"where it was touched, the contour is known to {widest} or better (95 %), if it is of "
            "this family"
        )
    if len(found.rivals) > 1:
        least = min(bic for bic, _ in found.rivals.values())
        no = "no" if found.judged else "not known"
        yield Table(
            "Schwarz's criterion, over the least: the likeliest family has 0",
            ("family", "more by", "explains the readings"),
            [
                (name, f"{bic - least:.1f}", "yes" if explains else no)
                for name, (bic, explains) in found.rivals.items()
            ],
            words=(0, 2),
        )
    if found.others:
        yield Text(
            f"it may as well be {' or '.join(found.others)}: the readings do not rule that out"
        )
    if isinstance(found, FittedObject) and found.passes is not None:
        yield from _of_passes(found, found.passes)
    yield from _left(found)
    if not found.explains and not found.judged:
        yield Text(_NOT_JUDGED)
    elif not found.explains:
        yield Text(
            f"noise alone does not explain what is left: it is no {found.family}, or something "
            "else is not as stated; the intervals hold for noise, not for that"
        )


def band_summary(found: ConvexBand, beam: Beam) -> Iterator[Block]:
    inner, outer, cube = volume(found.inner), volume(found.outer), beam.length**3
    yield Text(
        f"{found.stations} contacts hold a convex body of {inner / cube:.3g} L^3 or more, and of "
        f"{outer / cube:.3g} L^3 or less in the box around them"
    )
    line = f"over {found.seen:.0%} of the inner body contacts end the outer one"
    if found.seen:
        median = quantity(float(np.nanmedian(found.gaps)), "length", beam)
        line += (
            f": {median} above it in the median, {quantity(found.widest, 'length', beam)} at most"
        )
    yield Text(line)
    if not found.explains:
        yield Text(
            "no convex body has all these contacts and normals, within noise: there are several, "
            "it is dented, or friction, the vibrissa or the frame are not as stated"
        )


def calibration_document(calibration: Calibration) -> dict[str, Any]:
    passes, correlation = calibration.passes, calibration.noise.correlation.tolist()
    return {
        "case": calibration.case.name,
        "found": calibration.found,
        "correlation": calibration.correlation.tolist(),
        **picked(calibration, "stations", "misfit"),
        "noise_correlation": dict(zip(CLAMP_READINGS, correlation, strict=True)),
        "hum_stations": calibration.noise.hum or None,
        **picked(calibration, "jitter", "undistinguished"),
        "passes": passes and {"scatter": calibration.scatter, **picked(passes, *_CONSISTENCY)},
    }


def object_document(found: FittedObject | FittedBody) -> dict[str, Any]:
    document = picked(found, "family", "found", "explains", "misfit", "stations")
    rivals = {name: {"bic": bic, "explains": x} for name, (bic, x) in found.rivals.items()}
    document["rivals"] = rivals
    if isinstance(found, FittedBody):
        return document
    return document | {
        "chi_square": found.passes and found.passes.chi_square,
        "probability": found.passes and found.passes.probability,
        "band": {name: values.tolist() for name, values in found.band.items()},
    }


def band_document(found: ConvexBand) -> dict[str, Any]:
    """What ``object.json`` holds of the two bodies, which are in files of their own."""
    return {
        "family": "convex",
        **picked(found, "explains", "stations", "half_width"),
        "box": found.box.tolist(),
        "inner_volume": volume(found.inner),
        "outer_volume": volume(found.outer),
        "seen": found.seen,
        "widest": found.widest if found.seen else None,
    }


def _of_passes(found: Calibration | FittedObject, passes: Consistency) -> Iterator[Text]:
    yield Text(consistency_line(passes))
    # What is left and no noise makes the intervals wider than passes scatter, too.
    if passes.too_alike and found.explains and not found.noise.remembers.any():
        yield Text("  they differ by less: noise, or zeros, are taken for larger than they are")
    if passes.leave_alike:
        yield Text(
            f"what is left is alike in all of them (p = {passes.alike:.2g}), so it is no noise: "
            "something else is not as stated, and the intervals do not hold"
        )


def _interval(name: str, found: Estimate) -> tuple[str, ...]:
    return (name, *(_number(x) for x in (found.value, found.lowest, found.highest)))


def _number(value: float) -> str:
    return "infinite" if math.isinf(value) else f"{value:.5g}"


def _left(found: Calibration | FittedObject | FittedBody) -> Iterator[Text]:
    """What the fit leaves, and what is known of the noise."""
    yield Text(f"the fit leaves {found.misfit:.2g} times the noise")
    names = COMPONENTS if isinstance(found, FittedBody) else CLAMP_READINGS
    yield from map(Text, found.noise.said(names))
    if below_the_noise(found.misfit, len(names) * found.stations):
        yield Text(
            "the noise is less than it was taken for: state less, the intervals are too wide"
        )
    if isinstance(found, FittedBody):  # whose sweeps are along lines of their own
        return
    held = found.passes is not None and found.passes.alike is not None
    if found.explains and found.noise.remembers.any() and not held:
        yield Text(
            "one pass, or two, do not distinguish noise that remembers from what is not as stated: "
            "three the same way do"
        )
