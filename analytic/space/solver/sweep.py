"""The sweep in space: every station solved, checked and put into one table."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pandas as pd
from threadpoolctl import threadpool_limits

from analytic.from_clamp.contact import contact_bent_right
from analytic.numerics.arrays import Floats
from analytic.problem.beam import Beam
from analytic.problem.errors import require
from analytic.solver.general.columns import engine
from analytic.space.checks.rod import rod_residuals
from analytic.space.problem.case import SpatialCase
from analytic.space.problem.readings import (
    CONTACT_POINT,
    FOOT,
    FORCE,
    FRICTION,
    MOMENT,
    NORMAL,
    SpatialReadings,
)
from analytic.space.problem.recorder import stated
from analytic.space.solver.branch import Held
from analytic.space.solver.contact import APART, Plane, Scene
from analytic.space.solver.sliding import Sliding
from analytic.space.solver.stability import margin, second_variation
from analytic.space.solver.walk import Walk

_SOLVED = 1e-11  # L, EI/L, rad: of the residual by the closed form
_CERTIFIED = 1e-9  # of that by integration, which is good to 1e-12
_RUBBED = (*FRICTION, "slip_speed")
_NUMBERS = ("contact_angle", "contact_arc_length", "stability", "residual")
_COLUMNS = ("phase", *FORCE, *MOMENT, *CONTACT_POINT, *NORMAL, *_NUMBERS, "status")


def solve_space(case: SpatialCase, certified: bool = False) -> SpatialReadings:
    """The readings of a case in space in closed form, at its stations.

    Parameters
    ----------
    case : SpatialCase
        The problem.
    certified : bool
        Whether each station is to be checked by integration from the clamp too.

    Returns
    -------
    SpatialReadings
        In the units of the case's beam; source ``"analytic"``. ``status`` is ``"slipped off"``,
        without readings, from where the vibrissa slips off to where it would not lie in the body if
        it were straight: it is against another part of the body then, and which depends on its
        motion. ``stability`` is the least eigenvalue of the second variation, its rows scaled: it
        falls to zero where the vibrissa slips off. ``residual`` is the largest miss of the
        contact's place, arc length and of the foot's, in L, found from the clamp readings by the
        closed form, or from the clamp by integration if that is larger; ``status`` is
        ``"diverged"`` where it exceeds 1e-11, or 1e-9 by integration. ``provenance["events"]``
        lists what happens where.
        With friction there are also the columns ``friction_*``, friction over the normal force, and
        ``slip_speed``, of the vibrissa's point along the body over the foot's; no ``stability``: a
        contact that slides leaves its equilibria only where the foot stands still on their curve.
        ``status`` is ``"sticks"`` from a first contact that can slide in no direction to where the
        straight vibrissa is clear.
        A vibrissa that comes to an edge which drops it hops to the stable state of less energy
        close by, if that is one; the event ``"hop"`` says where.
    """
    require("case", case, SpatialCase, "as SpatialCase(body=..., path=...)")
    beam, length = case.beam, case.beam.length
    way = case.way
    scene = Scene(way.body, case.path.clamp_tangent, way.radius)
    travel = case.path.travel
    with threadpool_limits(1):  # the matrices are small
        walked = Walk(scene, way, case.friction).along(travel / length)
    feet = case.path.at(travel)
    touching = [contact is not None for contact in walked.contacts]
    held = [one for one in walked.contacts if one is not None]
    missed = iter(_missed([one.state for one in held], feet[touching] / length, scene))
    rows = [
        _row(one, next(missed), scene, beam) if one else _free(status)
        for one, status in zip(walked.contacts, walked.statuses, strict=True)
    ]
    table = pd.DataFrame(rows, columns=[*_COLUMNS, *(_RUBBED if case.friction else ())])
    foot = dict(zip(FOOT, feet.T, strict=True))
    table = pd.concat([pd.DataFrame({"travel": travel, **foot}), table], axis=1)
    provenance = {**case.provenance(), "engine": engine(), "events": stated(case, walked.events)}
    tangent = case.path.clamp_tangent
    readings = SpatialReadings(table, beam, tangent, "analytic", provenance)
    return _with_certificate(readings) if certified else readings


def _row(held: Held, missed: float, scene: Scene, beam: Beam) -> dict[str, object]:
    """One station that touches."""
    contact = held.state.contact
    plane, spot = contact.plane, contact.spot
    force = -contact.force * plane.normal
    moment = np.sqrt(contact.force) * contact.loaded.moment * plane.across
    row: dict[str, object] = {
        "phase": "tangent" if contact.tangent else "tip",
        **dict(zip(FORCE, force * beam.force_unit, strict=True)),
        **dict(zip(MOMENT, moment * beam.moment_unit, strict=True)),
        **dict(zip(CONTACT_POINT, spot.point * beam.length, strict=True)),
        **dict(zip(NORMAL, spot.normal, strict=True)),
        "contact_angle": Plane.of(scene.tangent, spot.normal).alpha,
        "contact_arc_length": contact.arc_length * beam.length,
        "residual": missed,
        "status": "ok" if missed <= _SOLVED else "diverged",
    }
    law = held.stretch.panel.law
    if not law.friction:
        row["stability"] = stable = margin(second_variation(contact, scene.radius))
        if not stable > 0:
            row["status"] = "diverged"
    else:
        numbers = *held.state.rub, 0.0 if law.sticks else float(np.linalg.norm(held.velocity))
        row |= dict(zip(_RUBBED, numbers, strict=True))
    return row


def _missed(states: Sequence[Sliding], feet: Floats, scene: Scene) -> Floats:
    """From the clamp back to the contacts: place, arc length; phase, and distance from the body."""
    contacts = [state.contact for state in states]
    beyond = [
        one.contact.arc_length - 1 if one.contact.tangent else -one.leans_in for one in states
    ]
    off = np.zeros(len(states))
    if not scene.body.smooth:  # on a face, an edge or a corner as if it had no end
        spots = [scene.body.nearest(one.on_parallel, APART).point for one in contacts]
        places = [one.spot.point for one in contacts]
        off = np.abs(np.reshape(spots, (-1, 3)) - np.reshape(places, (-1, 3))).max(axis=1)
    force = np.array([contact.force for contact in contacts])
    moment = np.sqrt(force) * [contact.loaded.moment for contact in contacts]
    alpha = np.array([contact.plane.alpha for contact in contacts])
    lateral = np.array([contact.plane.lateral for contact in contacts]).reshape(-1, 3)
    centres = np.array([contact.centre for contact in contacts]).reshape(-1, 3)
    arc_length = np.array([contact.arc_length for contact in contacts])
    sensed = np.array([0 * force, -force * np.sin(alpha), force * np.cos(alpha), moment])
    found = contact_bent_right(sensed)
    axis = feet + found.xi[:, None] * lateral + np.multiply.outer(found.eta, scene.tangent)
    extent = np.maximum(1.0, np.abs(feet).max(axis=1, initial=0.0))
    apart = np.abs(axis - centres).max(axis=1, initial=0.0) / extent
    shorter = np.abs(found.arc_length - arc_length)
    return np.asarray(np.max([apart, shorter, beyond, off], axis=0))


def _free(status: str) -> dict[str, object]:
    """One station that touches nothing, or of which nothing is known."""
    if status != "ok":
        return {"phase": "free", "status": status}
    nothing = dict.fromkeys((*FORCE, *MOMENT, "residual"), 0.0)
    return {"phase": "free", **nothing, "status": "ok"}


def _with_certificate(readings: SpatialReadings) -> SpatialReadings:
    found = rod_residuals(readings)
    table = readings.table
    wrong = readings.trusted & ~(found <= _CERTIFIED)
    table = table.assign(
        residual=np.fmax(table["residual"], found), status=table["status"].mask(wrong, "diverged")
    )
    return replace(readings, table=table)
