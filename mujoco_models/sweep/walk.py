"""From station to station at rest, and the snap-off found by smaller and smaller steps."""

from typing import Any

import numpy as np

from mujoco_models.errors import ClampError
from mujoco_models.model.model import BeamModel
from mujoco_models.sweep.numerics import Numerics
from mujoco_models.sweep.rest import fall, relax
from mujoco_models.sweep.state import State, turned

_AT_TIP = 1e-9  # L
_DISCREPANCY = 1e-6  # EI/L^2, EI/L; a hundred times the usual tolerance of rest


class Walk:
    """The beam on its way: the last state at rest, and the one before it to extrapolate from.

    Parameters
    ----------
    model : BeamModel
        The beam and the obstacle.
    foot_x : float
        Where the foot of the straight beam starts [L].
    tolerance : float
        Largest moment out of balance at rest [EI/L].
    numerics : Numerics
        Constants of the way.

    Attributes
    ----------
    snap_off : float or None
        Where the last contact was let go [L].
    """

    def __init__(
        self, model: BeamModel, foot_x: float, tolerance: float, numerics: Numerics | None = None
    ) -> None:
        self.model = model
        self._tolerance = tolerance
        self._numerics = numerics or Numerics()
        self._foot_x = foot_x
        self._state = State.straight(len(model.layout.joints))
        self._before: tuple[float, State] | None = None
        self.snap_off: float | None = None

    @property
    def events(self) -> dict[str, float | None]:
        """Foot positions of what happened on the way [L]."""
        return {"snap_off": self.snap_off}

    def go_to(self, target: float) -> None:
        """Follow the branch of equilibria, in smaller steps where it takes them.

        Where even the smallest step leaves the branch, MuJoCo's own gentle motion decides: if it
        goes far, the vibrissa has snapped off; if it stays, the station did not settle.

        Parameters
        ----------
        target : float
            Foot position of the next station [L].
        """
        step = target - self._foot_x
        while True:
            trial = target if abs(step) >= abs(target - self._foot_x) else self._foot_x + step
            state = self._relax(trial, self._guess(trial))
            if self._follows(state):
                if trial != self._foot_x:
                    self._before = (self._foot_x, self._state)
                self._foot_x, self._state = trial, state
                if trial == target:
                    return
                step *= 2
            elif abs(trial - self._foot_x) > self._numerics.smallest_step:
                step = (trial - self._foot_x) / 2
            else:
                self._let_go((self._foot_x + trial) / 2, target)
                return

    def _let_go(self, where: float, target: float) -> None:
        fallen = fall(self.model, target, self._state, self._numerics)
        if not fallen.forces:
            self.snap_off = where
        self._state = self._relax(target, fallen)
        self._foot_x, self._before = target, None

    def _relax(self, foot_x: float, start: State) -> State:
        return relax(self.model, foot_x, start, self._tolerance, self._numerics)

    def _guess(self, foot_x: float) -> State:
        """The last state, carried on along the branch; so is the place of its load."""
        state = self._state
        if self._before is None:
            return State(state.angles, state.forces)
        x, before = self._before
        ahead = (foot_x - self._foot_x) / (self._foot_x - x)
        forces = state.forces
        last = len(self.model.layout.beads) - 1
        if state.forces and before.forces and max(*state.forces, *before.forces) <= last:
            shift = round(ahead * (state.loaded_bead - before.loaded_bead))
            forces = {min(max(i + shift, 0), last): f for i, f in forces.items()}
        return State(state.angles + ahead * (state.angles - before.angles), forces)

    def _follows(self, state: State) -> bool:
        """Whether `state` is the neighbour of the last one on the branch."""
        near = turned(state.angles, self._state.angles) < self._numerics.branch_turn
        let_go = self._state.load > self._numerics.load_held and not state.forces
        return state.settled and near and not let_go

    def row(self) -> dict[str, Any]:
        """The readings of the state that the beam is in.

        Returns
        -------
        dict
            Dimensionless, by column; see `mujoco_models.simulate_sweep`.

        Raises
        ------
        ClampError
            If the clamp's sensors differ from what holds the beam by more than its residual can
            explain.
        """
        model, state = self.model, self._state
        clamp = model.clamp()
        contacts = model.contacts()
        loaded = contacts.loaded
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
            raise ClampError(self._foot_x, row["discrepancy"], _DISCREPANCY)
        if loaded.any():
            weight = -contacts.distance[loaded] / -contacts.distance[loaded].sum()
            normal, s = weight @ contacts.normal[loaded], contacts.arc_length[loaded]
            x, y = weight @ model.data.contact.pos[loaded, :2]
            row |= {
                "phase": "tip" if s.min() > 1 - _AT_TIP else "tangent",
                "contact_angle": float(np.arctan2(normal[0], -normal[1])),
                "contact_arc_length": float(weight @ s),
                "contact_x": float(x),
                "contact_y": float(y),
                "penetration": float(-weight @ contacts.distance[loaded]),
            }
        return row
