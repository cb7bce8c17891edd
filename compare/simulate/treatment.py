"""What to set in a model so that a fault is gone."""

import math
from collections.abc import Iterable

import numpy as np

from analytic.numerics.arrays import Floats
from compare.simulate.remark import HARDEST_RUBBING
from compare.simulate.rigidity import as_intended, flexibility, joint_arms, moving
from mujoco_models.fix.edit import Edit, Insert, number
from mujoco_models.inspect.measured import Geom, MeasuredBeam, Sensed
from mujoco_models.inspect.touching import LEAST_FRICTION

HARD = "0.9999 0.9999 0.001"
"""MuJoCo's largest impedance, of what should not give way."""
_STEPS = 50  # in T1; 100 and 200 do no better at 0.05 L/T1, 25 leave half a per cent
_SAFE = 0.5  # of the longest stable step, which a contact makes shorter
_CONTACT = 4e3  # EI/L^3; of the softest contact
_RUBBING, _SWINGING = 900.0, 0.25  # the same with friction, and its contact's damping ratio
_IMPEDANCE = 0.9  # with 0.99 a quarter of all stations chatter
_DAMPING = 0.05  # ratio
_EVEN = 1e-5  # L
_RIGID_CELL = 0.75  # of a cell; where a first joint is behind it
_RIGID = 2e3  # EI/L and EI/L^3; what gives way by so little moves no reading by 0.5 per cent
_INERTIA = 1e6  # of a carriage, in masses of the vibrissa


def timestep(found: MeasuredBeam) -> float:
    """The longest that is right."""
    most = found.period / _STEPS
    if found.springs == "plugin":  # explicit, whatever the integrator
        most = min(most, _SAFE * found.stable_step)
    wanted = _CONTACT * as_intended(found) / found.length**3
    lightest = max((g.weight for g in moving(found)), default=0.0)
    if lightest:
        most = min(most, 1 / math.sqrt(4 * wanted * (1 - _IMPEDANCE) * lightest))
    if found.hand is not None and found.hand.welds and found.hand.rotation > 0:
        harder = _RIGID * as_intended(found) / found.length * found.hand.rotation
        hardest_now = found.hand.time_constant / 2 / math.sqrt(harder)
        most = min(most, hardest_now if hardest_now < found.timestep else most)
    return min(most, found.timestep) if found.timestep > 0 else most


def steps(found: MeasuredBeam) -> tuple[Edit, ...]:
    return (Edit("option", (("timestep", number(timestep(found))), ("integrator", "discrete"))),)


def hardest(found: MeasuredBeam) -> str:
    """The solref of a constraint that is as hard as the time step allows."""
    return f"{number(2 * timestep(found))} 1"


def touching(found: MeasuredBeam, friction: float) -> tuple[Edit, ...]:
    """Contacts as hard as they should be, or as the time step of `steps` takes.

    Where those would chatter by friction that somebody stated, they swing rather than stop at once,
    and are as soft as they may be.
    """
    solref, step, rubs = hardest(found), timestep(found), 0.0 if friction == 1 else friction
    lightest = max((geom.weight for geom in moving(found)), default=0.0)
    if lightest:
        unit = as_intended(found) / found.length**3
        yields = (1 - _IMPEDANCE) * lightest * unit
        hard, decay = 1 / (4 * step**2 * yields), found.period / (_IMPEDANCE * step)
        if hard > _CONTACT:
            solref = f"{number(1 / math.sqrt(_CONTACT * yields))} 1"
        if rubs**2 * hard * decay > HARDEST_RUBBING:
            solref = f"{number(1 / math.sqrt(_RUBBING * yields) / _SWINGING)} {_SWINGING}"
    solimp = f"{_IMPEDANCE} {_IMPEDANCE} 0.001"
    return contacts(found, solref=solref, solimp=solimp, priority="1")


def frictionless(found: MeasuredBeam) -> tuple[Edit, ...]:
    """Friction that nobody stated goes; what was stated gets a cone that rubs as it should."""
    if max(geom.friction for geom in found.geoms) in (1, LEAST_FRICTION):
        return contacts(found, condim="1")
    return (Edit("option", (("cone", "elliptic"), ("impratio", "100"))),)


def contacts(found: MeasuredBeam, **attributes: str) -> tuple[Edit, ...]:
    """Of all of it that touches."""
    kind = "contact" if found.springs == "flex" else "geom"
    numbers = dict.fromkeys(geom.number for geom in found.geoms)
    return (Edit(kind, tuple(attributes.items()), tuple(numbers)),)


def unseen(*geoms: int) -> Edit:
    """What nothing is to touch."""
    return Edit("geom", (("contype", "0"), ("conaffinity", "0")), geoms)


def apart(found: MeasuredBeam) -> tuple[Edit, ...]:
    """The vibrissa and what moves with its foot touch objects, but not each other."""
    both = (*dict.fromkeys(geom.number for geom in found.geoms), *found.in_the_way)
    return (Edit("geom", (("contype", "0"), ("conaffinity", "1")), both),)


def joints(found: MeasuredBeam, **attributes: str) -> tuple[Edit, ...]:
    numbers = tuple(i for joint in found.joints for i in joint.numbers)
    return () if found.springs == "flex" else (Edit("joint", tuple(attributes.items()), numbers),)


def stiffened(found: MeasuredBeam, stiffness: dict[int, float]) -> tuple[Edit, ...]:
    """Some joints with another stiffness each."""
    if found.springs != "joints":
        return ()
    own = ((f"{k:.6g}", found.joints[i].numbers) for i, k in stiffness.items())
    return _together("joint", "stiffness", own)


def _together(
    kind: str, attribute: str, values: Iterable[tuple[str, tuple[int, ...]]]
) -> tuple[Edit, ...]:
    """An edit for each value, of all that are to have it."""
    alike: dict[str, list[int]] = {}
    for value, numbers in values:
        alike.setdefault(value, []).extend(numbers)
    return tuple(Edit(kind, ((attribute, value),), (*mine,)) for value, mine in alike.items())


def damped(found: MeasuredBeam) -> tuple[Edit, ...]:
    """Dampers in the same proportion, and as weak as they should be."""
    if found.springs == "flex":
        return ()
    weaker = _DAMPING / found.damping_ratio
    own = ((number(weaker * joint.damping), joint.numbers) for joint in found.joints)
    return _together("joint", "damping", own)


def evened(found: MeasuredBeam, off: dict[Geom, float]) -> tuple[Edit, ...]:
    """Geoms as thick as a straight course of radii, if all are round."""
    if not all(geom.size for geom in off):
        return ()
    even = ((geom, geom.radius - by) for geom, by in off.items() if abs(by) > _EVEN * found.length)
    sizes = ((geom, " ".join(f"{x:.5g}" for x in (r, *geom.size[1:]))) for geom, r in even)
    return _together("geom", "size", ((size, (geom.number,)) for geom, size in sizes))


def half_cell(found: MeasuredBeam) -> float:
    """By how much later a vibrissa should begin whose first cell is rigid, and not by a spring."""
    first = found.joints[0].s
    cell = float(np.median(np.diff([joint.s for joint in found.joints])))
    return first - cell / 2 if found.springs != "joints" and first > _RIGID_CELL * cell else 0.0


def beginning_later(found: MeasuredBeam) -> tuple[Edit | Insert, ...]:
    """Sensors in the middle of a rigid first cell, where a beam of its other cells is clamped."""
    sensors = [s for s in (found.force, found.torque) if s is not None]
    if not (sensors and half_cell(found) and sensors[-1].body):
        return ()
    own = sensors[-1]
    at = _place(own.clamp + half_cell(found) * own.along, found.length)
    site = f'<site name="half-cell" pos="{at}" quat="{_text(own.quaternion)}"/>'
    return Insert(site, own.body), _reading("half-cell", *sensors)


def first_softened(found: MeasuredBeam) -> tuple[Edit, ...]:
    """The first joint, such that the tip gives way as it is meant to."""
    stiffness = joint_arms(found)[0] ** 2 / flexibility(found, 0.0, found.joints[0].cell)
    return stiffened(found, {0: float(stiffness)})


def held(found: MeasuredBeam) -> tuple[Edit, ...]:
    """What gives way between drive and clamp, held."""
    hand = found.hand
    if hand is None:
        return ()
    if hand.welds:
        hard = Edit("weld", (("solref", hardest(found)), ("solimp", HARD)), hand.welds)
        return (hard, *steps(found)) if timestep(found) < found.timestep else (hard,)
    rigid = len(hand.numbers) * _RIGID * as_intended(found) / found.length**3
    return tuple(
        Edit(
            "joint",
            (("stiffness", number(rigid * (1 if slides else found.length**2 + arm**2))),),
            (j,),
        )
        for j, slides, arm in zip(hand.numbers, hand.slides, hand.arms, strict=True)
    )


def straightened(sensor: Sensed) -> tuple[Edit, ...]:
    """A sensor's site with its axes along those of the sweep."""
    turned = ("euler", "axisangle", "xyaxes", "zaxis")
    gone = tuple((name, "") for name in turned)
    return (Edit("site", (("quat", _text(sensor.quaternion)), *gone), (sensor.site,)),)


def at_clamp(sensor: Sensed, length: float) -> tuple[Edit, ...]:
    return (Edit("site", (("pos", _place(sensor.clamp, length)),), (sensor.site,)),)


def before_joints(found: MeasuredBeam, sensor: Sensed) -> tuple[Edit | Insert, ...]:
    """A sensor's site on what holds the first joint."""
    if not found.body:
        return ()
    return _site(found, "clamp-site"), _reading("clamp-site", sensor)


def on_light_body(found: MeasuredBeam) -> tuple[Edit | Insert, ...]:
    """The sensors' site on a body without a mass, between foot and vibrissa."""
    sensors = [s for s in (found.force, found.torque) if s is not None]
    if found.springs == "flex" or not found.body:
        return ()
    site = _site(found, "clamp-body-site")
    return _on_body(found, site, "clamp-body"), _reading("clamp-body-site", *sensors)


def _on_body(found: MeasuredBeam, site: Insert, name: str) -> Insert:
    """Each treatment has names of its own: what another one put in stands already."""
    return Insert(site.text, found.leads, name)


def _reading(site: str, *sensors: Sensed) -> Edit:
    return Edit("sensor", (("site", site),), tuple(sensor.number for sensor in sensors))


def with_sensors(found: MeasuredBeam, *words: str) -> tuple[Insert, ...]:
    if not found.body:
        return ()
    names = "".join(f'<{word} name="clamp-{word}" site="clamp-{words[0]}"/>' for word in words)
    site = _site(found, f"clamp-{words[0]}")
    if found.body_mass > found.mass and found.springs != "flex":  # they would feel it
        site = _on_body(found, site, "sensor-body")
    return site, Insert(f"<sensor>{names}</sensor>")


def _site(found: MeasuredBeam, name: str) -> Insert:
    """Where the vibrissa should begin, along the axes of the sweep."""
    place = _place(found.frame[0] + half_cell(found) * found.frame[2], found.length)
    xy = _text(found.frame[1:3].ravel())
    return Insert(f'<site name="{name}" pos="{place}" xyaxes="{xy}"/>', found.body)


def on_rail(found: MeasuredBeam) -> tuple[Insert, ...]:
    """A slide along the sweep, and a motor that keeps its speed."""
    if not found.body:
        return ()
    axis = _text(found.frame[1])
    inertia = _INERTIA * found.mass
    gain, weight = number(inertia / (0.01 * found.period)), number(found.mass)
    moment = number(found.mass * found.length**2)
    inertial = f'<inertial pos="0 0 0" mass="{weight}" diaginertia="{moment} {moment} {moment}"/>'
    rail, slides = "vibrissa-rail", f'type="slide" axis="{axis}" armature="{number(inertia)}"'
    motor = f'<velocity name="vibrissa-motor" joint="{rail}" kv="{gain}"/>'
    return (
        Insert(f'<joint name="{rail}" {slides}/>', found.body),
        *(() if found.body_mass else (Insert(inertial, found.body),)),
        Insert(f"<actuator>{motor}</actuator>"),
    )


def _text(numbers: Floats) -> str:
    """Without what rounding leaves of zeros."""
    return " ".join(f"{x:.9g}" for x in np.round(numbers, 9) + 0.0)


def _place(place: Floats, length: float) -> str:
    """The same of a place on a body."""
    return " ".join(f"{x:.6g}" for x in np.round(place / length, 9) * length + 0.0)
