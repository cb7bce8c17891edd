"""What there is to say of a model's foot: its drive, and what lies between that and the clamp."""

import math
from collections.abc import Iterator

from compare.simulate import treatment
from compare.simulate.expected import SPEED
from compare.simulate.remark import FORCE, RIGIDITY, SINKS, Remark
from compare.simulate.rigidity import as_intended, hand_softens
from mujoco_models.fix.edit import Edit, number
from mujoco_models.inspect.ahead import WAY
from mujoco_models.inspect.measured import MeasuredBeam

# rad; by 1 degree readings are 6 % off. Beside it, of what a curved one turns by at its first joint
# a third is between the clamp's tangent and the chord before that joint.
_LEANS, _CHORD = 1e-3, 0.5
_ALONG = 0.99  # cosine, of a slide that goes along the vibrissa
_BEHIND = 0.02  # of the way, or of the speed; a sweep ends so much short
_LEAPS = 0.01  # of the way; by so much a servo leaps as contact ends: by 0.02 it was 0.04 L late
_SLOWED = 0.45  # of its speed; a sweep ends where it is half of its way behind
_LAGS = 0.1  # L; what is farther behind while it gains speed, no sweep waits for
_LATE = 5e-3  # L; of a carriage of 0.33 T1 force_x was 1.3 per cent off, of 0.1 T1 0.4
_PROMPT = 0.2  # T1; of a drive that leaves a heavy foot no time to swing
_TURNS = 1e-4  # relative, in EI; what turns by less is rounding
_PULLS = 100.0  # of a sweep's force; a sensor on a foot that nothing drives feels 1e-4 of it


def on_foot(found: MeasuredBeam) -> Iterator[Remark]:
    """What moves it, and what lies between that and the vibrissa."""
    if found.hand is not None and found.hand.loose:
        yield Remark("fault", "foot", f"what carries {found.foot!r} is free, and nothing holds it",
                     "weld it to a mocap body, or take its free joint away")  # fmt: skip
        return
    yield from _hand(found)
    astray = tuple(_astray(found))
    yield from astray
    yield from _reach(found)
    yield from _carries(found)
    if found.drive is None and found.objects:
        shown = ", ".join(map(repr, found.objects[:4]))
        yield Remark("note", "foot", f"{found.foot!r} stands, and the object moves ({shown})")
    elif found.drive is None and not astray:
        yield Remark("fault", "foot", f"nothing can move {found.foot!r}", "give it a slide joint "
                     "across the vibrissa",
                     treatment.on_rail(found) if found.hand is None else ())  # fmt: skip
    elif found.drive is not None and "which is a force" in found.drive:
        yield Remark("fault", "foot", f"{found.drive}: nothing holds its speed",
                     "take a position or velocity actuator")  # fmt: skip
    elif found.drive is not None and found.drive.startswith("mocap"):  # a weld to one has a speed
        rubs = any(geom.meets and geom.friction for geom in found.geoms)
        said = (
            "friction does not see it move, and holds what should slide" if rubs else
            "the dampers of contacts do not see it move: past an object 6 to 14 of 60 stations "
            "chatter"
        )  # fmt: skip
        yield Remark("fault", "foot", f"a mocap body has no speed in MuJoCo, so that {said}",
                     "give it a slide joint with a velocity actuator",
                     () if found.hand else (Edit("body", (("mocap", ""),), (found.body,)),
                                            *treatment.on_rail(found)))  # fmt: skip


def _hand(found: MeasuredBeam) -> Iterator[Remark]:
    hand, rigidity, length = found.hand, as_intended(found), found.length
    if hand is None:
        return
    gives = FORCE * rigidity / length**3 * hand.displacement
    softer = hand_softens(found)
    if gives > SINKS or softer > RIGIDITY:
        through = ", ".join(map(repr, hand.joints[:4]))
        where = "the weld of " if hand.welds else ""
        spring = f"turns as by a spring of {3 / softer:.2g} EI/L, and " if softer > _TURNS else ""
        yield Remark("fault", "clamp", f"gives way between drive and vibrissa, at {where}{through}"
                     f": it {spring}moves by {gives:.1e} L under {FORCE:g} EI/L^2",
                     "" if hand.welds else "springs hold it, and it no longer moves",
                     treatment.held(found))  # fmt: skip


def _astray(found: MeasuredBeam) -> Iterator[Remark]:
    """A slide that does not go across the vibrissa in the plane in which that bends."""
    if found.rail is None or (found.drive is None and found.objects):
        return
    x, y, z = (abs(float(part)) for part in found.rail.way)
    allowed = _LEANS + _CHORD * abs(found.joints[0].angle)
    for leans, what, remedy in (
        (math.asin(min(y, 1.0)),
         "from across the vibrissa, which nears the object as it goes along",
         "turn the slide's axis, or the vibrissa on its foot"),
        (math.atan2(z, x) if y < _ALONG else 0.0, "out of the plane in which the vibrissa bends",
         "turn the axes of the vibrissa's joints about it, or the slide's"),
    ):  # fmt: skip
        if leans > allowed:
            yield Remark("fault", "foot", f"its slide is {math.degrees(leans):.2g} degrees {what} "
                         f"({found.rail.name!r})", remedy)  # fmt: skip


def _reach(found: MeasuredBeam) -> Iterator[Remark]:
    """What stops a drive before a sweep is over."""
    reach, length = found.reach, found.length
    if reach is None:
        return
    own = () if reach.actuator is None else (reach.actuator,)
    if reach.way < WAY * length:
        yield Remark("fault", "foot", f"its slide ends {reach.way / length:.2g} L to the left, a "
                     f"sweep takes up to {WAY:g} L",
                     edits=(Edit("joint", (("limited", "false"),), (reach.joint,)),))  # fmt: skip
    pull = reach.stiffness * WAY * length
    against = reach.gain * (WAY * length if reach.by_place else SPEED * length / found.period)
    felt = _PULLS * FORCE * as_intended(found) / length**2
    undriven = reach.actuator is None
    if (undriven and pull > felt) or (reach.gain and pull > _BEHIND * against):
        yield Remark("fault", "foot", f"its slide has a spring, {reach.stiffness:.3g}, by a default"
                     " perhaps, which pulls it back",
                     edits=(Edit("joint", (("stiffness", "0"),), (reach.joint,)),))  # fmt: skip
    yield from _dragged(found, against)
    if reach.follows is False:
        yield Remark("fault", "foot", "its actuator has an activation of its own, and does not "
                     "follow what it is given",
                     "take <velocity> or <position> without dyntype")  # fmt: skip
    slow = reach.speed < SPEED * length / found.period
    if slow or reach.placed < WAY * length:
        yield Remark("fault", "foot", "its actuator's ctrlrange ends before a sweep at "
                     f"{SPEED} L/T1 does",
                     edits=(Edit("actuator", (("ctrllimited", "false"),), own),))  # fmt: skip
    speed = SPEED * length / found.period
    drag = reach.damping * speed + reach.friction
    gains = reach.inertia * speed**2 / (2 * _LAGS * length)
    for name, force, edit in (
        ("actuator's forcerange", reach.force, Edit("actuator", (("forcelimited", "false"),), own)),
        ("slide's actuatorfrcrange", reach.joint_force,
         Edit("joint", (("actuatorfrclimited", "false"),), (reach.joint,))),
    ):  # fmt: skip
        if force < max(FORCE * as_intended(found) / length**2 + drag, gains):
            yield Remark("fault", "foot", f"its {name} of {force:.3g} is less than the {FORCE:g} "
                         "EI/L^2 of a sweep, or than it takes to gain speed",
                         edits=(edit,))  # fmt: skip


def _dragged(found: MeasuredBeam, against: float) -> Iterator[Remark]:
    """A slide that stays behind, by its own damper and friction or a sweep's force."""
    reach, speed = found.reach, SPEED * found.length / found.period
    if reach is None or not reach.gain:
        return
    force = FORCE * as_intended(found) / found.length**2
    drag, most = reach.damping * speed + reach.friction, _LEAPS if reach.by_place else _SLOWED
    lost = (drag + force) / (against + (0 if reach.by_place else reach.damping * speed))
    if lost > most:
        free = Edit("joint", (("damping", "0"), ("frictionloss", "0")), (reach.joint,))
        named = "damping and frictionloss of its slide, by a default perhaps,"
        named = named if drag > force else f"{FORCE:g} EI/L^2 of a sweep"
        enough = f"{'kp' if reach.by_place else 'kv'}={reach.gain * lost / most:.2g}"
        yield Remark("fault", "foot", f"{named} hold it back by {min(lost, 1):.0%}",
                     "" if drag > force else f"take {enough}",
                     (free,) if drag > force else ())  # fmt: skip


def _carries(found: MeasuredBeam) -> Iterator[Remark]:
    """A foot that swings or is late: the inertia of what its sensors carry is in the readings."""
    reach, length, rigidity = found.reach, found.length, as_intended(found)
    force, moment = found.unloaded
    felt = max(force * length**2, moment * length) / (FORCE * rigidity)
    carried = max((s.carries for s in (found.force, found.torque) if s is not None), default=0.0)
    remedy, late = "put the sensors on a light body of its own, between foot and vibrissa", 0.0
    if reach is not None and reach.gain:
        turns = 2 * math.pi / (_PROMPT * found.period)
        stiff = f"kp={number(reach.inertia * turns**2)} and " if reach.by_place else ""
        if found.hand is None:
            remedy += f", or take {stiff}kv={number(2 * reach.inertia * turns)}"
        if not reach.by_place:
            late = carried / (reach.gain + reach.damping) / found.period
    if felt > RIGIDITY:
        yield Remark("fault", "foot", f"it does not keep its speed, and its sensors carry a mass of"
                     f" {carried:.3g}: they read {felt:.1%} of a sweep's largest with nothing that "
                     "touches", remedy, treatment.on_light_body(found))  # fmt: skip
    elif SPEED * late > _LATE:
        yield Remark("fault", "foot", f"its actuator holds a mass of {carried:.3g} softly: sensors "
                     f"on it feel contacts {late:.2g} T1 late", remedy,
                     treatment.on_light_body(found))  # fmt: skip
