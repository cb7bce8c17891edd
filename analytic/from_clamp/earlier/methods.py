"""The earlier methods by name: who published them, and what each needs."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from analytic.from_clamp.earlier import integrated, segments, small_deflection
from analytic.from_clamp.earlier.sensed import Answer, LoadedStations


@dataclass(frozen=True)
class Method:
    """A way to find the contact from the clamp."""

    source: str  # author and year
    # What it has to know: of ``"moment"``, ``"force"``, ``"rigidity"``, ``"first contact"``,
    # ``"slope"`` and ``"length"``.
    needs: tuple[str, ...]
    estimate: Callable[[LoadedStations], Answer]  # the contact on the vibrissa's axis


METHODS: dict[str, Method] = {
    "binary": Method(
        "binary whiskers of mobile robots",
        ("moment", "length"),
        small_deflection.binary,
    ),
    "kaneko": Method(
        "Kaneko, Kanayama and Tsuji 1998",
        ("moment", "rigidity", "first contact"),
        small_deflection.from_moment_and_travel,
    ),
    "kim-moeller": Method(
        "Kim and Moeller 2007",
        ("slope", "first contact"),
        small_deflection.from_slope_and_travel,
    ),
    "birdwell": Method(
        "Birdwell and others 2007",
        ("moment", "force", "rigidity"),
        small_deflection.from_force_and_moment,
    ),
    "birdwell-cone": Method(
        "Birdwell and others 2007",
        ("moment", "force", "rigidity"),
        small_deflection.from_force_and_moment_of_cone,
    ),
    "beam-column": Method(
        "Timoshenko and Gere 1961",
        ("moment", "force", "rigidity"),
        small_deflection.from_beam_column,
    ),
    "scholz-rahn": Method(
        "Scholz and Rahn 2004",
        ("moment", "force", "rigidity", "length"),
        integrated.up_to_zero,
    ),
    "clements-rahn": Method(
        "Clements and Rahn 2006",
        ("moment", "force", "rigidity", "length"),
        integrated.up_to_zero,
    ),
    "quist-hartmann": Method(
        "Quist and Hartmann 2012",
        ("force", "rigidity", "length"),
        segments.by_segments,
    ),
    "quist-hartmann-half-cell": Method(
        "Quist and Hartmann 2012, with half a segment that bends at the clamp",
        ("force", "rigidity", "length"),
        partial(segments.by_segments, half_cell=True),
    ),
}

OWN = ("elastica", "decision")
"""The paper's: in closed form, and its way to decide the phase first and integrate then."""
NAMES = (*METHODS, *OWN)
