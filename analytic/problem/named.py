"""The named cases: the paper's contours and two more, and vibrissae beyond the paper's."""

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

from analytic.problem.beam import Beam
from analytic.problem.case import Case
from analytic.problem.clamp_path import Sweep, Whisk
from analytic.problem.contours.contour import Contour
from analytic.problem.contours.families import catenary, circle, ellipse, parabola, two_circles
from analytic.problem.contours.mesh_section import mesh_section
from analytic.problem.contours.polygon import polygon
from analytic.problem.contours.through_points import through_points
from analytic.problem.errors import unknown

CONTOURS: Mapping[str, Callable[..., Contour]] = MappingProxyType(
    {
        "catenary": catenary,
        "parabola": parabola,
        "circle": circle,
        "ellipse": ellipse,
        "two-circles": two_circles,
        "polygon": polygon,
        "points": through_points,
        "mesh": mesh_section,
    }
)
"""Factories of contours by kind."""

NAMED_PROFILES: Mapping[str, Mapping[str, Any]] = MappingProxyType(
    {
        "catenary": {"kind": "catenary", "a": 0.5, "c": -0.8},  # the paper's g1
        "parabola": {"kind": "parabola", "a": 0.5, "c": 0.5},  # g2
        "two-circles": {"kind": "two-circles"},  # g3
        "shallow-catenary": {"kind": "catenary", "a": 0.25, "c": -0.8},  # that of fig. 12
        "tip-only": {"kind": "catenary", "a": 0.5, "c": -0.2},  # g1 raised by 0.6: no Phase B
    }
)
"""The contours of the named cases, as the ``[profile]`` tables of their case files."""

CASE_NAMES = tuple(NAMED_PROFILES)
"""The cases of the paper's vibrissa."""

_CATENARY = NAMED_PROFILES["catenary"]

NAMED_TABLES: Mapping[str, Mapping[str, Mapping[str, Any]]] = MappingProxyType(
    {
        **{name: {"profile": profile} for name, profile in NAMED_PROFILES.items()},
        # An arc that turns by 0.5 rad from clamp to tip, its tip trailing: 29 degrees, as much as
        # shows at a glance. Curved forward as much it would touch the object twice.
        "pre-curved": {"profile": _CATENARY, "beam": {"natural_curvature": -0.5}},
        # A load across the tip deflects the vibrissa by 1/3 and turns its clamp by 1/8, in units of
        # the load times L^3/EI and L^2/EI: the clamp gives 3/8 as much way as the vibrissa bends.
        "soft-support": {"profile": _CATENARY, "support": {"rotational_stiffness": 8.0}},
        # Steel on a dry plastic has 0.2 to 0.4; for a rat's whisker on steel 0.48 was found (L. A.
        # Huet and M. J. Z. Hartmann, IEEE Transactions on Haptics 9, 2016).
        "rubbing": {"profile": _CATENARY, "contact": {"friction": 0.3}},
        # A rat's: 20 mm long and 0.12 mm thick at its base (M. J. Z. Hartmann, Scholarpedia 10,
        # 2015, 6636), with a tip of a tenth of that (H. M. Belli and others, Journal of
        # Neurophysiology 117, 2017, find that this ratio varies much), curved so that its tip
        # trails, and with that friction.
        "whisker": {
            "profile": _CATENARY,
            "beam": {"radius": 0.003, "tip_radius": 0.0003, "natural_curvature": -0.4},
            "contact": {"friction": 0.48},
        },
        # The foot stands and the clamp turns, from clear of the object to past its snap-off.
        "whisk-catenary": {
            "profile": _CATENARY,
            "whisk": {"foot_x": 0.6, "start": -1.1, "stop": 1.75},
        },
        "whisk-circle": {
            "profile": {"kind": "circle", "radius": 1.0, "lowest": (0.0, 0.4)},
            "whisk": {"foot_x": 0.4, "start": -0.55, "stop": 1.95},
        },
    }
)
"""All named cases, as the tables of their case files."""

WHISK_CASE_NAMES = tuple(name for name, tables in NAMED_TABLES.items() if "whisk" in tables)
"""The cases of a foot that stands while the clamp turns."""

REAL_CASE_NAMES = tuple(
    name for name in NAMED_TABLES if name not in (*CASE_NAMES, *WHISK_CASE_NAMES)
)
"""The cases of a vibrissa that is curved at rest, on an elastic clamp, or rubs."""


def named_contour(name: str) -> Contour:
    numbers = dict(NAMED_TABLES[name]["profile"])
    return CONTOURS[numbers.pop("kind")](**numbers)


def named_case(name: str) -> Case:
    """One of the named cases, with the default sweep.

    Parameters
    ----------
    name : str
        One of `CASE_NAMES`, `REAL_CASE_NAMES` or `WHISK_CASE_NAMES`.

    Returns
    -------
    Case
        The problem.

    Raises
    ------
    InputError
        If there is no case of that name.
    """
    if name not in NAMED_TABLES:
        raise unknown("case", name, NAMED_TABLES, remedy="`compare.load_case` reads a TOML file")
    tables = NAMED_TABLES[name]
    return Case(
        Beam(**tables.get("beam", {})),
        named_contour(name),
        Whisk(**tables["whisk"]) if "whisk" in tables else Sweep(),
        name=name,
        clamp_stiffness=tables.get("support", {}).get("rotational_stiffness", math.inf),
        clamp_angle=tables.get("support", {}).get("angle", 0.0),
        friction=tables.get("contact", {}).get("friction", 0.0),
    )
