"""What a user should know of a model that was measured: faults, and notes."""

from collections.abc import Iterator
from typing import Literal

import numpy as np

from analytic import Beam
from analytic.numerics.arrays import Floats
from compare.simulate import treatment
from compare.simulate.course import LEANS, coiled, on_course, on_plane
from compare.simulate.foot import on_foot
from compare.simulate.remark import EXPLICIT, FORCE, RADIUS, RIGIDITY, Remark
from compare.simulate.rigidity import (
    as_intended,
    as_stated,
    at_its_tip,
    by_its_clamp,
    by_its_links,
    elastica_error,
    is_cone,
    radii,
    smooth_rigidity,
    tapers,
    unevenness,
)
from compare.simulate.sensors import is_silent, on_sensors
from compare.simulate.touched import on_contacts
from mujoco_models.fix.edit import Edit
from mujoco_models.inspect.measured import MeasuredBeam
from mujoco_models.inspect.unsolved import STRICT

# Each limit is what moves a reading by about one per cent of its largest magnitude.
_LENGTH = 0.005  # relative; forces go with 1/L^2
_FEW = 4  # joints that are off, each with a line of its own
_JOINT = 0.05  # relative; one of twenty that is so far off moves readings by 0.25 per cent
_SAG = 2e-3  # L; as a contact that is so far off
_WAYS: tuple[tuple[Literal["fault", "note"], str], ...] = (
    ("fault", "as a sweep bends it"),
    ("note", "as a sweep to the right would bend it"),
)
_RUBS = 2e-3  # EI/L; 3e-3 moves readings by 0.7 per cent: joints turn faster than in the mean, too
_ELASTICA = 0.02  # L; a sound chain of ten links is off by 4e-3 at P L^2/EI = 10
# L; where springs stiffen by 10 per cent it is 1.5e-2, and readings are 4 off; where limits hold
# joints, 1.2e-2 and 2.7, 6e-3 and 1.4, 1e-3 and 0.2.
_NONLINEAR = 5e-3
_METRES = 3.0  # a longer vibrissa is rather one in millimetres
# Relative, in a tenth of a sweep (`MeasuredBeam.unsolved`). In all of it, up to 5e-3 cost at most
# 0.4 per cent, 8e-3 to 0.03 from 0.2 to 0.8, 0.13 two, and 0.34 from 5 to 50.
_UNSOLVED = 5e-3
_LONGEST_STEP = 0.05  # T1; leaves about 0.8 per cent
_FIRST = 2 * np.pi / 3.51602  # of a uniform cantilever: T1 over sqrt(m L^3/EI)
_TURNING = 3.0  # times that; all of the mass at the tip makes 2.03
_UNDAMPED = 1e-6  # ratio; a joint of that rings for a hundred thousand periods


def remarks(found: MeasuredBeam, stated: Beam | None = None) -> tuple[Remark, ...]:
    said = [*coiled(found)] or [
        *_stiffness(found),
        *_taper(found, stated),
        *_stated(found, stated),
        *(_surface(found) if stated is None else ()),
        *_units(found, stated),
        *on_course(found, stated),
        *_rest(found),
        *on_plane(found),
        *on_foot(found),
        *on_sensors(found),
        *_flags(found),
        *_steps(found),
        *(() if _in_other_units(found, stated) else _contacts(found)),
    ]
    return tuple(sorted(said, key=lambda remark: remark.kind))


def _stiffness(found: MeasuredBeam) -> Iterator[Remark]:
    rigidity = smooth_rigidity(found)
    own = np.array([joint.flexural_rigidity for joint in found.joints])
    off, later = by_its_clamp(found) / at_its_tip(found) - 1, treatment.half_cell(found)
    if abs(off) > RIGIDITY:
        yield Remark("fault", "clamp", f"bends like EI {abs(off):.1%} "
                     f"{'lower' if off < 0 else 'higher'} than its joints say: "
                     f"{_cause(found, own[0] / rigidity[0])}",
                     f"begin half a cell later: its length is {found.length - later:.4g} then"
                     if later else "",
                     treatment.beginning_later(found) or treatment.first_softened(found)
                     )  # fmt: skip
    coarse = by_its_links(found) / at_its_tip(found) - 1
    if abs(coarse) > RIGIDITY:
        yield Remark("fault", "links", f"too few{' for its taper' if tapers(found) else ''}: the "
                     f"tip gives way like one of EI {abs(coarse):.1%} "
                     f"{'lower' if coarse < 0 else 'higher'}", "take more")  # fmt: skip
    yield from _single_joints(found, own / rigidity - 1)
    error = elastica_error(found)
    if abs(off) <= RIGIDITY and error > _ELASTICA and found.lean <= LEANS:
        yield Remark("fault", "large bending", f"the tip is up to {error:.1e} L off the exact "
                     "cantilever", "take more links")  # fmt: skip
    yield from _beyond_springs(found)
    stretch = found.stretch * FORCE * as_intended(found) / found.length**2
    if stretch > _LENGTH:
        far = f"by {stretch:.1%}" if stretch < 1 else "to more than twice its length"
        hard = Edit(
            "edge", (("solref", treatment.hardest(found)), ("solimp", treatment.HARD)), (0,)
        )
        yield Remark("fault", "edges", f"a pull of {FORCE:g} EI/L^2 stretches one {far}",
                     edits=(hard,))  # fmt: skip
    if found.friction_loss > _RUBS * as_intended(found) / found.length:
        yield Remark("fault", "friction in joints", f"frictionloss holds {found.friction_loss:.3g} "
                     "in each: the vibrissa stays bent",
                     edits=(*treatment.joints(found, frictionloss="0"),))  # fmt: skip


def _taper(found: MeasuredBeam, stated: Beam | None) -> Iterator[Remark]:
    """How EI goes along it, and whether that is how its radius does."""
    if is_cone(found) and not tapers(found):
        return
    (start, end), ends = radii(found), smooth_rigidity(found, np.array([0.0, found.length]))
    said = f"EI goes from {ends[0]:.4g} at the clamp to {ends[1]:.4g} at the tip"
    thinner = f"with radii from {start:.4g} to {end:.4g}"
    meant = stated is not None and np.diff(stated.rigidity_at([0.0, stated.length])) > 0
    if ends[1] > (1 + _JOINT) * ends[0] and end < (1 - _JOINT) * start and not meant:
        yield Remark("fault", "uniformity", f"{said}, {thinner}: it stiffens as it gets thinner",
                     "clamp and tip are changed over in its springs, or in its geoms: turn one "
                     "of them round")  # fmt: skip
        return
    solid = f"; {thinner} one that is solid would have {ends[0] * (end / start) ** 4:.4g} there"
    yield Remark("note", "uniformity", said + ("" if is_cone(found) else f"{solid}, by r^4"))


def _single_joints(found: MeasuredBeam, off: Floats) -> Iterator[Remark]:
    """Joints that are not as their neighbours, and those that are missing between two."""
    missing: dict[str, None] = {}
    usual = np.median([len(joint.rigid) for joint in found.joints])  # each link may have a frame
    odd = (np.flatnonzero(np.abs(off[1:-1]) > _JOINT) + 1).tolist()
    right = {i: 1 / (found.joints[i].compliance * (1 + off[i])) for i in odd}
    if len(odd) > max(_FEW, len(off) / 2):
        worst = max(odd, key=lambda i: abs(off[i]))
        yield Remark("fault", "uniformity", f"{len(odd)} of {len(off)} joints are off a smooth "
                     f"course of EI, that of {found.joints[worst].name!r}, at s = "
                     f"{found.joints[worst].s / found.length:.2f} L, by {abs(off[worst]):.0%}: EI "
                     "steps, or jumps from joint to joint", "give them a smooth course",
                     treatment.stiffened(found, right))  # fmt: skip
        return
    for i in odd:
        joint, stiffer = found.joints[i], off[i] > 0
        rigid = [one.rigid for one in found.joints[i - 1 : i + 1] if len(one.rigid) > usual]
        if stiffer and rigid:
            missing |= dict.fromkeys(sum(rigid, ()))
            continue
        yield Remark("fault", "uniformity", f"the joint of {joint.name!r}, at s = "
                     f"{joint.s / found.length:.2f} L, is {abs(off[i]):.0%} too "
                     f"{'stiff' if stiffer else 'soft'} beside its neighbours",
                     edits=treatment.stiffened(found, {i: right[i]}))  # fmt: skip
    for name in missing:
        yield Remark("fault", "uniformity", f"{name!r} has no joint, and two links are one",
                     "give it one as its neighbours have")  # fmt: skip


def _beyond_springs(found: MeasuredBeam) -> Iterator[Remark]:
    """What a joint has beyond a linear spring."""
    linear = {i: 1 / joint.compliance for i, joint in enumerate(found.joints)}
    for subject, ways, what, remedy, edits in (
        ("limits", found.limits, "those of its joints move",
         "" if found.springs != "flex" else "take their default's range away",
         treatment.joints(found, limited="false")),
        ("large bending", found.stiffening, "its springs are not linear, which moves", "",
         treatment.stiffened(found, linear)),
    ):  # fmt: skip
        for moved, (kind, bends) in zip(ways, _WAYS, strict=True):
            if moved > _NONLINEAR * found.length:
                far = f"by up to {moved / found.length:.1e} L" if moved < np.inf else "without end"
                yield Remark(kind, subject, f"{what} the tip {far} {bends}", remedy, edits)
                break


def _cause(found: MeasuredBeam, first: float) -> str:
    """Why the first joint is not what its cell is."""
    links = np.diff([joint.s for joint in found.joints])
    place = found.joints[0].s / float(np.median(links))
    if place < 0.25:
        return "the hinge at the clamp should stand for half a cell"
    if place > 0.75:
        return "the first link is rigid over a whole cell, half a cell too much"
    if abs(first - 1) > _JOINT:
        return f"the first joint is {first:.2g} times as stiff as its cell"
    return "too few links near it"


def _stated(found: MeasuredBeam, stated: Beam | None) -> Iterator[Remark]:
    if stated is None or _in_other_units(found, stated):
        return
    own, wanted_rigidity = as_intended(found), as_stated(stated)
    scaled = {i: wanted_rigidity / own / joint.compliance for i, joint in enumerate(found.joints)}
    for what, measured, wanted, allowed, edits in (
        ("length", found.length, stated.length, _LENGTH, ()),
        ("EI", own, wanted_rigidity, RIGIDITY, treatment.stiffened(found, scaled)),
    ):
        off = measured / wanted - 1
        if abs(off) > allowed:
            far = f"{abs(off):.1%} {'more' if off > 0 else 'less'} than stated"
            if not 0.1 < off + 1 < 10:
                far = f"{off + 1:.2g} times what is stated: in another unit?"
            yield Remark("fault", what, f"{measured:.6g}, which is {far} ({wanted:.6g})",
                         edits=edits)  # fmt: skip
    middles = np.array([geom.middle for geom in found.geoms])
    wanted_radii = stated.radius_at(np.clip(middles, 0, stated.length))
    radii = np.array([geom.radius for geom in found.geoms])
    worst = int(np.argmax(np.abs(radii - wanted_radii)))
    if abs(radii[worst] - wanted_radii[worst]) > RADIUS * found.length:
        yield Remark("fault", "radius", f"{radii[worst]:.4g} instead of {wanted_radii[worst]:.4g}, "
                     f"at s = {middles[worst] / found.length:.2f} L", "set the radius of its edges"
                     if found.springs == "flex" else "", treatment.evened(found, dict(zip(
                         found.geoms, (radii - wanted_radii).tolist(), strict=True)))
                     )  # fmt: skip


def _surface(found: MeasuredBeam) -> Iterator[Remark]:
    """Whether it is as thick as a cylinder or a cone."""
    off, (start, end) = unevenness(found), radii(found)
    # A piece of one radius is a step of a taper, at its end by so much.
    most = {g: abs(by) + (start - end) * (g.end - g.start) / 2 / found.length
            for g, by in off.items()}  # fmt: skip
    worst = max(most, key=most.__getitem__, default=found.geoms[0])
    step = most.get(worst, 0.0) / found.length
    if step > RADIUS:
        yield Remark("fault", "radius", f"{worst.name!r} is up to {step:.1e} L "
                     f"{'thinner' if off[worst] < 0 else 'thicker'} than a straight course from "
                     f"{start:.4g} to {end:.4g}: what touches it feels steps",
                     "give all geoms one radius, or a straight taper", treatment.evened(found, off)
                     )  # fmt: skip


def _in_other_units(found: MeasuredBeam, stated: Beam | None) -> bool:
    return stated is not None and not 0.1 < found.length / stated.length < 10


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


def _rest(found: MeasuredBeam) -> Iterator[Remark]:
    if any(found.medium):
        density, viscosity, wind = found.medium
        yield Remark("note", "medium", f"a density of {density:g}, a viscosity of {viscosity:g} "
                     f"and a wind of {wind:g} act on vibrissa and foot, not in theory")  # fmt: skip
    strength = float(np.linalg.norm(found.gravity))
    sag, weight = found.sag / found.length, found.weight * found.length**2 / as_intended(found)
    said = []
    if sag > _SAG:
        said.append(f"bends the vibrissa by {sag:.1e} L at the tip")
    if weight > RIGIDITY * FORCE and not (found.force is None or is_silent(found.force)):
        said.append(f"puts {weight:.2g} EI/L^2 on the force sensor before anything touches")
    if said:
        yield Remark("fault", "gravity", f"{strength:.3g} {' and '.join(said)}",
                     "switch it off: a model of your own is compared without",
                     edits=(Edit("option", (("gravity", "0 0 0"),)),))  # fmt: skip


def _flags(found: MeasuredBeam) -> Iterator[Remark]:
    if found.switched:
        named = ", ".join(name for name, _ in found.switched)
        yield Remark("fault", "flags", f"<flag> switches {named}: contacts, springs, sensors or "
                     "drives are not what the model states",
                     edits=(Edit("flag", found.switched, (0,)),))  # fmt: skip


def _steps(found: MeasuredBeam) -> Iterator[Remark]:
    limit = found.stable_step
    explicit = found.integrator in EXPLICIT or found.springs == "plugin"
    fraction = found.timestep / found.period
    if found.timestep <= 0:
        yield Remark("fault", "time step", f"{found.timestep:g}: nothing ever moves",
                     edits=treatment.steps(found))  # fmt: skip
    elif explicit and found.timestep > limit:
        yield Remark("fault", "time step", f"{found.timestep:g} is above {limit:.2g}, where "
                     f"{found.integrator} becomes unstable with such springs",
                     "shorten it, add armature, or take integrator=\"discrete\"",
                     treatment.steps(found))  # fmt: skip
    elif fraction > _LONGEST_STEP:
        yield Remark("fault", "time step", f"{found.timestep:g} is {fraction:.2g} of the first "
                     "period: steps leap over what the vibrissa does",
                     edits=treatment.steps(found))  # fmt: skip
    of_its_mass = _FIRST * np.sqrt(found.mass * found.length**3 / found.tip_rigidity)
    turning = found.period_without_armature / of_its_mass
    if turning > _TURNING:
        yield Remark("fault", "inertia", f"the first period is {turning:.2g} times that of a beam "
                     "of this mass: the links are far too hard to turn", "leave out <inertial>, or "
                     "give each link the inertia of its shape")  # fmt: skip
    slower = found.period / found.period_without_armature
    if slower > 1 + RIGIDITY:
        yield Remark("note", "armature", f"makes the first period {slower:.3g} times as long")
    if found.damping_ratio > 1:
        yield Remark("fault", "damping", f"{found.damping_ratio:.2g} times critical: the vibrissa "
                     "lags behind the foot", edits=treatment.damped(found))  # fmt: skip
    elif found.damping_ratio < _UNDAMPED:
        yield Remark("note", "damping", "no dampers: what a contact or its release sets swinging "
                     f"swings on{'' if explicit else ', but for what steps take away'}"
                     )  # fmt: skip


def _contacts(found: MeasuredBeam) -> Iterator[Remark]:
    """What touches, and if that is as it should be, whether MuJoCo's solver makes it hold."""
    said = tuple(on_contacts(found))
    yield from said
    if found.unsolved > _UNSOLVED and not any(remark.kind == "fault" for remark in said):
        off = f"off by {found.unsolved:.1%}" if found.unsolved < np.inf else "without bounds"
        yield Remark("fault", "solver", "stops before contacts hold: past an object readings are "
                     f"{off}, of what they are where it goes on to the end",
                     edits=(Edit("option", STRICT),))  # fmt: skip
