"""What there is to say of a model's sensors: whether they read what the clamp does, and in what."""

from collections.abc import Iterator
from functools import partial

import numpy as np
from scipy.spatial.transform import Rotation

from compare.simulate import treatment
from compare.simulate.expected import SPEED
from compare.simulate.remark import FORCE, Remark
from compare.simulate.rigidity import as_intended
from mujoco_models.fix.edit import Edit
from mujoco_models.inspect.measured import MeasuredBeam, Sensed, nearest_axes

# Each limit is what moves a reading by about one per cent of its largest magnitude.
_ROTATED = np.deg2rad(0.5)  # rad; 0.9 per cent of one force is read as the other
# Of a curved one's turn at its first joint: between the clamp's tangent and the chord before that
# joint, of half a cell, is a quarter of it.
_CHORD = 0.3
_LEVER = 5e-3  # L; of the force's moment
_LATE = 5e-3  # L; of the foot, as 0.1 T1 at 0.05 L/T1
_READS = 0.01  # of a load, by the sensor that should read all of it


def on_sensors(found: MeasuredBeam) -> Iterator[Remark]:
    sensors = {"force": found.force, "torque": found.torque}
    missing = [word for word, sensor in sensors.items() if sensor is None]
    for word, sensor in sensors.items():
        if sensor is not None:
            yield from _on(found, word, sensor)
            continue
        edits = treatment.with_sensors(found, *missing) if word == missing[0] else ()
        yield Remark("fault", f"{word} sensor", f"none on {found.foot!r} or the vibrissa",
                     f"add a site at the clamp and <{word} site=.../>", edits)  # fmt: skip
    with_foot = {one: _hinges_turned(found, one) for one in sensors.values() if one is not None}
    turned = max(with_foot.values(), default=0.0)
    if turned and found.rail is None:
        both = (edit for one in with_foot for edit in treatment.straightened(one))
        yield Remark("fault", "plane", f"its hinges are turned by {np.rad2deg(turned):.2g} degrees "
                     "about it, against foot and sensors", "turn the axes of its joints, or, if "
                     "they are meant so, the sensors", tuple(both))  # fmt: skip


def is_silent(sensor: Sensed) -> bool:
    return bool(np.abs(sensor.axes).max() < _READS)


def _on(found: MeasuredBeam, word: str, sensor: Sensed) -> Iterator[Remark]:
    """Only the first that makes it useless; else all."""
    fault, name = partial(Remark, "fault", f"{word} sensor"), repr(sensor.name)
    if not sensor.feels_contacts:
        yield fault(
            f"{name} reads nothing of contacts: MuJoCo leaves those of a flex out of what its own "
            "tree feels. Let the flex hang on a free body that is welded to the one with the "
            "sensors"
        )
    elif is_silent(sensor):
        cause, remedy = (
            ("MuJoCo leaves the weld that holds its free body out of what it feels",
             "let a body of its own, in the free one, hold the first joint and the site, or "
             "hold the free one by a slide with a velocity actuator")
            if sensor.free else
            ("it is not between foot and vibrissa", "put its site there")
        )  # fmt: skip
        yield fault(f"{name} reads nothing of a load on the tip: {cause}", remedy)
    elif sensor.bends:
        yield fault(f"{name} is on a link, and turns with it as the vibrissa bends",
                    "put its site on the body that holds the first joint",
                    treatment.before_joints(found, sensor))  # fmt: skip
    else:
        yield from _axes(word, sensor, found)
        most = FORCE * as_intended(found) / found.length ** (2 if word == "force" else 1)
        if sensor.cutoff < 2 * most:
            yield fault(f"{name} is cut off at {sensor.cutoff:.3g}; a sweep has up to "
                        f"{2 * most:.2g}", edits=_with(sensor, cutoff="0"))  # fmt: skip
        if SPEED * sensor.late > _LATE * found.period:
            far = SPEED * sensor.late / found.period
            yield fault(f"{name} reads up to {sensor.late:.3g} late, as far as the foot goes "
                        f"{far:.2g} L", edits=_with(sensor, delay="0", interval="0")
                        )  # fmt: skip
        lever = np.linalg.norm(sensor.lever) / found.length
        if lever > _LEVER:
            counts = word == "torque"
            yield Remark("fault" if counts else "note", f"{word} sensor", f"{name} is {lever:.3g} "
                         "L away from where the vibrissa begins" + (
                             "; its moments are counted from there" if counts else ""
                         ), edits=treatment.at_clamp(sensor, found.length))  # fmt: skip


def _with(sensor: Sensed, **attributes: str) -> tuple[Edit, ...]:
    return (Edit("sensor", tuple(attributes.items()), (sensor.number,)),)


def _axes(word: str, sensor: Sensed, found: MeasuredBeam) -> Iterator[Remark]:
    axes, fault = sensor.axes, partial(Remark, "fault", f"{word} sensor")
    if np.abs(axes @ axes.T - np.eye(3)).max() > 1e-2:
        yield fault(f"{sensor.name!r} does not read the whole {word} at the clamp: it is not "
                    "between foot and vibrissa")  # fmt: skip
        return
    nearest = nearest_axes(axes)
    turn = Rotation.from_matrix(nearest.T @ axes).as_rotvec()
    least, most = sorted((0.0, _CHORD * found.joints[0].angle))
    turn[2] -= np.clip(turn[2], least, most)
    angle = float(np.linalg.norm(turn))
    if angle > _ROTATED and not _hinges_turned(found, sensor):
        yield fault(f"{sensor.name!r} is turned by {np.rad2deg(angle):.2g} degrees against "
                    "vibrissa and sweep", edits=treatment.straightened(sensor))  # fmt: skip
    if not np.array_equal(nearest, np.eye(3)):
        words = ", ".join(
            f"{'-' if row[k] < 0 else ''}{'xyz'[k]}"
            for row, k in zip(nearest, np.argmax(np.abs(nearest), axis=1), strict=True)
        )
        yield Remark("note", f"{word} sensor", f"its axes x, y, z are {words} of the sweep (y "
                     "along the vibrissa, z along its hinges)")  # fmt: skip


def _hinges_turned(found: MeasuredBeam, sensor: Sensed) -> float:
    """By how much they are about the vibrissa, against a sensor that is as rail or foot [rad]."""
    ways = found.frame[1:].T if found.rail is None else found.rail.way[None]
    way = ways[np.argmax(np.abs(ways[:, 0]))]
    off = float(np.arctan2(abs(way[2]), abs(way[0])))
    as_it = (np.abs(sensor.axes @ one).max() > np.cos(_ROTATED) for one in (way, (0.0, 1.0, 0.0)))
    return off if off > _ROTATED and all(as_it) else 0.0
