"""Quantities with units, as files and commands give them; SI inside."""

from functools import cache

import pint

from analytic import InputError

DIMENSIONS = {"foot_x": "m", "force_x": "N", "force_y": "N", "moment_z": "N m"}


@cache
def _registry() -> pint.UnitRegistry[float]:
    return pint.UnitRegistry()


def in_si(text: str, dimension: str) -> float:
    """The number of SI units in `text`, as ``in_si("50 mm", "m")``.

    Raises
    ------
    InputError
        If the unit is unknown or of another dimension.
    """
    try:
        return float(_registry().Quantity(text).to(dimension).magnitude)
    except (pint.PintError, TypeError, ValueError, AttributeError) as error:
        raise InputError(
            "quantity", repr(text), f"a number with a unit of {dimension}", "check the unit"
        ) from error
