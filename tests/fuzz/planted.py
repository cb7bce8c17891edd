"""Mistakes that are planted, and the words that should name each."""

from dataclasses import dataclass, field, replace

import numpy as np

from analytic import Sweep, solve_sweep, with_friction
from tests.fuzz.acts import (
    Sensor,
    Swept,
    about_the_tip,
    another,
    beam_off,
    block_again,
    both,
    clipped,
    crosstalk,
    cubic,
    displaced,
    drifting,
    each,
    either,
    ended,
    exchanged,
    far,
    gain,
    held,
    held_on,
    humming,
    jittering,
    largest,
    late,
    later,
    lost,
    loud,
    on,
    one,
    raised,
    repeated,
    rigid_first_half,
    rows,
    sized,
    softer_and_rubbing,
    spiked,
    standing,
    stepped,
    times,
    turned,
    with_own_error,
    zero,
)

SOFT = 8.0  # EI/L; a clamp that is known to give way


@dataclass(frozen=True)
class Mistake:
    """What is planted, and the words that name it, apart by "&"; none where nothing should be.

    What need not be named has `must` False.
    `swept` is a sweep that is wrong itself, `sensed` what the sensor makes of it before its noise,
    and `recorded` what the file makes of that. `stated` is what the case says of the support.
    """

    named: str | None
    swept: Swept | None = None
    sensed: Sensor | None = None
    recorded: Sensor | None = None
    must: bool = True
    stated: dict[str, float] = field(default_factory=dict)


_OFFSET = on("foot_x", lambda v, rng: v + either(rng, 0.01, 0.03))
# A stage that counts its way the other way, from an origin of its own or the world's.
_BACKWARDS = on("foot_x", lambda v, rng: rng.choice([0.0, rng.uniform(-0.5, 0.5)]) - v)
MISTAKES: dict[str, Mistake] = {
    "flexural rigidity": Mistake("flexural rigidity", beam_off("flexural_rigidity", 0.03, 0.3)),
    "length": Mistake("length of the vibrissa", beam_off("length", 0.01, 0.03)),
    "radius": Mistake("radius of the vibrissa", beam_off("radius", 1.5, 5, sign=False)),
    "soft clamp": Mistake("clamp stiffness", held(clamp_stiffness=(5.0, 50.0))),
    "clamp stiffness": Mistake(
        "clamp stiffness",
        lambda case, rng: solve_sweep(
            replace(case, clamp_stiffness=SOFT * (1 + either(rng, 0.1, 0.3)))
        ),
        stated={"clamp_stiffness": SOFT},
    ),
    "friction": Mistake("friction", held(friction=(0.05, 0.2))),
    "friction stated": Mistake("friction", held(friction=(0.3, 0.5)), stated={"friction": 0.2}),
    "friction along the motion": Mistake(
        "friction of the wrong sign",
        lambda case, rng: with_friction(replace(case, friction=0.0), -case.friction),
        stated={"friction": 0.2},
    ),
    "natural curvature": Mistake(
        "natural curvature",
        lambda case, rng: another(case, 0.3, natural_curvature=either(rng, 0.05, 0.4)),
    ),
    "taper": Mistake(
        "tip radius",
        lambda case, rng: another(
            case, 0.3, tip_radius=float(rng.uniform(0.5, 0.95)) * case.beam.radius
        ),
    ),
    "offset of the stage": Mistake("foot_x", sensed=_OFFSET),
    "gain": Mistake("gain of", sensed=one(gain(0.05, 0.3))),
    "zero": Mistake("zero of", sensed=one(zero)),
    "gravity": Mistake("constant load", sensed=each(zero)),
    "drift": Mistake("drift of", sensed=one(drifting)),
    "axes swapped": Mistake("force_x and force_y swapped", sensed=exchanged("force_x", "force_y")),
    "one sign": Mistake("opposite sign of", sensed=one(lambda v, rng: -v)),
    "all signs": Mistake(
        "all three readings have the opposite sign", sensed=each(lambda v, rng: -v)
    ),
    "sensor turned": Mistake("sensor turned by", sensed=turned),
    "sensor displaced": Mistake("along the vibrissa off the clamp", sensed=displaced),
    "unit of one": Mistake(
        "in another unit",
        sensed=one(lambda v, rng: v * rng.choice([1000.0, 0.001, 9.80665, 1 / 9.80665])),
    ),
    "unit of all": Mistake(
        "all readings in another unit",
        sensed=times(lambda rng: rng.choice([1000.0, 9.80665, 1 / 9.80665])),
    ),
    "length of a cell forgotten": Mistake(
        "all readings are 1/ & links", sensed=times(lambda rng: 1 / rng.integers(11, 90))
    ),
    "all far off": Mistake("all readings are & the reference's: EI", sensed=times(far)),
    "one far off": Mistake(
        " is & the reference's: a gain", sensed=one(lambda v, rng: v * far(rng))
    ),
    "dead channel": Mistake("dead channel", sensed=one(lambda v, rng: 0 * v)),
    "opposite direction": Mistake(
        "opposite direction of travel",
        lambda case, rng: solve_sweep(
            replace(case, sweep=Sweep(case.sweep.stations, direction="right"))
        ),
    ),
    "reversed rows": Mistake("rows reversed", recorded=rows(lambda n, rng: np.arange(n)[::-1])),
    "foot_x backwards": Mistake("foot_x counts the other way", recorded=_BACKWARDS),
    "shuffled rows": Mistake("rows out of order", recorded=rows(lambda n, rng: rng.permutation(n))),
    "repeated rows": Mistake("repeat a row before", recorded=rows(repeated)),
    "block of rows again": Mistake("repeat a row before", recorded=rows(block_again)),
    "gap": Mistake("lack a number", recorded=lost(np.nan)),
    "dropout": Mistake("filled with zeros", recorded=lost(0.0)),
    "spikes": Mistake("single stations", recorded=one(spiked)),
    "saturation": Mistake("cut off at the extreme", recorded=one(clipped)),
    "no contact": Mistake("never touches", recorded=each(lambda v, rng: 0 * v)),
    "noise": Mistake("noise: differences jump", sensed=loud),
    "two at once": Mistake(
        "gain of force_x & zero of moment_z",
        sensed=both(
            on("force_x", lambda v, rng: 1.08 * v),
            on("moment_z", lambda v, rng: v + 0.06 * largest(v)),
        ),
    ),
    "exchanged with the moment": Mistake(
        "and moment_z swapped",
        sensed=lambda sweep, rng: exchanged(str(rng.choice(["force_x", "force_y"])), "moment_z")(
            sweep, rng
        ),
    ),
    "delay of one": Mistake("lags", sensed=one(lambda v, rng: later(v, rng.uniform(2, 6)))),
    "delay of all": Mistake("or a lag", sensed=late),
    "drift of all": Mistake("drift of all", sensed=each(drifting)),
    "gain and zero": Mistake(
        "gain of & zero of", sensed=one(lambda v, rng: zero(gain(0.05, 0.3)(v, rng), rng))
    ),
    "cubic": Mistake("cubic", sensed=one(cubic)),
    "crosstalk": Mistake("crosstalk", sensed=crosstalk),
    "hum": Mistake("hum", sensed=humming),
    "steps": Mistake("quantised", recorded=one(stepped)),
    "jitter of the foot": Mistake("jitter", sensed=jittering),
    "scale of the stage": Mistake("scale of the stage", sensed=on("foot_x", gain(0.01, 0.04))),
    "object raised": Mistake("height of the object", raised),
    "object size": Mistake("size of the object", sized),
    "contact ends early": Mistake("ends early", recorded=ended),
    "contact ends late": Mistake("ends late", recorded=held_on(0.0, 0.02)),
    "contact does not end": Mistake("does not end", recorded=held_on(1.0, 1.0)),
    "readings stand still": Mistake("stand still", recorded=standing),
    "moment about the tip": Mistake("along the vibrissa off the clamp", sensed=about_the_tip),
    "whole first cell": Mistake(
        "half a cell",
        lambda case, rng: solve_sweep(
            replace(case, clamp_stiffness=2.0 * float(rng.integers(10, 41)))
        ),
    ),
    "rigid first half cell": Mistake("rigid over its first", rigid_first_half),
    "rigidity and friction": Mistake("flexural rigidity & friction", softer_and_rubbing),
    "soft clamp and offset": Mistake(
        "clamp stiffness & foot_x", held(clamp_stiffness=(5.0, 20.0)), sensed=_OFFSET
    ),
    "gain and drift": Mistake(
        "gain of force_y & drift of moment_z",
        sensed=both(on("force_y", gain(0.05, 0.3)), on("moment_z", drifting)),
    ),
    "sign and zero": Mistake(
        "opposite sign of force_x & zero of force_y",
        sensed=both(on("force_x", lambda v, rng: -v), on("force_y", zero)),
    ),
    "swap and rigidity": Mistake(
        "swapped & flexural rigidity",
        beam_off("flexural_rigidity", 0.05, 0.3),
        exchanged("force_x", "force_y"),
    ),
    "a coarse model": Mistake(
        None,
        sensed=lambda sweep, rng: with_own_error(sweep, rng, rng.uniform(0.01, 0.03)),
        must=False,
    ),
}
