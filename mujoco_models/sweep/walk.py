"""From station to station at rest, and the snap-off found by smaller and smaller steps."""

from dataclasses import replace
from typing import Any

import numpy as np

from mujoco_models.errors import ClampError
from mujoco_models.model.model import BeamModel
from mujoco_models.model.stance import Stance, stance
from mujoco_models.sweep.numerics import Numerics
from mujoco_models.sweep.release import descend
from mujoco_models.sweep.rest import refine, relax
from mujoco_models.sweep.state import State, turned

_AT_TIP = 1e-9  # L
_DISCREPANCY = 1e-6  # EI/L^2, EI/L; a hundred times the usual tolerance of rest


class Walk:
    """The beam on its way: the last state on the branch, and the one before it.

    Parameters
    ----------
    model : BeamModel
        The beam and the obstacle.
    foot_x : float
        Where the foot of the straight beam starts, clear of the object [L].
    tolerance : float
        Largest moment out of balance at rest [EI/L].
    numerics : Numerics, optional
        Constants of the way.

    Attributes
    ----------
    snap_off : float or None
        Where the last contact was let go [L].
    doubt : str or None
        Why the station where the beam is cannot be trusted.
    """

    def __init__(
        self, model: BeamModel, foot_x: float, tolerance: float, numerics: Numerics | None = None
    ) -> None:
        self.model = model
        self._tolerance = tolerance
        self._numerics = numerics or Numerics()
        self._foot_x = foot_x
        self._state = State.straight(len(model.layout.joints))
        self._stance = Stance.AHEAD
        self._before: tuple[float, State] | None = None
        self._shown = self._state
        self._budget = self._numerics.budget
        self._lost: str | None = None
        self.snap_off: float | None = None
        self.doubt: str | None = None

    @property
    def events(self) -> dict[str, float | None]:
        """Foot positions of what happened on the way [L]."""
        return {"snap_off": self.snap_off}

    def go_to(self, target: float) -> None:
        """Follow the branch of equilibria, in smaller steps where it takes them.

        Where even the smallest step leaves the branch, a descent on MuJoCo's balance decides
        whether the vibrissa has snapped off. A station that is not reached so is unsettled, and
        the next one is tried from the last state on the branch.

        Parameters
        ----------
        target : float
            Foot position of the next station [L].
        """
        limit = self.model.effort + self._budget
        self.doubt = self._advance(target, limit)
        if self.doubt is None:
            self._budget = min(2 * self._budget, self._numerics.budget)
            self._shown = self._state
            self.doubt = self._lost
        else:
            self._budget = max(self._budget // 2, self._numerics.least_budget)
            # The readings are those of the nearest that there is to a state at rest.
            self._shown = replace(self._relax(target, self._guess(target)), settled=False)

    def _advance(self, target: float, limit: float) -> str | None:
        """Go to `target`; why not, if that is not possible."""
        numerics = self._numerics
        step = target - self._foot_x
        while True:
            trial = target if abs(step) >= abs(target - self._foot_x) else self._foot_x + step
            state = self._relax(trial, self._guess(trial))
            if self._follows(state):
                self._accept(trial, state)
                if trial == target:
                    return None
                step *= 2
            elif abs(trial - self._foot_x) > numerics.smallest_step:
                step = (trial - self._foot_x) / 2
            elif self._stance is not Stance.NEAR:
                if state.settled and stance(self.model) is Stance.PASSED:
                    return self._lose("the object was passed without a contact")
                return "no state at rest was found near the last one"
            else:
                where = (self._foot_x + trial) / 2
                ahead = target - self._foot_x
                step = np.copysign(min(abs(ahead), numerics.confirm_step), ahead)
                held = self._held_at(self._foot_x + step, limit)
                if held is None:
                    return self._let_go(where, target)
                if not self._follows(held):
                    return "no state at rest was found near the last one, and no snap-off"
                self._accept(self._foot_x + step, held)
                if self._foot_x == target:
                    return None
            if self.model.effort > limit:
                return f"not at rest after {self._budget} evaluations"

    def _held_at(self, foot_x: float, limit: float) -> State | None:
        """Where the beam comes to rest beyond the last state; None if it lets go.

        By MuJoCo's own derivative, which is enough if it was the solver's that failed; else it
        descends.
        """
        state = self._state
        rest = refine(self.model, foot_x, state, self._tolerance, self._numerics)
        if self._follows(rest):
            return rest
        while True:
            state = descend(self.model, foot_x, state, self._numerics)
            if not state.forces:
                return None
            rest = refine(self.model, foot_x, state, self._tolerance, self._numerics)
            if rest.settled or self.model.effort > limit:
                return rest

    def _let_go(self, where: float, target: float) -> str | None:
        """Go on as the beam that was carried off."""
        free = self._relax(target, State.straight(len(self._state.angles)))
        self._foot_x, self._state, self._before = target, free, None
        self._stance = stance(self.model)
        if not free.settled:
            return "not at rest after a snap-off"
        if self._stance is not Stance.PASSED:
            return self._lose("the contact was let go, and the object is not behind")
        self.snap_off = where
        return None

    def _lose(self, reason: str) -> str:
        """No later station can be trusted."""
        self._lost = reason
        return reason

    def _accept(self, foot_x: float, state: State) -> None:
        if foot_x != self._foot_x:
            self._before = (self._foot_x, self._state)
        self._foot_x, self._state, self._stance = foot_x, state, stance(self.model)

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
        """Whether `state`, in which the model is, is the neighbour of the last one."""
        numerics, last = self._numerics, self._state
        if not state.settled or turned(state.angles, last.angles) > numerics.branch_turn:
            return False
        now = stance(self.model)
        if now is not self._stance:
            faded = self._stance is Stance.FAR and last.load < numerics.load_held
            return (self._stance, now) == (Stance.AHEAD, Stance.NEAR) or (
                faded and now is Stance.PASSED
            )
        jumped = (
            now is Stance.NEAR
            and state.slope is not None
            and last.slope is not None
            and abs(state.slope - last.slope) > numerics.largest_shift
        )
        return not jumped

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
        model, state = self.model, self._shown
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
            "status": "ok" if self.doubt is None else "unsettled",
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
