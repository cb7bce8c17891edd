"""The centreline of a measured model at rest: how it curves, and where it leaves that course."""

from collections.abc import Iterator

import numpy as np

from analytic import Beam
from analytic.numerics.arrays import Floats
from compare.simulate.remark import Remark
from compare.simulate.rigidity import is_curved, least_deviations
from mujoco_models.inspect.measured import MeasuredBeam

_POINTS = 1001  # of a course
# L; one body of twenty that is so far aside makes readings 0.6 per cent worse, 3e-3 0.9, 0.01 3.
_ASIDE = 2e-3
# rad, of all joints, as the root of the sum of squares. At one of 12 to 40 joints 0.02 makes
# readings 0.1 to 0.9 per cent worse, 0.03 0.3 to 1.3, 0.05 0.4 to 2.3, the most at 0.3 L; at all
# of them, as of places read off with an error of 2e-4 L, 0.05 makes 1.2.
_KINK = 0.02
_BESIDE = 5e-3  # L; of the course that is stated, as `is_curved` allows
_ACROSS = 0.05  # L; of the plane: what is so far off it is 0.2 per cent shorter in it
# GJ/EI; a cable of ten links is 0.6 per cent off at 2, 0.9 at 0.3, 2.6 at 0.1 and 48 at 0.012.
_TORSION = 0.2
LEANS = 0.2
"""rad, of hinges; of 0.1 readings are 0.3 per cent worse, of 0.35 two."""
_UNIT = 0.1  # relative; in what is as many times too little as a radian has degrees
_MANY = 6  # joints; more than that say how the curvature changes


def curvature(found: MeasuredBeam, stations: int) -> float | list[tuple[float, float]]:
    """A case's natural curvature: a number if the centreline is an arc, or pairs along it."""
    s, terms = np.linspace(0, found.length, stations), _slope_terms(found)
    slope = np.polyval(terms, s) - terms[-1]
    arc = found.natural_curvature if is_curved(found) else 0.0
    off = np.cumsum(slope - arc * s) * s[1]
    if np.abs(off).max() < _BESIDE * found.length:
        return arc
    return list(zip(s.tolist(), np.polyval(np.polyder(terms), s).tolist(), strict=True))


def coiled(found: MeasuredBeam) -> Iterator[Remark]:
    """Springs that turn it back to its foot: of such a coil nothing else is worth saying."""
    turns = np.array([joint.springref for joint in found.joints])
    most, whole = float(turns[np.argmax(np.abs(turns))]), float(np.abs(np.cumsum(turns)).max())
    if whole > np.pi:
        yield Remark("fault", "springref", f"up to {most:.4g} rad at a joint, {whole:.3g} rad from "
                     "clamp to tip, turns the vibrissa back to its foot", "if it is in degrees, "
                     f'write springref="{np.deg2rad(most):.4g}", or <compiler angle="degree"/>'
                     )  # fmt: skip


def _as_degrees(found: MeasuredBeam, wanted: float | None = None) -> str:
    """What to do if springs turn it by so little that radians were perhaps taken for degrees."""
    most = max((joint.springref for joint in found.joints), key=abs)
    turned = np.rad2deg(found.natural_curvature)
    meant = abs(turned * found.length) < np.pi
    if wanted is not None:
        meant = abs(turned - wanted) < _UNIT * abs(wanted)
    if not (most and meant):
        return ""
    return (
        f"if its springref of {np.rad2deg(most):.4g} degrees at a joint is in radians, write "
        f'springref="{np.rad2deg(np.rad2deg(most)):.4g}", or <compiler angle="radian"/>'
    )


def on_course(found: MeasuredBeam, stated: Beam | None) -> Iterator[Remark]:
    """Whether it rests as it should, or on a smooth course."""
    length, own = found.length, found.natural_curvature
    _, middles, slopes = _links(found)
    aside = _off(found, slopes - np.polyval(_slope_terms(found), middles))
    worst = int(np.argmax(np.abs(np.diff(aside, prepend=0.0))))
    off, kinks = float(np.abs(aside).max()) / length, _kinks(found)
    if off > _ASIDE:
        joint = found.joints[min(worst, len(found.joints) - 1)]
        yield Remark("fault", "centreline", f"at rest it leaves a smooth course by {off:.1e} L, "
                     f"most at {joint.name!r}, s = {joint.s / length:.2f} L",
                     "let each body begin where the one before ends, and point where that does"
                     )  # fmt: skip
    elif np.linalg.norm(kinks) > _KINK:
        worst = int(np.argmax(np.abs(kinks)))
        joint = found.joints[worst]
        yield Remark("fault", "centreline", "at rest it is kinked: by "
                     f"{abs(kinks[worst]):.2g} rad at {joint.name!r}, s = {joint.s / length:.2f} L,"
                     " beside its neighbours", "let each body point where the one before does, or "
                     "spread the turn over all joints")  # fmt: skip
        return
    if stated is None:
        if is_curved(found) and off <= _ASIDE:
            yield Remark("note", "natural curvature", f"the tip is turned by {own * length:.3g} "
                         "rad at rest, as a curved vibrissa's is",
                         _as_degrees(found))  # fmt: skip
        return
    s = np.linspace(0, stated.length, _POINTS)
    curved = stated.curvature_at(s)
    meant = np.append(0.0, np.cumsum(curved[1:]) * s[1])
    wanted = float(meant[-1]) / stated.length
    beside = slopes - np.interp(middles / length, s / stated.length, meant)
    # The way of its first link, a chord of an arc or straight, is not the clamp's.
    turned = np.abs(curved).max() * max(found.joints[0].cell, found.joints[0].s)
    beside = _off(found, beside - np.clip(np.median(beside), -turned, turned))
    if is_curved(found, wanted):
        yield Remark("fault", "natural curvature", f"{own * length:.3g}/L instead of "
                     f"{wanted * length:.3g}/L: at rest the tip is turned by so much",
                     _as_degrees(found, wanted))  # fmt: skip
    elif (far := float(np.abs(beside).max()) / length) > _BESIDE and off <= _ASIDE:
        yield Remark("fault", "natural curvature", f"as large as stated in the mean, but up to "
                     f"{far:.1e} L beside that course")  # fmt: skip


def on_plane(found: MeasuredBeam) -> Iterator[Remark]:
    """Whether it stays in the plane of the sweep, at rest and bent."""
    off = found.out_of_plane / found.length
    if off > _ACROSS:
        yield Remark("fault", "plane", f"at rest it is up to {off:.2g} L off the plane in which it "
                     "bends", "turn the axes of its joints, or its bodies")  # fmt: skip
    if not found.planar:
        yield Remark(
            "note", "plane", "nothing keeps it in the plane of the sweep: where an object without "
            "friction recedes, it slips off sideways before it would let go"
        )  # fmt: skip
    if found.lean > LEANS:
        yield Remark("fault", "plane", f"the axes of its hinges lean {np.rad2deg(found.lean):.2g} "
                     "degrees along it: as it bends, it leaves the plane of the sweep",
                     "turn them across it")  # fmt: skip
    if found.torsion < _TORSION:
        yield Remark(
            "fault", "torsion", f"it twists {1 / found.torsion:.2g} times as easily as it bends, "
            "and leaves the plane of the sweep; a round rod of any material has 1 to 1.5",
            f"make what resists the twist {0.8 / found.torsion:.2g} times as stiff"
        )  # fmt: skip


def _links(found: MeasuredBeam) -> tuple[Floats, Floats, Floats]:
    """Lengths, middles and slope angles of what is between joints, from the clamp to the tip."""
    ends = np.array([0.0, *(joint.s for joint in found.joints), found.length])
    slopes = np.cumsum([0.0, *(joint.angle for joint in found.joints)])
    return np.diff(ends), (ends[1:] + ends[:-1]) / 2, slopes


def _slope_terms(found: MeasuredBeam) -> Floats:
    """Of a polynomial in arc length, of which single links are off.

    It need not be zero at the clamp: where that is at a hinge, the first link turns with it.
    """
    lengths, middles, slopes = _links(found)
    share = middles / found.length
    powers = np.arange(3 if len(found.joints) > _MANY else 1, -1, -1)
    weights = np.sqrt(lengths / found.length)
    terms = weights[:, None] * share[:, None] ** powers
    fit = least_deviations(terms, weights * slopes)
    return np.asarray(fit / found.length**powers)


def _off(found: MeasuredBeam, slopes: Floats) -> Floats:
    """How far each link's end is aside, by slopes beside those of a course.

    But for what the first and the last, straight in a piece of an arc, are off that arc.
    """
    lengths, middles, own = _links(found)
    bends = np.abs(np.gradient(own, middles))
    slopes = slopes.copy()
    for end in (0, -1):
        allowed = bends[end] * lengths[end] / 2
        slopes[end] = np.sign(slopes[end]) * max(abs(slopes[end]) - allowed, 0.0)
    return np.asarray(np.cumsum(slopes * lengths))


def _kinks(found: MeasuredBeam) -> Floats:
    """How much more each joint turns at rest than those around it [rad]."""
    turns, cells = np.array([(joint.angle, joint.cell) for joint in found.joints]).T
    rates, kinks = turns / cells, np.zeros(len(turns))
    for i in range(2, len(turns) - 2):  # the first and the last have chords of an arc beside them
        beside = min(2, i - 1, len(turns) - 2 - i)
        kinks[i] = turns[i] - cells[i] * np.median(rates[i - beside : i + beside + 1])
    return kinks
