"""The sweep: station after station at rest, and the snap-off found by smaller and smaller steps."""

import platform
import time
from collections.abc import Callable
from dataclasses import asdict
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
from mujoco_models.errors import DivergedError
from mujoco_models.model.model import BeamModel
from mujoco_models.obstacles.kinds import place
from mujoco_models.settings import Settings
from mujoco_models.sweep.rest import State, fall, relax, turned

_SMALLEST_STEP = 1e-5  # L; a jump that a step this small does not prevent is a snap-off
LARGEST_TURN = 0.35  # rad; a link that turns farther in one step has left the branch
_DISCREPANCY = 1e-6  # EI/L^2, EI/L; a hundred times the usual tolerance of rest
_DIVERGED = {"phase": "free", "status": "diverged"}  # the row of a station without numbers
_HELD = 1e-2  # EI/L^2; a load that vanishes at once was let go, one below it just faded


def run_sweep(
    case: Case,
    settings: Settings,
    advance: Callable[[], None],
    keep: Callable[[Readings], None],
) -> Readings:
    """Sweep the beam to the left; see `mujoco_models.simulate_sweep`."""
    begun = time.process_time()
    walk = set_out(case, settings)
    rows: list[dict[str, Any]] = []
    try:
        # The matrices are small: more threads only wait for each other, on a busy machine for long.
        with threadpool_limits(1):
            for target in case.foot_x / case.beam.length:
                walk.go_to(float(target))
                rows.append(walk.row())
                advance()
    except BaseException as error:  # whatever it is, what there is must not be lost
        if isinstance(error, DivergedError):
            rows.append(_DIVERGED)
        if len(rows) > 1:
            keep(_readings(case, settings, walk, rows, begun))
        if isinstance(error, DivergedError):
            place = f"station {len(rows)} of {len(case.foot_x)}, foot_x = {target:.6g} L"
            raise DivergedError(f"diverged at {place}: {error}") from error
        raise
    return _readings(case, settings, walk, rows, begun)


def _readings(
    case: Case, settings: Settings, walk: "Walk", rows: list[dict[str, Any]], begun: float
) -> Readings:
    """In the units of the case's beam."""
    table = pd.DataFrame(rows)
    beam = case.beam
    for name in ("force_x", "force_y"):
        table[name] *= beam.force_unit
    for name in ("moment_z", "residual"):
        table[name] *= beam.moment_unit
    for name in ("contact_arc_length", "contact_x", "contact_y", "penetration"):
        table[name] *= beam.length
    if not settings.planar:
        table["out_of_plane"] *= beam.length
        table["sideways_stiffness"] *= beam.force_unit / beam.length
    table.insert(0, "foot_x", case.foot_x[: len(rows)])
    provenance = {
        **case.provenance(),
        "engine": f"MuJoCo {mujoco.__version__}, vibrissa-testbed {version('vibrissa-testbed')}",
        "python": platform.python_version(),
        "settings": asdict(settings),
        "obstacle": walk.model.obstacle.label,
        "seconds": round(time.process_time() - begun, 3),
        "events": {name: None if x is None else x * beam.length for name, x in walk.events.items()},
    }
    extra = [name for name in table if name not in COLUMNS]
    return Readings(table[[*COLUMNS, *extra]], beam, f"mujoco {settings.beam}", provenance)


def set_out(case: Case, settings: Settings) -> "Walk":
    """The beam, straight, with its foot at the first station of a sweep to the left."""
    if case.radius == 0:
        raise InputError("beam.radius", 0, "positive for MuJoCo", "it cannot collide a line")
    obstacle = place(case, settings)
    spacing = bead_spacing(settings.segments, case.radius, obstacle.largest_curvature)
    beam = build(settings, spacing)
    model = BeamModel(beam, case.radius, obstacle, settings.contact_stiffness)
    from mujoco_models.sweep.spatial_walk import SpatialWalk  # which is a Walk

    kind = Walk if settings.planar else SpatialWalk
    return kind(model, float(case.foot_x[0]) / case.beam.length, settings.tolerance)


class ClampError(ArithmeticError):
    """The clamp's sensors do not read what holds the beam: a defect of the model or of MuJoCo."""

    def __init__(self, foot_x: float, discrepancy: float) -> None:
        super().__init__(
            f"at foot_x = {foot_x:.6g} L MuJoCo's clamp sensors differ by {discrepancy:.1e} "
            f"(EI/L^2, EI/L) from what contacts and elasticity ask for; at most {_DISCREPANCY:g}"
        )


class Walk:
    """The beam on its way: the last state at rest, and the one before it to extrapolate from."""

    def __init__(self, model: BeamModel, foot_x: float, tolerance: float) -> None:
        self.model = model
        self._tolerance = tolerance
        self._foot_x = foot_x
        self._state = State.straight(len(model.layout.joints))
        self._before: tuple[float, State] | None = None
        self.snap_off: float | None = None
        """Where the last contact was let go [L]."""

    @property
    def events(self) -> dict[str, float | None]:
        """Foot positions of what happened on the way [L]."""
        return {"snap_off": self.snap_off}

    def go_to(self, target: float) -> None:
        """Follow the branch of equilibria to `target`, in smaller steps where it takes them.

        Where even the smallest step leaves the branch, MuJoCo's own gentle motion decides: if it
        goes far, the vibrissa has snapped off; if it stays, the station did not settle.
        """
        step = target - self._foot_x
        while True:
            trial = target if abs(step) >= abs(target - self._foot_x) else self._foot_x + step
            state = relax(self.model, trial, self._guess(trial), self._tolerance)
            if self._follows(state):
                if trial != self._foot_x:
                    self._before = (self._foot_x, self._state)
                self._foot_x, self._state = trial, state
                if trial == target:
                    return
                step *= 2
            elif abs(trial - self._foot_x) > _SMALLEST_STEP:
                step = (trial - self._foot_x) / 2
            else:
                self._let_go((self._foot_x + trial) / 2, target)
                return

    def _let_go(self, where: float, target: float) -> None:
        fallen = fall(self.model, target, self._state)
        if not fallen.forces:
            self.snap_off = where
        self._state = relax(self.model, target, fallen, self._tolerance)
        self._foot_x, self._before = target, None

    def _guess(self, foot_x: float) -> State:
        """The last state, carried on along the branch; so is the place of its load."""
        state = self._state
        if self._before is None:
            return State(state.angles, state.forces)
        x, before = self._before
        ahead = (foot_x - self._foot_x) / (self._foot_x - x)
        forces = state.forces
        if state.forces and before.forces:
            shift = round(ahead * (state.loaded_bead - before.loaded_bead))
            last = len(self.model.layout.beads) - 1
            forces = {min(max(i + shift, 0), last): f for i, f in forces.items()}
        return State(state.angles + ahead * (state.angles - before.angles), forces)

    def _follows(self, state: State) -> bool:
        """Whether `state` is the neighbour of the last one on the branch."""
        near = turned(state.angles, self._state.angles) < LARGEST_TURN
        let_go = sum(self._state.forces.values()) > _HELD and not state.forces
        return state.settled and near and not let_go

    def row(self) -> dict[str, Any]:
        """The dimensionless readings of the state that the beam is in."""
        model, state = self.model, self._state
        clamp = model.clamp()
        contacts = model.contacts()
        loaded = contacts.distance < 0
        row: dict[str, Any] = {
            **clamp._asdict(),
            "phase": "free",
            **dict.fromkeys(
                ("contact_angle", "contact_arc_length", "contact_x", "contact_y"), np.nan
            ),
            "tip_angle": np.pi / 2 + float(state.angles.sum()),
            "status": "ok" if state.settled else "unsettled",
            "residual": state.imbalance,
            "discrepancy": model.discrepancy(),
            "penetration": 0.0,
            "extension": model.extension(),
        }
        out_of_balance = len(state.angles) * state.imbalance  # of which the sensors feel the sum
        if state.settled and row["discrepancy"] > _DISCREPANCY + out_of_balance:
            raise ClampError(self._foot_x, row["discrepancy"])
        if loaded.any():
            weight = -contacts.distance[loaded] / -contacts.distance[loaded].sum()
            beads, normal = contacts.bead[loaded], weight @ contacts.normal[loaded]
            x, y = weight @ model.data.contact.pos[loaded, :2]
            row |= {
                "phase": "tip" if beads.min() == len(model.layout.beads) - 1 else "tangent",
                "contact_angle": float(np.arctan2(normal[0], -normal[1])),
                "contact_arc_length": float(weight @ model.layout.beads[beads]),
                "contact_x": float(x),
                "contact_y": float(y),
                "penetration": float(-weight @ contacts.distance[loaded]),
            }
        return row
