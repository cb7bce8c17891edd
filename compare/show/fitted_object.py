"""An object that was fitted to clamp readings, for people and as JSON."""

from collections.abc import Iterator
from typing import Any

from analytic import CLAMP_READINGS, FittedObject
from analytic.space import FittedBody
from analytic.space.from_clamp.noise import COMPONENTS
from compare.show.document import Block, Table, Text
from compare.show.numbers import quantity
from compare.show.passes import consistency_line


def object_summary(found: FittedObject | FittedBody, si: bool) -> Iterator[Block]:
    """What a terminal shows: the parameters, and how far they are to be trusted."""
    unit = "m" if si else ""
    yield Table(
        f"{found.family.capitalize()}, from {found.stations} stations",
        ("found", "value", "95 % from", "to", ""),
        [
            (
                name,
                *(f"{x:.5g}" for x in (one.value, one.lowest, one.highest)),
                "" if name.startswith(("exponent", "log", "axis")) else unit,
            )
            for name, one in found.found.items()
        ],
        words=(0, 4),
    )
    if isinstance(found, FittedObject):
        widest = quantity(float(found.band["half_width"].max()), "length", found.case.beam)
        yield Text(f"where it was touched, the contour is known to {widest} or better (95 %)")
    if len(found.rivals) > 1:
        least = min(bic for bic, _ in found.rivals.values())
        yield Table(
            "Schwarz's criterion, over the least; the likeliest family has 0, and 10 is decisive",
            ("family", "more by", "explains the readings"),
            [
                (name, f"{bic - least:.1f}", "yes" if explains else "no")
                for name, (bic, explains) in found.rivals.items()
            ],
            words=(0, 2),
        )
    if isinstance(found, FittedObject) and found.passes is not None:
        yield Text(consistency_line(found.passes))
    yield Text(f"the fit leaves {found.misfit:.2g} times the noise")
    names = CLAMP_READINGS if isinstance(found, FittedObject) else COMPONENTS
    for said in found.noise.said(names):
        yield Text(f"{said}; the intervals know it")
    if not found.explains:
        yield Text(
            f"noise alone does not explain what is left: it is no {found.family}, or something "
            "else is not as stated; the intervals hold for noise, not for that"
        )


def object_document(found: FittedObject | FittedBody) -> dict[str, Any]:
    """What ``object.json`` holds."""
    document: dict[str, Any] = {
        "family": found.family,
        "found": found.found,
        "explains": found.explains,
        "misfit": found.misfit,
        "stations": found.stations,
        "rivals": {name: {"bic": bic, "explains": x} for name, (bic, x) in found.rivals.items()},
    }
    if isinstance(found, FittedBody):
        return document
    return document | {
        "chi_square": None if found.passes is None else found.passes.chi_square,
        "probability": None if found.passes is None else found.passes.probability,
        "band": {name: values.tolist() for name, values in found.band.items()},
    }
