"""Any convex body from its contacts: the least and the largest one that they allow."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from analytic.from_clamp.contact import LONGEST
from analytic.from_clamp.noise import DOUBLE_SIDED_95, covering
from analytic.numerics.arrays import Booleans, Floats
from analytic.problem.errors import InputError
from analytic.problem.shown import Shown
from analytic.space.from_clamp.reconstruct import (
    COMPONENTS,
    ClampInSpace,
    component_noise,
    contacts_moved,
    felt,
    of_one_vibrissa,
)
from analytic.space.problem.bodies.polyhedron import Polyhedron, polyhedron
from analytic.space.problem.readings import SpatialReadings

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_FEWEST = 8  # contacts
_MOST = 2000  # contacts that count: a picture shows no more, and fewer are as certain
_ROUNDED = 1e-10  # L; a hundred times what rounding leaves of a contact of exact readings
_WORSE = 2.0  # times the median uncertainty: contacts known to less widen the band of all others
_AROUND = 0.5  # of the contacts' longest side: how far around them the outer body is followed
_WRONG = 0.05  # of all cases, in which noise may be larger than the band states
_ON_BOX = 1e-6  # of the longest side; corners so near to the box are made by it


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class ConvexBand(Shown):
    """Two bodies between which the true one is, as sweeps past it show it.

    Parameters
    ----------
    inner : Body
        Lies inside the true one: the hull of the contacts, smaller by the noise.
    outer : Body
        What the true one has within `box` lies inside it: no plane through a contact, normal to the
        force there, cuts a convex body. Farther out by the noise.
    box : array, shape (2, 3)
        Least and largest coordinates that `outer` is followed to [length].
    half_width : float
        By which the contacts may be off, one and all, in 95 % of all cases [length].
    gaps : array, shape (n,)
        How far `outer` rises above each triangle of `inner` [length]; NaN where only the box ends
        it, as on the far side.
    explains : bool
        Whether there is a convex body with all these contacts and normals, within noise.
    stations : int
        How many contacts it is from.
    """

    inner: Polyhedron
    outer: Polyhedron
    box: Floats
    half_width: float
    gaps: Floats
    explains: bool
    stations: int

    @property
    def seen(self) -> float:
        """The share of the inner body's surface above which contacts end the outer one."""
        one, other, third = self.inner.corners.swapaxes(0, 1)
        areas = np.linalg.norm(np.cross(other - one, third - one), axis=1)
        return float(areas[np.isfinite(self.gaps)].sum() / areas.sum())

    @property
    def widest(self) -> float:
        """The largest of the gaps; NaN if the box ends the outer body everywhere [length]."""
        return float(np.fmax.reduce(self.gaps))

    def _tiles(self) -> dict[str, object]:
        return {
            "convex": "explains the readings" if self.explains else "does not explain the readings",
            "volume at least": f"{volume(self.inner):.4g}",
            "in the box at most": f"{volume(self.outer):.4g}",
            "seen": f"{self.seen:.0%}",
            "stations": self.stations,
        }

    def _draw(self, figure: "Figure") -> None:
        ax = figure.add_subplot(projection="3d")
        for body, alpha in ((self.inner, 1.0), (self.outer, 0.2)):
            x, z, y = body.vertices[:, [0, 2, 1]].T
            ax.plot_trisurf(x, z, y, triangles=body.faces, alpha=alpha)
        ax.set(aspect="equal", xlabel="x", ylabel="z", zlabel="y")


class _Touched(NamedTuple):
    """Contacts over L: where, and to what they are known, one and all."""

    points: Floats
    normals: Floats
    off: Floats
    turned: Floats  # rad

    def at(self, which: Booleans) -> "_Touched":
        return _Touched(*(values[which] for values in self))


def convex_band(
    readings: SpatialReadings | Sequence[SpatialReadings],
    noise: Mapping[str, float] | None = None,
) -> ConvexBand:
    """The least and the largest convex body that has the contacts found from the clamp.

    A convex body holds the hull of its contacts, and lies behind the plane through each of them
    that is normal to the force. Nothing else is assumed of it, so both bodies are bounds, not
    estimates: noise moves the inner one in and the planes out, by what all contacts together are
    within in 95 % of all cases. A zero that is left, friction and jitter of the foot are not in it.

    Parameters
    ----------
    readings : SpatialReadings, or a sequence of them
        Only the nine sensed columns are used, and status; several are sweeps past one body.
    noise : mapping, optional
        Standard deviations of the six components by name, each in its unit. If not given, they are
        what the readings themselves show.

    Returns
    -------
    ConvexBand
        Both bodies.

    Raises
    ------
    InputError
        If there are too few contacts, they are in a plane or noise may put them there, or the
        vibrissa is not straight and uniform.
    """
    sweeps = of_one_vibrissa(readings)
    parts = [_touched(one, noise, len(sweeps)) for one in sweeps]
    every = _Touched(*(np.concatenate(values) for values in zip(*parts, strict=True)))
    if len(every.points) < _FEWEST:
        remedy = "take more stations along the body"
        raise InputError("contacts", len(every.points), f"{_FEWEST} or more", remedy)
    known = every.at(every.off <= _WORSE * np.median(every.off))
    length, half_width = sweeps[0].beam.length, float(known.off.max())
    inner, middle = _inner(known.points, half_width)
    outer, box = _outer(known, middle)
    return ConvexBand(
        inner=inner.scaled(length),
        outer=outer.scaled(length),
        box=box * length,
        half_width=half_width * length,
        gaps=_gaps(inner, outer, box) * length,
        explains=_consistent(known),
        stations=len(known.points),
    )


def volume(body: Polyhedron) -> float:
    """Of a mesh [length^3]."""
    return float(np.linalg.det(body.corners - body.vertices.mean(axis=0)).sum() / 6)


def _touched(readings: SpatialReadings, noise: Mapping[str, float] | None, sweeps: int) -> _Touched:
    """The contacts of a sweep.

    All n contacts and n normals together are within their bounds in 95 % of cases if each is but
    for 1 in 40 n (Bonferroni), its distribution taken to be normal so far out.
    """
    from scipy.special import ndtri

    beam = readings.beam
    seen = component_noise(readings, noise)
    on = np.flatnonzero(felt(readings, seen))
    on = on[:: 1 + sweeps * len(on) // _MOST]
    clamp = ClampInSpace.of(readings).at(on)
    found = clamp.contacts()
    cases = 2 * sweeps * max(len(on), 1)
    deviation = max(seen[name] for name in COMPONENTS[:3]) / beam.force_unit
    # A force has two components across itself, each of which turns it: Rayleigh's distribution.
    turned = deviation * np.sqrt(2 * np.log(cases / _WRONG)) / np.linalg.norm(clamp.force, axis=1)
    off = np.zeros(len(on))
    if any(seen.values()):
        moved = contacts_moved(readings, seen, on) / beam.length
        off = covering(moved, axis=0) * -ndtri(_WRONG / cases / 2) / DOUBLE_SIDED_95
    kept = (found[6] >= 0) & (found[6] <= LONGEST) & np.isfinite(off)
    contacts = _Touched(found[:3].T, found[3:6].T, off + _ROUNDED, turned + _ROUNDED)
    return contacts.at(kept)


def _inner(points: Floats, off: float) -> tuple[Polyhedron, Floats]:
    """What surely is in the body, and its middle.

    Points that may each be off have a hull whose planes may all be that much farther in. The hull
    that shrinks towards the middle is behind these.
    """
    from scipy.optimize import linprog
    from scipy.spatial import QhullError

    centre = points.mean(axis=0)
    try:
        hull = polyhedron(points)
    except InputError as error:
        if isinstance(error.__cause__, QhullError):
            raise _flat() from error
        raise
    # The middle is as far as can be from all planes.
    planes = np.column_stack([hull.normals, np.ones(len(hull.normals))])
    heights = hull.heights - hull.normals @ centre
    found = linprog([0, 0, 0, -1], planes, heights, bounds=[(None, None)] * 3 + [(0, None)])
    way, depth = np.split(np.zeros(4) if found.x is None else found.x, [3])
    if depth[0] <= 2 * off:
        raise _flat()
    middle = centre + way
    inner = middle + (1 - off / depth[0]) * (hull.vertices - middle)
    return hull.with_vertices(inner), middle


def _flat() -> InputError:
    return InputError(
        "contacts",
        "in one line or plane, within noise",
        "of a body with a volume",
        "give several sweeps along different lines past it, or fit a sphere, ellipsoid or cylinder",
    )


def _outer(known: _Touched, middle: Floats) -> tuple[Polyhedron, Floats]:
    """What surely has the part of the body in it that is within a box, and the box."""
    from scipy.spatial import HalfspaceIntersection, QhullError

    low, high = known.points.min(axis=0), known.points.max(axis=0)
    around = _AROUND * float((high - low).max())
    box = np.stack([low - around, high + around])
    # No point of the box is farther from a contact, about which its plane may be turned.
    reach = np.linalg.norm(np.maximum(known.points - box[0], box[1] - known.points), axis=1)
    heights = (known.points * known.normals).sum(axis=1) + known.off + known.turned * reach
    sides = np.concatenate([np.eye(3), -np.eye(3)])
    planes = np.column_stack(
        [
            np.concatenate([known.normals, sides]),
            -np.concatenate([heights, box[1], -box[0]]),
        ]
    )
    try:
        cut = HalfspaceIntersection(planes, middle).intersections
    except QhullError as error:
        raise InputError(
            "contacts",
            "of which some planes cut off what is between all of them",
            "of one convex body",
            "check the frame, signs and friction, and take each body alone",
        ) from error
    return polyhedron(cut[np.isfinite(cut).all(axis=1)]), box


def _gaps(inner: Polyhedron, outer: Polyhedron, box: Floats) -> Floats:
    """How far the outer body rises above each triangle of the inner one; NaN up to the box."""
    near = _ON_BOX * float((box[1] - box[0]).max())
    at_box = np.abs(outer.vertices[:, None] - box).min(axis=(1, 2)) < near
    rises = inner.normals @ outer.vertices.T
    highest = rises.argmax(axis=1)
    gaps = rises[np.arange(len(highest)), highest] - inner.heights
    return np.where(at_box[highest], np.nan, gaps)


def _consistent(known: _Touched) -> bool:
    """Whether every contact is behind the planes of all others, within what both are known to."""
    for point, normal, off, turned in zip(*known, strict=True):
        apart = known.points - point
        allowed = off + known.off + turned * np.linalg.norm(apart, axis=1)
        if (apart @ normal > allowed).any():
            return False
    return True
