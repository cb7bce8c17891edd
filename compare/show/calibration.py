"""What a calibration found, for people and as JSON."""

import math
from collections.abc import Iterator
from typing import Any

from analytic import CLAMP_READINGS, Calibration
from compare.show.document import Block, Table, Text
from compare.show.passes import consistency_line

_UNITS = {
    "flexural_rigidity": "N m^2",
    "clamp_stiffness": "N m",
    "natural_curvature": "1/m",
    "clamp_angle": "rad",
    "tip_radius": "m",
    "offset": "m",
}


def calibration_summary(calibration: Calibration) -> Iterator[Block]:
    """What a terminal shows: what was found, and how far it is to be trusted."""
    rows = []
    for name, found in calibration.found.items():
        unit = _UNITS.get(name, "") if calibration.case.beam.si else ""
        numbers = (_number(x) for x in (found.value, found.lowest, found.highest))
        scatter = [_number(calibration.scatter[name])] if name in calibration.scatter else []
        rows.append((name, *numbers, unit, *scatter))
    passes = calibration.passes
    several = () if passes is None else ("passes scatter by",)
    head = ("found", "value", "95 % from", "to", "", *several)
    of = "" if passes is None else f" of {len(passes.numbers)} passes"
    yield Table(f"From {calibration.stations} stations{of}", head, rows, words=(0, 4))
    if passes is not None:
        yield Text(consistency_line(passes))
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
    yield Text(f"the fit leaves {calibration.misfit:.2g} times the noise")
    for said in calibration.noise.said(CLAMP_READINGS):
        yield Text(f"{said}; the intervals know it")
    if calibration.jitter:
        unit = " m" if calibration.case.beam.si else ""
        yield Text(f"the foot jitters by {calibration.jitter:.2g}{unit}; the intervals know it")
    if calibration.misfit_shows:
        yield Text(
            "something else is not as the case says: the intervals hold for noise, not for that"
        )


def calibration_document(calibration: Calibration) -> dict[str, Any]:
    """What ``calibration.json`` holds."""
    return {
        "case": calibration.case.name,
        "found": calibration.found,
        "correlation": calibration.correlation.tolist(),
        "stations": calibration.stations,
        "misfit": calibration.misfit,
        "noise_correlation": dict(
            zip(CLAMP_READINGS, calibration.noise.correlation.tolist(), strict=True)
        ),
        "hum_stations": calibration.noise.hum or None,
        "jitter": calibration.jitter,
        "undistinguished": calibration.undistinguished,
        "passes": None
        if calibration.passes is None
        else {
            "scatter": calibration.scatter,
            "chi_square": calibration.passes.chi_square,
            "degrees": calibration.passes.degrees,
            "probability": calibration.passes.probability,
        },
    }


def _number(value: float) -> str:
    return "infinite" if math.isinf(value) else f"{value:.5g}"
