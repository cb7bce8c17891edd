"""The sweep in motion: steps of MuJoCo's, and its readings in the units of the case."""

import math
import platform
import time
from collections.abc import Callable
from dataclasses import asdict, replace
from importlib.metadata import version
from typing import Any

import mujoco
import numpy as np
import pandas as pd
from threadpoolctl import threadpool_limits

from analytic.problem.case import Case
from analytic.problem.columns import COLUMNS
from analytic.problem.errors import InputError
from analytic.problem.readings import Readings
from mujoco_models.beams.kinds import build
from mujoco_models.beams.layout import bead_spacing
from mujoco_models.beams.vibrissa import Vibrissa
from mujoco_models.dynamics.model import MovingModel
from mujoco_models.dynamics.moving import Moving
from mujoco_models.dynamics.record import Record, Sample
from mujoco_models.errors import DivergedError
from mujoco_models.motion import Motion
from mujoco_models.obstacles.kinds import place
from mujoco_models.quiet import unlogged
from mujoco_models.settings import Settings


def run_motion(
    case: Case,
    motion: Motion,
    settings: Settings,
    advance: Callable[[], None] = lambda: None,
    keep: Callable[[Readings], None] = lambda _: None,
) -> Readings:
    """Sweep the beam to the left; see `mujoco_models.simulate_motion`."""
    model, motion, record, about = _prepared(case, motion, settings)
    return sweep_moving(model, case, motion, record, about, advance, keep)


def run_there_and_back(
    case: Case,
    motion: Motion,
    settings: Settings,
    advance: Callable[[], None] = lambda: None,
    keep: Callable[[Readings], None] = lambda _: None,
) -> tuple[Readings, Readings]:
    """Sweep the beam to the left and back; see `mujoco_models.simulate_there_and_back`."""
    model, motion, record, about = _prepared(case, motion, settings)
    way = _Way(model, case, motion, about)
    on = way.swept(record, way.on, advance, keep)
    way.let_go = on.snap_off is not None
    # As if it went on to the left past the mirrored stations.
    returning = Record(-case.foot_x[::-1] / case.beam.length, motion.average)
    return on, way.swept(returning, way.back, advance, keep, turn_at=way.turn_at)


def _prepared(
    case: Case, motion: Motion, settings: Settings
) -> tuple[MovingModel, Motion, Record, dict[str, Any]]:
    """The model at its start, the motion with the case's friction, and what takes its readings."""
    if motion.friction is None:
        motion = replace(motion, friction=case.friction)
    record = Record(case.foot_x / case.beam.length, motion.average)
    model = _set_out(case, motion, settings, start_of(record, motion))
    about = {"settings": asdict(settings), "source": f"mujoco {settings.beam} in motion"}
    return model, motion, record, about


def start_of(record: Record, motion: Motion) -> float:
    """Where the foot starts, to have its speed on the way to the first station."""
    return record.first + motion.speed * (motion.ramp / 2 + motion.timestep)


def sweep_moving(
    model: Moving,
    case: Case,
    motion: Motion,
    record: Record,
    about: dict[str, Any],
    advance: Callable[[], None],
    keep: Callable[[Readings], None],
) -> Readings:
    """Move a model past all stations."""
    way = _Way(model, case, motion, about)
    return way.swept(record, way.on, advance, keep)


def _set_out(case: Case, motion: Motion, settings: Settings, start: float) -> MovingModel:
    if case.radius == 0:
        raise InputError("beam.radius", 0, "positive for MuJoCo", "it cannot collide a line")
    if settings.beam == "cable" or not settings.planar:
        raise InputError(
            "mujoco.beam" if settings.planar else "mujoco.planar",
            settings.beam if settings.planar else False,
            "a chain or rod in the plane, for a sweep in motion",
            "choose one, or sweep at rest",
        )
    obstacle = place(case, settings)
    spacing = np.inf
    if len(obstacle.corners) == 0:
        thinnest = case.beam.unloaded.tip_radius
        spacing = bead_spacing(settings.segments, thinnest, obstacle.largest_curvature)
    beam = build(settings, spacing, Vibrissa.of(case.beam, case.clamp_stiffness))
    return MovingModel(beam, case.radius, obstacle, motion, start)


class _Way:
    """The foot's way past the stations, and back, and the sensors' filter on it."""

    def __init__(self, model: Moving, case: Case, motion: Motion, about: dict[str, Any]) -> None:
        self._model, self._case, self._motion, self._about = model, case, motion, about
        self._filtered = np.array(model.clamp())
        self.let_go = False  # on the way on
        # The share of the difference that a filter of first order follows in a step.
        self._follows = 1.0
        if motion.cutoff is not None:
            self._follows = -math.expm1(-2 * math.pi * motion.cutoff * motion.timestep)

    @property
    def turn_at(self) -> float:
        """Where the foot is when it has come to a stop, from where it is now [L]."""
        return self._model.foot_x - self._motion.speed * self._motion.ramp / 2

    def on(self, record: Record, advance: Callable[[], None]) -> None:
        """To the left, from a soft start."""
        speed, ramp = self._motion.speed, self._motion.ramp
        begun = self._model.now
        self._drive(
            record,
            1.0,
            lambda now: speed * (min(1.0, (now - begun) / ramp) if ramp > 0 else 1.0),
            advance,
        )

    def back(self, record: Record, advance: Callable[[], None]) -> None:
        """To the right, turning round as softly."""
        speed, ramp = self._motion.speed, self._motion.ramp
        begun = self._model.now
        self._drive(
            record,
            -1.0,
            lambda now: speed * (max(-1.0, 1 - (now - begun) / ramp) if ramp > 0 else -1.0),
            advance,
        )

    def _drive(
        self,
        record: Record,
        facing: float,
        speed_at: Callable[[float], float],
        advance: Callable[[], None],
    ) -> None:
        """Step until the foot has passed all stations, with positions as `facing` has them."""
        model, motion = self._model, self._motion
        touches = facing < 0 and model.touches
        before = Sample(model.time, facing * model.foot_x, self._filtered, touches)
        while not record.complete:
            speed = speed_at(model.now + motion.timestep)
            model.step(speed)
            change = np.array(model.clamp()) - self._filtered
            self._filtered = self._filtered + self._follows * change
            after = Sample(model.time, facing * model.foot_x, self._filtered, model.touches)
            while True:
                if record.crosses(before, after):
                    record.note(before, after, model.state(speed))
                if not record.take(before, after):
                    break
                advance()
            before = after

    def swept(
        self,
        record: Record,
        go: Callable[[Record, Callable[[], None]], None],
        advance: Callable[[], None],
        keep: Callable[[Readings], None],
        turn_at: float | None = None,
    ) -> Readings:
        """The readings of one way; `turn_at` is where that back begins [L]."""
        begun = time.process_time()
        motion = self._motion
        try:
            with threadpool_limits(1), unlogged():
                go(record, advance)
        except BaseException as error:  # whatever it is, what there is must not be lost
            if isinstance(error, DivergedError):
                record.rows.append({"phase": "free", "status": "diverged"})
            if len(record.rows) > 1:
                keep(self._readings(record, begun, turn_at))
            if isinstance(error, DivergedError):
                place_ = f"t = {self._model.time:.6g} T1"
                remedy = (
                    f"shorten the time step ({motion.timestep:g} T1), add armature, "
                    "or soften contacts"
                )
                raise DivergedError(f"diverged at {place_}: {error}; {remedy}") from error
            raise
        return self._readings(record, begun, turn_at)

    def _readings(self, record: Record, begun: float, turn_at: float | None) -> Readings:
        """In the units of the case's beam; the time stays in T1."""
        case, table = self._case, pd.DataFrame(record.rows)
        _mark_lost(table)
        beam = case.beam
        for name in ("force_x", "force_y", "moment_z"):
            unit = beam.moment_unit if name == "moment_z" else beam.force_unit
            table[[name, f"{name}_raw"]] *= unit
        for name in ("contact_arc_length", "contact_x", "contact_y", "penetration"):
            table[name] *= beam.length
        passed = case.foot_x if turn_at is None else case.foot_x[::-1]
        table.insert(0, "foot_x", passed[: len(table)])
        places = {"first_contact": record.first_touch, "snap_off": record.last_touch}
        if turn_at is not None:
            left = None if record.last_touch is None else -record.last_touch
            # Held when the foot turned, it is released where it first touched; else it has passed
            # the object, comes to its other side and lets go there.
            places = {"turn": turn_at, "snap_off": None, "release": left}
            if self.let_go:
                places |= {"snap_off": left, "release": None}
        provenance = {
            **case.provenance(),
            "engine": f"MuJoCo {mujoco.__version__}, "
            f"vibrissa-testbed {version('vibrissa-testbed')}",
            "python": platform.python_version(),
            **{name: value for name, value in self._about.items() if name != "source"},
            "motion": asdict(self._motion),
            "obstacle": self._model.label,
            "seconds": round(time.process_time() - begun, 3),
            "events": {n: None if x is None else x * beam.length for n, x in places.items()},
        }
        extra = [name for name in table if name not in COLUMNS]
        return Readings(table[[*COLUMNS, *extra]], beam, self._about["source"], provenance)


def _mark_lost(table: pd.DataFrame) -> None:
    """Stations without contact between stations with one: it was lost, and found again."""
    touches = np.flatnonzero(table["phase"] != "free")
    if touches.size:
        between = np.zeros(len(table), dtype=bool)
        between[touches[0] : touches[-1]] = True
        lost = between & (table["phase"] == "free") & (table["status"] == "ok")
        table.loc[lost, "status"] = "lost"
