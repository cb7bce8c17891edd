"""What a user should know of a model that was measured: faults, and notes."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from analytic import Beam
from compare.simulate.rigidity import (
    as_intended,
    as_stated,
    by_its_clamp,
    elastica_error,
    is_curved,
    smooth_rigidity,
    tapers,
)
from mujoco_models.inspect.measured import Geom, MeasuredBeam, Sensed

# Each limit is what moves a reading by about one per cent of its largest magnitude.
_RIGIDITY = 0.01  # relative; forces and moments are proportional to EI
_LENGTH = 0.005  # relative; forces go with 1/L^2
_RADIUS = 2e-3  # L; the contour that the axis feels is the radius away
_JOINT = (
    0.05  # relative; one of twenty that is off by that moves readings by a quarter of a per cent
)
_ROTATED = np.deg2rad(0.5)  # rad; 0.9 per cent of one force is read as the other
_LEVER = 5e-3  # L; of the force's moment
_SAG = 2e-3  # L; as a contact that is so far off
_SINKS = 2e-3  # L; likewise
_FORCE = 3.0  # EI/L^2; the largest of a usual sweep
_BENDS = 5.0  # rad; what all joints together turn by in a usual sweep, at most
_ELASTICA = 0.02  # L; a sound chain of ten links is off by 4e-3 at P L^2/EI = 10
_METRES = 3.0  # a longer vibrissa is rather one in millimetres
_EXPLICIT = ("euler", "implicit", "implicitfast", "rk4")  # in the springs


@dataclass(frozen=True)
class Remark:
    """A line on a model."""

    # A ``"fault"`` moves readings by about a per cent or more; a ``"note"`` is good to know.
    kind: Literal["fault", "note"]
    subject: str  # as ``"clamp"``
    text: str  # in a sentence

    def __str__(self) -> str:
        return f"{self.kind}, {self.subject}: {self.text}"


def remarks(found: MeasuredBeam, stated: Beam | None = None) -> tuple[Remark, ...]:
    """What there is to say of a model."""
    said = [
        *_stiffness(found),
        *_stated(found, stated),
        *_units(found, stated),
        *_rest(found, stated),
        *_plane(found),
        *_foot(found),
        *_sensors(found),
        *_contacts(found),
        *_steps(found),
    ]
    return tuple(sorted(said, key=lambda remark: remark.kind))


def _stiffness(found: MeasuredBeam) -> Iterator[Remark]:
    rigidity = smooth_rigidity(found)
    own = np.array([joint.flexural_rigidity for joint in found.joints])
    off = by_its_clamp(found) / as_intended(found) - 1
    first = own[0] / rigidity[0]
    if abs(off) > _RIGIDITY:
        why = ""
        if 0.3 < first < 0.8:
            why = ": the hinge at the clamp stands for half a cell, and should be twice as stiff"
        elif 1.2 < first < 2:
            why = ": the first link is rigid over a whole cell, half a cell too much"
        elif tapers(found):
            why = ": too few links for its taper"
        yield Remark("fault", "clamp", f"bends like EI {abs(off):.1%} "
                     f"{'lower' if off < 0 else 'higher'} than its joints say{why}")  # fmt: skip
    for joint, off_by in list(zip(found.joints, own / rigidity - 1, strict=True))[1:-1]:
        if abs(off_by) > _JOINT:
            yield Remark("fault", "uniformity", f"the joint of {joint.name!r}, at s = "
                         f"{joint.s / found.length:.2f} L, is {abs(off_by):.0%} too "
                         f"{'stiff' if off_by > 0 else 'soft'} beside its neighbours")  # fmt: skip
    if tapers(found):
        yield Remark("note", "uniformity", f"EI goes from {rigidity[0]:.4g} at the clamp to "
                     f"{rigidity[-1]:.4g} at the tip")  # fmt: skip
    error = elastica_error(found)
    if abs(off) <= _RIGIDITY and error > _ELASTICA and not found.limits:
        why = "take more links" if found.linear else "its springs stiffen as they turn"
        yield Remark("fault", "large bending", f"the tip is up to {error:.1e} L off the exact "
                     f"cantilever: {why}")  # fmt: skip
    if found.limits and found.limits[0] < _BENDS * max(j.cell for j in found.joints) / found.length:
        yield Remark("fault", "limits", f"a joint is limited to {np.rad2deg(found.limits[0]):.3g} "
                     "degrees, less than a sweep bends it")  # fmt: skip
    stretch = found.stretch * _FORCE * found.tip_rigidity / found.length**2
    if stretch > _LENGTH:
        far = f"by {stretch:.1%}" if stretch < 1 else "to more than twice its length"
        yield Remark("fault", "edges", f"a pull of {_FORCE:g} EI/L^2 stretches one {far}"
                     ": stiffen their constraint, as <edge equality=\"true\" solref=\"0.001 1\" "
                     "solimp=\"0.9999 0.9999 0.001\"/>")  # fmt: skip
    if found.friction_loss > 0:
        yield Remark("fault", "friction in joints", f"frictionloss of {found.friction_loss:.3g} "
                     "holds moments: the vibrissa stays bent")  # fmt: skip


def _stated(found: MeasuredBeam, stated: Beam | None) -> Iterator[Remark]:
    if stated is None or _in_other_units(found, stated):
        return
    own = as_intended(found)
    for what, measured, wanted, allowed in (
        ("length", found.length, stated.length, _LENGTH),
        ("EI", own, as_stated(stated), _RIGIDITY),
    ):
        off = measured / wanted - 1
        if abs(off) > allowed:
            yield Remark("fault", what, f"{measured:.6g}, which is {abs(off):.1%} "
                         f"{'more' if off > 0 else 'less'} than stated ({wanted:.6g})")  # fmt: skip
    middles = np.array([(geom.start + geom.end) / 2 for geom in found.geoms])
    wanted_radii = stated.radius_at(np.clip(middles, 0, stated.length))
    radii = np.array([geom.radius for geom in found.geoms])
    worst = int(np.argmax(np.abs(radii - wanted_radii)))
    if abs(radii[worst] - wanted_radii[worst]) > _RADIUS * found.length:
        yield Remark("fault", "radius", f"{radii[worst]:.4g} instead of {wanted_radii[worst]:.4g}, "
                     f"at s = {middles[worst] / found.length:.2f} L")  # fmt: skip


def _in_other_units(found: MeasuredBeam, stated: Beam) -> bool:
    return not 0.1 < found.length / stated.length < 10


def _units(found: MeasuredBeam, stated: Beam | None) -> Iterator[Remark]:
    if stated is not None and _in_other_units(found, stated):
        ratio = found.length / stated.length
        guess = " (millimetres beside metres?)" if 900 < ratio < 1100 else ""
        yield Remark("fault", "units", f"the length is {found.length:.4g}, {ratio:.4g} times what "
                     f"is stated{guess}: scale one of them")  # fmt: skip
    elif stated is None and found.length > _METRES:
        yield Remark("note", "units", f"a vibrissa of length {found.length:.4g}: if that is in "
                     "millimetres, MuJoCo's gravity and default contacts, in metres and seconds, "
                     "do not fit")  # fmt: skip


def _rest(found: MeasuredBeam, stated: Beam | None) -> Iterator[Remark]:
    wanted = 0.0
    if stated is not None:
        s = np.linspace(0, stated.length, 1001)
        wanted = float(np.trapezoid(stated.curvature_at(s), s)) / stated.length
    if is_curved(found, wanted):
        own, should = (x * found.length for x in (found.natural_curvature, wanted))
        yield Remark("fault", "natural curvature", f"{own:.3g}/L instead of {should:.3g}/L: at "
                     "rest the tip is turned by so much")  # fmt: skip
    if any(found.medium):
        density, viscosity, wind = found.medium
        yield Remark("note", "medium", f"a density of {density:g}, a viscosity of {viscosity:g} "
                     f"and a wind of {wind:g} act on vibrissa and foot, not in theory")  # fmt: skip
    strength = float(np.linalg.norm(found.gravity))
    if strength > 0:
        sag = found.sag / found.length
        kind: Literal["fault", "note"] = "fault" if sag > _SAG else "note"
        yield Remark(kind, "gravity", f"{strength:.3g} bends the vibrissa by {sag:.1e} L at the "
                     "tip; the theory has none")  # fmt: skip


def _plane(found: MeasuredBeam) -> Iterator[Remark]:
    if not found.planar:
        yield Remark(
            "note", "plane", "nothing keeps it in the plane of the sweep: where an object without "
            "friction recedes, it slips off sideways before it would let go"
        )  # fmt: skip


def _foot(found: MeasuredBeam) -> Iterator[Remark]:
    if found.drive is None:
        yield Remark("fault", "foot", f"nothing can move {found.foot!r}: make it a mocap body, or "
                     "give it a slide joint across the vibrissa")  # fmt: skip
    elif "force" in found.drive:
        yield Remark("note", "foot", f"{found.drive}: a position or velocity actuator would hold "
                     "its speed")  # fmt: skip
    elif "mocap" in found.drive:
        yield Remark("note", "foot", "a mocap body has no speed in MuJoCo, so that the dampers of "
                     "contacts do not see it move: on the far side of an object contacts chatter. "
                     "A slide joint with a velocity actuator has one")  # fmt: skip


def _sensors(found: MeasuredBeam) -> Iterator[Remark]:
    for word, sensor in (("force", found.force), ("torque", found.torque)):
        if sensor is None:
            yield Remark("fault", f"{word} sensor", f"none on {found.foot!r} or the vibrissa: add "
                         f"a site at the clamp and <{word} site=.../>")  # fmt: skip
            continue
        if not sensor.feels_contacts:
            yield Remark(
                "fault", f"{word} sensor", f"{sensor.name!r} reads nothing of contacts: MuJoCo "
                "leaves those of a flex out of what its own tree feels. Let the flex hang on a "
                "free body that is welded to the one with the sensors"
            )  # fmt: skip
            continue
        yield from _axes(word, sensor)
        most = _FORCE * found.tip_rigidity / found.length ** (2 if word == "force" else 1)
        if sensor.cutoff < 2 * most:
            yield Remark("fault", f"{word} sensor", f"{sensor.name!r} is cut off at "
                         f"{sensor.cutoff:.3g}; a sweep has up to {2 * most:.2g}")  # fmt: skip
        lever = np.linalg.norm(sensor.lever) / found.length
        if lever > _LEVER:
            yield Remark("fault" if word == "torque" else "note", f"{word} sensor",
                         f"{sensor.name!r} is {lever:.3g} L away from where the vibrissa "
                         "begins" + ("; its moments are counted from there"
                                     if word == "torque" else ""))  # fmt: skip


def _axes(word: str, sensor: Sensed) -> Iterator[Remark]:
    axes = sensor.axes
    if np.abs(axes @ axes.T - np.eye(3)).max() > 1e-2:
        yield Remark("fault", f"{word} sensor", f"{sensor.name!r} does not read the whole {word} "
                     "at the clamp: it is not between foot and vibrissa")  # fmt: skip
        return
    nearest = np.zeros((3, 3))
    for row, column in enumerate(np.argmax(np.abs(axes), axis=1)):
        nearest[row, column] = np.sign(axes[row, column])
    rotation = axes.T @ nearest
    angle = float(np.arccos(np.clip((np.trace(rotation) - 1) / 2, -1, 1)))
    if angle > _ROTATED:
        yield Remark("fault", f"{word} sensor", f"{sensor.name!r} is turned by "
                     f"{np.rad2deg(angle):.2g} degrees against vibrissa and sweep")  # fmt: skip
    if not np.array_equal(nearest, np.eye(3)):
        words = ", ".join(
            f"{'-' if row[k] < 0 else ''}{'xyz'[k]}"
            for row, k in zip(nearest, np.argmax(np.abs(nearest), axis=1), strict=True)
        )
        yield Remark("note", f"{word} sensor", f"its axes x, y, z are {words} of the sweep (y "
                     "along the vibrissa, z along its hinges)")  # fmt: skip


def _contacts(found: MeasuredBeam) -> Iterator[Remark]:
    through = [geom for geom in found.geoms if not geom.meets]
    if through:
        ends = (through[0].start / found.length, through[-1].end / found.length)
        shown = ", ".join(repr(geom.name) for geom in through[:4])
        yield Remark("fault", "contact", f"{len(through)} of {len(found.geoms)} geoms, s = "
                     f"{ends[0]:.2f} to {ends[1]:.2f} L, meet no object of MuJoCo's default "
                     f"contype and conaffinity: {shown}")  # fmt: skip
    for pair in found.self_contacts[:3]:
        yield Remark("fault", "contact", f"{pair} touch before anything moves: exclude the pair")
    meeting = [geom for geom in found.geoms if geom.meets]
    if not meeting:
        return
    softest = min(meeting, key=lambda geom: geom.stiffness)
    sinks = _FORCE * found.tip_rigidity / found.length**3 / softest.stiffness
    if sinks > _SINKS:
        depth = f"{sinks:.1e} L into the object"
        if sinks * found.length > 2 * softest.radius:
            depth = "deeper into the object than the vibrissa is thick, and slips past"
        yield Remark("fault", "contact", f"{_softness(softest, found)} a force of {_FORCE:g} "
                     f"EI/L^2 sinks {depth}")  # fmt: skip
    thickest = max(meeting, key=lambda geom: geom.margin)
    if abs(thickest.margin) > _RADIUS * found.length:
        yield Remark("fault", "contact", f"a margin of {thickest.margin:.3g} pushes before "
                     "anything touches, as if the vibrissa were so much thicker")  # fmt: skip
    rubs = max(geom.friction for geom in meeting)
    if rubs > 0:
        yield Remark("note", "contact", f"friction {rubs:g}; state it in the case, or set "
                     'condim="1"')  # fmt: skip


def _softness(geom: Geom, found: MeasuredBeam) -> str:
    if np.isnan(geom.time_constant):
        return "its stiffness is low:"
    fraction = geom.time_constant / found.period
    return f"solref of {geom.time_constant:g} is {fraction:.2g} of the first period:"


def _steps(found: MeasuredBeam) -> Iterator[Remark]:
    limit = found.stable_step
    if found.integrator in _EXPLICIT and found.timestep > limit:
        yield Remark("fault", "time step", f"{found.timestep:g} is above {limit:.2g}, where "
                     f"{found.integrator} becomes unstable with such springs: shorten it, add "
                     'armature, or take integrator="discrete"')  # fmt: skip
    slower = found.period / found.period_without_armature
    if slower > 1 + _RIGIDITY:
        yield Remark("note", "armature", f"makes the first period {slower:.3g} times as long")
    if found.damping_ratio > 1:
        yield Remark("note", "damping", f"{found.damping_ratio:.2g} times critical: the vibrissa "
                     "lags behind the foot")  # fmt: skip
