"""What a calibration found, in lines and as a document."""

import math
from typing import Any

from analytic import Calibration

_UNITS = {
    "flexural_rigidity": "N m^2",
    "clamp_stiffness": "N m",
    "natural_curvature": "1/m",
    "tip_radius": "m",
    "offset": "m",
}


def calibration_lines(calibration: Calibration) -> list[str]:
    """What a terminal shows."""
    names = list(calibration.found)
    lines = []
    for name, found in calibration.found.items():
        unit = _UNITS.get(name, "") if calibration.case.beam.si else ""
        value, *ends = (_number(x) for x in (found.value, found.lowest, found.highest))
        shown = f"{name} = {value} {unit}".rstrip()
        lines.append(f"{shown}, with 95 % between {ends[0]} and {ends[1]}")
    pairs = [(i, j) for j in range(len(names)) for i in range(j)]
    if pairs:
        i, j = max(pairs, key=lambda pair: abs(calibration.correlation[pair]))
        alike = calibration.correlation[i, j]
        lines.append(f"trading off most: {names[i]} and {names[j]}, correlation {alike:+.2f}")
    lines.append(
        f"from {calibration.stations} stations; the fit leaves {calibration.misfit:.2g} times the "
        "noise"
    )
    if not calibration.explains:
        lines.append(
            "something else is not as the case says: the intervals hold for noise, not for that"
        )
    return lines


def calibration_document(calibration: Calibration) -> dict[str, Any]:
    """What ``calibration.json`` holds."""
    found = {
        name: {
            "value": _finite(one.value),
            "lowest": _finite(one.lowest),
            "highest": _finite(one.highest),
        }
        for name, one in calibration.found.items()
    }
    return {
        "case": calibration.case.name,
        "found": found,
        "correlation": calibration.correlation.tolist(),
        "stations": calibration.stations,
        "misfit": calibration.misfit,
    }


def _number(value: float) -> str:
    return "infinite" if math.isinf(value) else f"{value:.5g}"


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
