"""The sweep in motion: steps of MuJoCo's, and its readings in the units of the case."""

import math
from collections.abc import Callable, Mapping
from dataclasses import asdict, replace
from typing import Any

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.problem.case import Case
from analytic.problem.columns import CLAMP_READINGS
from analytic.problem.errors import InputError
from analytic.problem.readings import Readings
from analytic.problem.recorder import DIVERGED, AnyRecorder, Kept, Recorder
from mujoco_models.dynamics.model import MovingModel
from mujoco_models.dynamics.moving import SteppedModel
from mujoco_models.dynamics.record import StationMeans, Step
from mujoco_models.errors import DivergedError
from mujoco_models.model.parts import parts
from mujoco_models.model.stations import engine
from mujoco_models.motion import Motion
from mujoco_models.quiet import unlogged
from mujoco_models.settings import Settings

_MOST_STEPS = 2e7  # some ten minutes


def run_motion(
    case: Case,
    motion: Motion,
    settings: Settings,
    advance: Callable[[], None] = lambda: None,
    keep: Callable[[Readings], None] = lambda _: None,
) -> Readings:
    """Sweep the beam to the left; see `mujoco_models.simulate_motion`."""
    passes, record = _prepared(case, motion, settings)
    return passes.swept(record, advance, keep)


def run_there_and_back(
    case: Case,
    motion: Motion,
    settings: Settings,
    advance: Callable[[], None] = lambda: None,
    keep: Callable[[Readings], None] = lambda _: None,
) -> tuple[Readings, Readings]:
    """Sweep the beam to the left and back; see `mujoco_models.simulate_there_and_back`."""
    passes, record = _prepared(case, motion, settings)
    on = passes.swept(record, advance, keep)
    # As if it went on to the left past the mirrored stations.
    returning = StationMeans(-case.way[::-1], motion.average)
    return on, passes.swept(returning, advance, keep, back=True)


def _prepared(case: Case, motion: Motion, settings: Settings) -> tuple["Passes", StationMeans]:
    """The model at its start, with the case's friction, and what takes its readings."""
    motion, record = on_way(case.way, motion, case.friction)
    model = _set_out(case, motion, settings, start_of(record, motion))
    source, about = f"mujoco {settings.beam} in motion", {"settings": asdict(settings)}
    return Passes(model, case, motion, source, about), record


def on_way(
    way: Floats, motion: Motion, friction: float, names: tuple[str, ...] = CLAMP_READINGS
) -> tuple[Motion, StationMeans]:
    """The motion with a case's friction if it states none, and what takes the readings on a way."""
    if motion.friction is None:
        motion = replace(motion, friction=friction)
    steps = float(np.ptp(way)) / motion.speed / motion.timestep
    if steps > _MOST_STEPS:
        raise InputError(
            "motion.speed",
            motion.speed,
            f"fast enough for a sweep of {_MOST_STEPS:.0e} steps, not {steps:.1e}",
            "0.004 L/T1 is a slow whisk; a sweep at rest has no speed",
        )
    return motion, StationMeans(way, motion.average, names)


def start_of(record: StationMeans, motion: Motion) -> float:
    """Where on its way the clamp starts, to have its speed on the way to the first station."""
    return record.first + motion.speed * (motion.ramp / 2 + motion.timestep)


def _set_out(case: Case, motion: Motion, settings: Settings, start: float) -> MovingModel:
    if settings.beam == "cable" or not settings.planar:
        raise InputError(
            "mujoco.beam" if settings.planar else "mujoco.planar",
            settings.beam if settings.planar else False,
            "a chain or rod in the plane, for a sweep in motion",
            "choose one, or sweep at rest",
        )
    beam, obstacles = parts(case, settings)
    return MovingModel(beam, obstacles, motion, case, start)


class Drive:
    """Steps of a clamp that passes stations, and the sensors' filter in them."""

    def __init__(self, model: SteppedModel, motion: Motion) -> None:
        self._model, self._motion = model, motion
        self._filtered = np.array(model.clamp())
        # The share of the difference that a filter of first order follows in a step.
        self._follows = 1.0
        if motion.cutoff is not None:
            self._follows = -math.expm1(-2 * math.pi * motion.cutoff * motion.timestep)

    def recorded(
        self,
        recorder: AnyRecorder[Kept],
        record: StationMeans,
        advance: Callable[[], None],
        keep: Callable[[Kept], None],
        back: bool = False,
    ) -> Kept:
        """The readings of all stations, whose rows the recorder shares with the record."""
        with recorder.rescued(keep), unlogged():
            try:
                self._drive(record, back, advance)
            except DivergedError as error:
                record.rows.append(DIVERGED)
                raise DivergedError(
                    f"diverged at t = {self._model.time:.6g} T1: {error}; shorten the time step "
                    f"({self._motion.timestep:g} T1), add armature, or soften contacts"
                ) from error
        return recorder.readings()

    def _drive(self, record: StationMeans, back: bool, advance: Callable[[], None]) -> None:
        """Step until the foot has passed all stations; it starts, or turns round, softly.

        On its way back all is as if it went on to the left, at positions of the other sign.
        """
        model, motion, begun = self._model, self._motion, self._model.now
        facing, touches = (-1.0, model.touches) if back else (1.0, False)
        before = Step(model.time, facing * model.p, self._filtered, touches)
        while not record.complete:
            passed = model.now + motion.timestep - begun
            ramps = passed / motion.ramp if motion.ramp > 0 else math.inf
            speed = motion.speed * (max(-1.0, 1 - ramps) if back else min(1.0, ramps))
            model.step(speed)
            change = np.array(model.clamp()) - self._filtered
            self._filtered = self._filtered + self._follows * change
            place = facing * model.p
            after = Step(model.time, place, self._filtered, model.touches, model.touches_twice)
            while True:
                if record.crosses(before, after):
                    record.note(before, after, model.state(speed))
                if not record.take(before, after):
                    break
                advance()
            before = after


class Passes(Drive):
    """Passes of the foot by the stations, on and back."""

    def __init__(
        self,
        model: SteppedModel,
        case: Case,
        motion: Motion,
        source: str,
        about: Mapping[str, Any],
    ) -> None:
        super().__init__(model, motion)
        self._case, self._source, self._about = case, source, about
        self._let_go = False  # on the way on

    def swept(
        self,
        record: StationMeans,
        advance: Callable[[], None],
        keep: Callable[[Readings], None],
        back: bool = False,
    ) -> Readings:
        case, motion = self._case, self._motion
        turn_at = self._model.p - motion.speed * motion.ramp / 2 if back else None
        about = {
            "engine": engine(),
            **self._about,
            "motion": asdict(motion),
            "obstacle": self._model.label,
        }
        recorder = Recorder(
            case,
            self._source,
            about,
            lambda: self._events(record, turn_at),
            record.rows,
            back=back,
        )
        readings = self.recorded(recorder, record, advance, keep, back)
        self._let_go = record.contact.last is not None
        return readings

    def _events(self, record: StationMeans, turn_at: float | None) -> dict[str, float | None]:
        """Parameters of the way at what has happened so far, by name; `turn_at` on the way back."""
        last = record.contact.last
        if turn_at is None:
            first = record.contact.first
            return {"first_contact": first, "snap_off": last, **record.second_contact()}
        left = None if last is None else -last
        # Held when the foot turned, it is released where it first touched; else it has passed
        # the object, comes to its other side and lets go there.
        snap_off, release = (left, None) if self._let_go else (None, left)
        return {"turn": turn_at, "snap_off": snap_off, "release": release}
