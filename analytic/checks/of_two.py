"""What readings of two contacts miss, by any way along the two spans of the vibrissa."""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np

from analytic.numerics.arrays import Booleans, Floats
from analytic.problem.columns import CONTACT, SCHEMA, SECOND_CONTACT, SENSED

if TYPE_CHECKING:
    import pandas as pd


class Reached(NamedTuple):
    """Where a span ends, as seen from where it begins; arrays of shape (n,)."""

    x: Floats
    y: Floats
    phi: Floats
    moment: Floats


Span: TypeAlias = Callable[[Floats, Floats, Floats, Floats, Floats], Reached]
"""From force on the vibrissa's begin (x, y), moment and slope angle there, and length."""


def touches_twice(columns: "Mapping[str, Any] | pd.DataFrame") -> Booleans:
    """Where readings state a second contact."""
    name = "second_contact_arc_length"
    if name not in columns:
        return np.zeros(len(columns["foot_x"]), dtype=bool)
    return np.asarray(np.isfinite(np.asarray(columns[name], dtype=float)))


def dimensionless(
    columns: "Mapping[str, Any] | pd.DataFrame",
    where: Booleans,
    length: float,
    force: float,
    moment: float,
) -> dict[str, Floats]:
    """Some rows of readings with L = EI = 1."""
    sizes = {"length": length, "force": force, "moment": moment, "angle": 1.0}
    names = (*SENSED, *CONTACT, *SECOND_CONTACT, "foot_y", "clamp_angle")
    units = {name: sizes[SCHEMA[name].dimension] if name in SCHEMA else 1.0 for name in names}
    return {
        name: np.asarray(columns[name], dtype=float)[where] / unit
        for name, unit in units.items()
        if name in columns
    }


def misses_of_two(
    read: Mapping[str, Floats],
    friction: float,
    radius: float,
    natural: float,
    compliance: float,
    span: Span,
) -> tuple[Floats, Floats]:
    """The largest miss of both contacts, and of the balance of moments at the outer one."""
    lean, push = np.arctan(friction), np.sqrt(1 + friction**2)
    force_x, force_y, moment = (read[name] for name in ("force_x", "force_y", "moment_z"))
    foot_y = read.get("foot_y", np.zeros_like(force_x))
    points = []
    for kind in ("", "second_"):
        alpha = read[f"{kind}contact_angle"]
        x = read[f"{kind}contact_x"] + radius * np.sin(alpha) - read["foot_x"]
        points.append((alpha, x, read[f"{kind}contact_y"] - radius * np.cos(alpha) - foot_y))
    (inner, x1, y1), (outer, x2, y2) = points
    s1, s2 = read["contact_arc_length"], read["second_contact_arc_length"]
    outer_force = push * read["second_contact_force"]
    beyond_x = -outer_force * np.sin(outer + lean)
    beyond_y = outer_force * np.cos(outer + lean)
    inner_x, inner_y = force_x - beyond_x, force_y - beyond_y
    couples = friction * radius / push * np.array([np.hypot(inner_x, inner_y), outer_force])
    clamp = np.pi / 2 + read.get("clamp_angle", np.zeros_like(x1)) - compliance * moment
    first = span(force_x, force_y, moment, clamp, s1)
    # Friction's couple on the surface is taken up where the inner contact is.
    onward = -first.moment - couples[0]
    second = span(beyond_x, beyond_y, onward, first.phi, s2 - s1)
    slope = read["tip_angle"] - natural * (1 - s2)
    into = np.where(s2 < 1, slope - outer, np.maximum(0.0, outer - slope))
    # Of no force, as where a contact begins or ends, any direction is right.
    turned = np.arctan2(-inner_x, inner_y) - inner - lean
    missed = [
        first.x - x1,
        first.y - y1,
        first.phi - inner,
        first.x + second.x - x2,
        first.y + second.y - y2,
        second.phi - slope,
        second.moment + couples[1],
        np.where(np.hypot(inner_x, inner_y) > 1e-9 * np.hypot(force_x, force_y), turned, 0.0),
        into,
        np.maximum(0.0, s2 - 1),
    ]
    extent = np.maximum(1.0, np.abs(read["contact_x"]))
    arms = inner_y * x1 - inner_x * y1 + beyond_y * x2 - beyond_x * y2
    balance = np.abs(moment - arms - couples.sum(axis=0)) / np.maximum(extent, np.abs(moment))
    return np.abs(missed).max(axis=0) / extent, balance
