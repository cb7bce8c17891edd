"""The sweep of a beam that may leave the plane, which the obstacle does not hold sideways.

Newton's method follows the branch of planar equilibria; by symmetry they are equilibria in space
too. At every station MuJoCo's own forces show whether the beam would return to the plane. Where it
would not, it is nudged, and MuJoCo's own motion carries it to wherever it comes to rest.
"""

from typing import Any, NamedTuple

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.problem.case import Case
from mujoco_models.model.model import AT_REST, LONG_STEP, STEP, BeamModel
from mujoco_models.sweep.numerics import Numerics
from mujoco_models.sweep.out_of_plane import Sideways, sideways
from mujoco_models.sweep.state import State, turned
from mujoco_models.sweep.walk import Walk

_ONSET = 1e-4  # L; how closely the place where the beam leaves is located
_NUDGES = (1e-4, 1e-3, 1e-2, 1e-1)  # L, across the plane
# Of MuJoCo's motion across the plane. In steps of 5e-3 the contact chatters once the beam is nudged
# by 1e-3 L or more, and beams seem to leave that are held.
GENTLE_STEP = 2e-3
_TRIAL = 25  # steps of MuJoCo's motion, for the beam to settle into its mode, then for it to grow
_STEPS = 20_000  # of that motion at one station; a beam still on its way then goes on at the next
_LAST_STEPS = 300  # short ones, since contacts are softer in long steps than they are at rest
_IN_PLANE = 1e-5  # L; a nudged beam that is nearer than this has come back to the plane


class _Departure(NamedTuple):
    """A beam that was nudged out of its plane: where, from which angles, and how fast it moves."""

    p: float
    angles: Floats
    timestep: float


class SpatialWalk(Walk[BeamModel]):
    """A walk that leaves the plane where the planar equilibrium is not stable in space."""

    def __init__(
        self, model: BeamModel, case: Case, tolerance: float, numerics: Numerics | None = None
    ) -> None:
        super().__init__(model, case, tolerance, numerics)
        self.left_plane: float | None = None
        self._held: Sideways | None = None
        self._departure: _Departure | None = None

    @property
    def events(self) -> dict[str, float | None]:
        """Parameters of the clamp's way at which things happened."""
        return {"out_of_plane": self.left_plane, **super().events}

    def go_to(self, target: float) -> None:
        """Follow the planar branch to `target` as long as the beam would keep to its plane."""
        if self._departure is not None:
            self._drift(target, self._departure)
            return
        start = self._p, self._state
        if self._is_held_at(target):
            return
        onset = self._locate(start, target)
        self._resume(start)
        if self._is_held_at(target) or self._held is None:
            return
        leaves = self._leaves(self._held.softest(self.model.model.nv))
        if leaves and self.left_plane is None:
            self.left_plane = onset
        step = LONG_STEP if leaves else GENTLE_STEP
        self._drift(target, _Departure(onset, self._state.angles, step))

    def row(self) -> dict[str, Any]:
        """The readings, how far the beam is out of the plane, and how stiffly it is held there."""
        self.model.relieved()
        row = super().row()
        row["residual"] = float(np.abs(self.model.moments()).max())
        if row["status"] == "ok" and row["residual"] > self._tolerance:
            row["status"] = "unsettled"
        row["out_of_plane"] = self.model.out_of_plane()
        row["sideways_stiffness"] = np.nan if self._held is None else self._held.stiffness
        return row

    def _is_held_at(self, target: float) -> bool:
        """Go to `target` in the plane; whether the beam is free there, or returns to the plane."""
        super().go_to(target)
        self._look()
        return self._held is None or self._held.stable

    def _look(self) -> None:
        """See how stiffly the beam is held in the plane, if it touches and rests there."""
        resting = self._shown.settled and bool(self._shown.forces)
        self._held = sideways(self.model) if resting else None

    def _resume(self, start: tuple[float, State]) -> None:
        self._p, self._state = start
        self._before = None

    def _locate(self, start: tuple[float, State], target: float) -> float:
        """Where, between a station that is held in the plane and one that is not, that changes."""
        held, lost = start, target
        while abs(held[0] - lost) > _ONSET:
            self._resume(held)
            middle = (held[0] + lost) / 2
            if self._is_held_at(middle):
                held = self._p, self._state
            else:
                lost = middle
        return (held[0] + lost) / 2

    def _leaves(self, mode: Floats) -> bool:
        """Whether MuJoCo's own motion carries the beam farther and farther out of its plane.

        Near the place where it first does so, that takes long. So the beam is not left to grow from
        one amplitude to the next, but shown to grow at each.
        """
        model = self.model
        rest = model.data.qpos.copy()
        model.turn(rest, _NUDGES[0] * mode)
        unit = model.out_of_plane() / _NUDGES[0]
        for amplitude in _NUDGES:
            model.turn(rest, amplitude / unit * mode)
            self._move(GENTLE_STEP, _TRIAL)
            begun = model.out_of_plane()
            self._move(GENTLE_STEP, _TRIAL)
            if model.out_of_plane() <= begun:
                return False
        return True

    def _move(self, timestep: float, steps: int) -> None:
        """Let MuJoCo's own motion go on until the beam rests or is in its plane again."""
        model = self.model
        for _ in range(steps):
            if model.creep(timestep) < AT_REST or model.out_of_plane() < _IN_PLANE:
                break
            model.lookout.follow_contact(model.contacts())
        model.evaluate()

    def _drift(self, target: float, departure: _Departure) -> None:
        """Let MuJoCo's own motion carry the beam, with its clamp at `target`, to where it rests."""
        model = self.model
        model.move_clamp(self._pose(target))
        self._move(departure.timestep, _STEPS)
        self._move(STEP, _LAST_STEPS)
        angles = model.beam.angles(model.data)
        self._p, self._held = target, None
        self._before = None
        if model.out_of_plane() > _IN_PLANE:
            model.relieved()
            imbalance = float(np.abs(model.moments()).max())
            self._state = State(angles, {}, imbalance, imbalance < self._tolerance)
            self._departure = departure
        else:
            self._state = self._relax(target, State(angles, {}))
            self._shown = self._state
            self._look()
            self._departure = None
            if turned(angles, departure.angles) > self._numerics.branch_turn:
                self.snap_off = departure.p
        self._shown = self._state
        self.doubt = None if self._state.settled else "on its way out of the plane"
