"""From station to station at rest with one bead: free, in contact, and by snap-off free again."""

import math
from typing import Any

import numpy as np

from mujoco_models.errors import ClampError
from mujoco_models.model.bead import BeadModel
from mujoco_models.model.contacts import NOWHERE
from mujoco_models.sweep.bead.balance import Balance, Settled, State
from mujoco_models.sweep.bead.fall import fall
from mujoco_models.sweep.first_cell import near_clamp

_DISCREPANCY = 1e-6  # EI/L^2, EI/L; a hundred times the usual tolerance of rest
_TOUCH = 1e-9  # L, to which the first contact is enclosed
_BEGIN = (1e-6, 1e-5, 1e-4)  # L beyond it, where a contact is looked for
_SMALLEST = 1e-5  # L; a branch that steps as small as this do not follow has ended
_BEYOND = 1e-4  # L, beyond the end of a branch, where it is seen what comes after it
_SHORTER, _LONGER = 4.0, 2.0  # times the step where no neighbour is found, and where one is
_BRANCH = 0.25  # rad; a link that turns farther in a step has left the branch
_SHIFT = 0.25  # rad; a contact whose slope jumps by more has left the branch
_LOOSE = 1e-2  # EI/L^2; a contact that ends with less has faded, it has not snapped off
_DEEPER = 1e-9  # L; past the named cases and polygons the two distances are equal to 4e-16
_EVALUATIONS = 5000  # that a station may take
_RIGHT = -0.05  # cosine of the normal with the way across, below which a contact is on the right


class BeadWalk:
    """The beam on its way."""

    def __init__(self, model: BeadModel, foot_x: float, tolerance: float) -> None:
        self.model, self._tolerance = model, tolerance
        self._balance = Balance(model, tolerance)
        self._at = foot_x
        self._straight = np.zeros(len(model.ends))
        self._held: Settled | None = None
        self._lost: str | None = None
        self.snap_off: float | None = None
        self.doubt: str | None = None

    @property
    def events(self) -> dict[str, float | None]:
        """Foot positions of what happened on the way [L]."""
        return {"snap_off": self.snap_off}

    def go_to(self, target: float) -> None:
        """Follow the branch of equilibria, in smaller steps where it takes them."""
        limit, self.doubt = self.model.evaluations + _EVALUATIONS, None
        while self._at != target and self._lost is None:
            if self._held is None:
                self._seek(target)
            else:
                self._follow(target)
            if self.model.evaluations > limit:
                self._lost = f"not at rest after {_EVALUATIONS} evaluations"
        self._at = target
        self.doubt = self._lost or self._doubt()

    def _gap(self, foot_x: float) -> float:
        """Between the object and the unloaded beam [L]."""
        self.model.place(foot_x, self._straight)
        return self.model.nearest()[0]

    def _seek(self, target: float) -> None:
        """Go on to the next contact, or to the station.

        The gap changes by no more than the foot moves.
        """
        way = math.copysign(1.0, target - self._at)
        gap = self._gap(self._at)
        while gap > _TOUCH:
            rigid = self.model.rigid_gap()
            if rigid <= _TOUCH:
                self._lost = "the object is in the rigid half of the first cell from the clamp"
                return
            gap = min(gap, rigid)
            if gap >= abs(target - self._at):
                self._at = target
                return
            self._at += way * gap
            gap = self._gap(self._at)
        for beyond in _BEGIN:
            at = self._at + way * beyond
            self.model.place(at, self._straight)
            _, link, s = self.model.nearest()
            found = self._balance.converge(State(self._straight, link, s, 0.0, False), at)
            if found is not None and found.state.force > 0 and found.stable:
                self._accept(at, found)
                return
        self._lost = "no state at rest was found at the first contact"

    def _follow(self, target: float) -> None:
        """Along the branch to the station, or to its end and what comes after it."""
        stride = math.inf
        while self._at != target and self._held is not None:
            step = target - self._at
            step = math.copysign(min(abs(step), stride), step)
            goal = target if abs(step) == abs(target - self._at) else self._at + step
            found = self._neighbour(goal)
            if found is not None:
                self._accept(goal, found)
                stride = _LONGER * max(abs(step), stride if math.isfinite(stride) else 0.0)
            elif abs(step) > _SMALLEST:
                stride = abs(step) / _SHORTER
            else:
                self._end(target, goal)
                return

    def _neighbour(self, goal: float) -> Settled | None:
        """The state of the same branch, if there is one."""
        held = self._held
        assert held is not None
        found = self._balance.follow(held, goal - self._at, goal)
        return found if found is not None and self._follows(found) else None

    def _follows(self, found: Settled) -> bool:
        """Whether it is the neighbour of the last state."""
        held = self._held
        assert held is not None
        turned = float(np.abs((found.state.angles - held.state.angles).cumsum()).max())
        near = turned < _BRANCH and abs(found.touch.slope - held.touch.slope) < _SHIFT
        return near and found.stable and found.state.force > 0

    def _accept(self, foot_x: float, found: Settled) -> None:
        self._at, self._held = foot_x, found

    def _end(self, target: float, goal: float) -> None:
        """What comes after the end of the branch."""
        held, where = self._held, (self._at + goal) / 2
        assert held is not None
        ahead = target - self._at
        beyond = self._at + math.copysign(min(abs(ahead), _BEYOND), ahead)
        if held.state.force < _LOOSE:
            self._at, self._held = goal, None
            return
        fallen = fall(self._balance, held, beyond)
        if isinstance(fallen, State):
            self._lost = "no state at rest was found near the last one, and no snap-off"
        elif fallen is None:
            self.snap_off = where
            self._at, self._held = beyond, None
        else:
            if self._side(fallen) != self._side(held):
                self.snap_off = where
            self._accept(beyond, fallen)

    def _side(self, found: Settled) -> bool:
        """Whether the beam touches with its left side."""
        nx, ny = found.touch.normal
        return nx * math.cos(found.place.heading) + ny * math.sin(found.place.heading) > _RIGHT

    def _touches_again(self, held: Settled) -> bool:
        """Whether another part of the beam is deeper in the object than the one bead."""
        return self.model.nearest()[0] < held.touch.distance - _DEEPER

    def _doubt(self) -> str | None:
        """What is wrong with the state at a station."""
        model, s = self.model, None if self._held is None else self._held.state.s
        return near_clamp(model.layout, model.obstacle, model.radius, self._at, s)

    def row(self) -> dict[str, Any]:
        """The readings of the state that the beam is in."""
        model, held = self.model, self._held
        row: dict[str, Any] = {"phase": "free", **NOWHERE, "penetration": 0.0}
        angles = self._straight if held is None else held.state.angles
        if held is None:
            model.place(self._at, angles)
            imbalance = model.evaluate(None, 1.0, None)
        else:
            imbalance = model.evaluate(held.state.link, held.state.s, held.place)
            x, y, depth = model.contact_place(held.place, held.touch)
            tip = held.state.s == 1.0 and not held.state.sliding
            row = {
                "phase": "tip" if tip else "tangent",
                "contact_angle": held.touch.slope,
                "contact_arc_length": held.state.s,
                "contact_x": x,
                "contact_y": y,
                "penetration": depth,
            }
        if self.doubt is None and imbalance > self._tolerance:
            self.doubt = "out of balance"
        row |= {
            "status": "ok" if self.doubt is None else "unsettled",
            **model.clamp()._asdict(),
            "tip_angle": model.layout.tip_angle(angles),
            "residual": imbalance,
            "discrepancy": model.discrepancy(),
            "extension": model.extension(),
        }
        if self.doubt is None and held is not None and self._touches_again(held):
            row |= {**NOWHERE, "status": "touches again"}
        out_of_balance = len(angles) * imbalance  # of which the sensors feel the sum
        if self.doubt is None and row["discrepancy"] > _DISCREPANCY + out_of_balance:
            raise ClampError(self._at, row["discrepancy"], _DISCREPANCY)
        return row
