"""From station to station at rest, and the snap-off found by smaller and smaller steps."""

import math
from typing import Any, Generic, TypeVar

import numpy as np

from analytic.numerics.arrays import Booleans
from analytic.problem.case import Case
from analytic.problem.clamp_path import Pose
from mujoco_models.beams.layout import MOST_BENT, OF_CURVATURE
from mujoco_models.errors import ClampError
from mujoco_models.model.balance import Balance
from mujoco_models.model.contact_side import Side
from mujoco_models.sweep.bracket import Bracket
from mujoco_models.sweep.descent import descend
from mujoco_models.sweep.forecast import forecast
from mujoco_models.sweep.minimum import minimum
from mujoco_models.sweep.numerics import Numerics
from mujoco_models.sweep.rest import relax
from mujoco_models.sweep.second import At, SecondContact
from mujoco_models.sweep.state import State, turned

Model = TypeVar("Model", bound=Balance)
_DISCREPANCY = 1e-6  # EI/L^2, EI/L; a hundred times the usual tolerance of rest
# L; from two states at rest that rounding alone puts apart, nothing can be carried on.
_SAME_PLACE = 1e-12
_DEEP = 0.25  # of the radius; two sweeps of 390 were lost past polygons, at 0.5 of it and more
_LITTLE = 1e-3  # of a step; a contact of 5e7 EI/L^3 is not lost then, and rest is 1e-5 of it
_PLACES = 9  # of the rigid part at the clamp that are looked at
_OVERLOOKED = 1e-6  # L; how deep they may be in the obstacle
_PACE = 0.8  # of the largest shift of a contact: what is left is for its rate to grow
_BUCKLES = np.pi**2 / 4  # EI/L^2, of a column whose loaded end is free to go aside (Euler)
_STRAIGHT = 0.01  # rad, L; a load across it that is a hundredth of that turns it as far
# What may follow one state at rest without a snap-off.
_NEIGHBOURS = {
    (Side.AHEAD, Side.AHEAD),
    (Side.AHEAD, Side.NEAR),
    (Side.NEAR, Side.NEAR),
    (Side.FAR, Side.FAR),
    (Side.FAR, Side.PASSED),
    (Side.PASSED, Side.PASSED),
}
_OF_A_CURVED_TIP = {(Side.AHEAD, Side.FAR), (Side.NEAR, Side.FAR), (Side.FAR, Side.NEAR)}


class Walk(Generic[Model]):
    """The beam on its way: the last state on the branch, and the one before it."""

    def __init__(
        self,
        model: Model,
        case: Case,
        tolerance: float,
        numerics: Numerics | None = None,
        start: State | None = None,
    ) -> None:
        self.model = model
        self._tolerance = tolerance
        self._numerics = numerics or Numerics()
        self._poses = case.poses
        self._p = float(case.way[0])  # parameter of the clamp's way; it falls
        self._state = start or State.straight(len(model.layout.joints))
        self._before: tuple[float, State] | None = None  # on the branch, before the last state
        self._shown = self._state
        self._budget = self._numerics.budget
        self._lost: str | None = None
        self._dead_end: tuple[float, str] | None = None  # where no step leads on, and why
        self._smooth = True  # no step was taken in vain at this station and the last one
        vibrissa = model.layout.vibrissa
        leans = bool(np.any(self._poses.at(case.way).angle))
        self._oblique = leans or any(vibrissa.weight) or not vibrissa.is_straight
        turn = model.obstacle.largest_curvature * model.layout.spacing
        self._sharp = turn > 2 * OF_CURVATURE
        self.snap_off: float | None = None
        self._second = SecondContact(model.layout)
        self.doubt: str | None = None

    @property
    def events(self) -> dict[str, float | None]:
        """Parameters of the clamp's way at which things happened."""
        return {"snap_off": self.snap_off, **self._second.events}

    def go_to(self, target: float) -> None:
        """Follow the branch of equilibria, in smaller steps where it takes them.

        Where even the smallest step leaves the branch, a descent on MuJoCo's balance decides
        whether the vibrissa has snapped off. A station that is not reached so is unsettled, and
        the next one is tried from the last state on the branch.
        """
        numerics = self._numerics
        self.doubt = self._advance(target, self.model.evaluations + self._budget)
        if self.doubt is None:
            self._budget = min(2 * self._budget, numerics.budget)
            self._shown = self._state
            self.doubt = self._lost or self._too_coarse() or self._is_column()
        else:
            self._budget = max(self._budget // 2, numerics.least_budget)
            # The readings are those of the nearest that there is to a state at rest.
            self._shown = self._relax(target, self._guess(target))

    def _too_coarse(self) -> str | None:
        """Whether it takes more segments: they bend much, or the contact is next to the clamp."""
        model, layout, contacts = self.model, self.model.layout, self.model.contacts()
        first = int(layout.clamp_turns)
        bend = np.abs(self._state.angles[first:]).max()
        if bend > MOST_BENT:
            times = _times(2 * bend / MOST_BENT)
            return f"a joint bends by over {MOST_BENT:g} rad: {times} times the segments would do"
        begin = float(layout.joints[first])
        nearest = contacts.arc_length[contacts.loaded].min(initial=1.0)
        if nearest < layout.too_near:
            return (
                f"the contact is within {layout.too_near:.2g} L of the clamp, too few segments: "
                f"{_times(layout.too_near / nearest)} times as many would do"
            )
        rigid = layout.vibrissa.at(np.linspace(0, begin, _PLACES))
        rigid = np.column_stack(model.pose.place(*rigid.T))
        deep = float(model.lookout.radii[0]) - _OVERLOOKED
        near = () if layout.clamp_turns else model.obstacle.near(rigid, deep)
        if any(model.obstacle.clearance(rigid[i])[0] < deep for i in near):
            return "the object is in the rigid half of the first cell from the clamp"
        return None

    def _is_column(self) -> str | None:
        """Whether it is pressed along its axis by more than it bears without giving way.

        No joint of a straight one is out of balance then, however large the force is.
        """
        angles, clamp = self._state.angles, self.model.clamp()
        load = math.hypot(clamp.force_x, clamp.force_y)
        straight = turned(angles, np.zeros_like(angles)) < _STRAIGHT
        along = straight and abs(clamp.moment_z) < _STRAIGHT * load
        if along and load > _BUCKLES and self.model.contacts().loaded.any():
            return "it stands straight under more than its buckling load, and would give way"
        return None

    def _advance(self, target: float, limit: int) -> str | None:
        """Go to `target`; why not, if that is not possible."""
        least, bracket = self._numerics.smallest_step, Bracket()
        step, in_vain = target - self._p, False
        while True:
            trial = self._onward(self._in_pace(step), target)
            if bracket:
                trial = bracket.aim(self._p, self._follows)
            state, ended = self._near_rest(trial), False
            if not bracket and self._lands_from_afar(trial, state):
                step = (trial - self._p) / 2
                continue
            if self._follows(state):
                self._accept(trial, state)
                bracket.leave_behind(trial, target)
                step *= 2
            else:
                self._smooth, in_vain = False, True
                ended = abs(trial - self._p) <= least
                step = (trial - self._p) / 2
                if self._dead_end and self._dead_end[0] == self._p:
                    return self._dead_end[1]  # there is no way on by smaller steps
                if bracket or state.side is not self._state.side or self._jumped(state):
                    bracket.add(trial, state, self._p)
            end = bracket.nearest if bracket else trial
            if ended or (bracket and abs(end - self._p) <= self._least(bracket.beyond)):
                trouble = self._decide((self._p + end) / 2, target)
                if trouble is not None:
                    self._dead_end = self._p, trouble
                    return trouble
                bracket.leave_behind(self._p, target)
                step = target - self._p
            if self._p == target:
                self._smooth = not in_vain
                return None
            if self.model.evaluations > limit:
                return f"not at rest after {self._budget} evaluations"

    def _lands_from_afar(self, p: float, state: State) -> bool:
        """Whether an oblique vibrissa comes to touch in a step so long that it may touch elsewhere.

        Pressed in, it has more than one state; the sweep's is the one next to the first touch.
        """
        far = abs(p - self._p) > self._numerics.landing_step
        return far and self._oblique and not self._state.forces and bool(state.forces)

    def _onward(self, step: float, target: float) -> float:
        """A step on, or up to the target."""
        rest = abs(target - self._p) - abs(step)
        return target if rest < _SAME_PLACE else self._p + step

    def _in_pace(self, step: float) -> float:
        """A step that should not shift the contact too far, past corners."""
        if self._before is None or len(self.model.obstacle.corners) == 0:
            return step
        (x, before), last = self._before, self._state
        if before.slope is None or last.slope is None or before.slope == last.slope:
            return step
        taken, turn = abs(self._p - x), abs(last.slope - before.slope)
        most = taken * max(_PACE * self._numerics.facet_shift / turn, 1.0)
        return float(np.copysign(min(abs(step), most), step))

    def _jumped(self, state: State) -> bool:
        """Whether the contact is elsewhere on an obstacle with corners."""
        cornered = len(self.model.obstacle.corners) > 0
        return cornered and state.settled and state.side is self._state.side

    def _least(self, beyond: State) -> float:
        """How closely the end of the branch is located, if `beyond` is behind it."""
        # Where it is that a tip goes from facet to facet, no reading knows.
        to_another_facet = self._jumped(beyond) and self._leaves_its_facet(beyond)
        numerics = self._numerics
        return numerics.confirm_step if to_another_facet else numerics.smallest_step

    def _decide(self, where: float, target: float) -> str | None:
        """Go on a little where no neighbour was found: held, or let go; else say what is wrong."""
        last, numerics = self._state, self._numerics
        ahead = target - self._p
        p = self._p + np.copysign(min(abs(ahead), numerics.confirm_step), ahead)
        gone = descend(self.model, self._pose(p), last, numerics, numerics.descent_steps)
        rest = self._relax(p, gone)
        if not rest.settled:
            return self._lost_from(last)
        let_go = last.side is Side.NEAR and rest.side in (Side.FAR, Side.PASSED)
        let_go |= self._pokes(last) and rest.side is Side.PASSED
        # From corner to corner a contact jumps; on a smooth contour it moves.
        jumps = last.side is rest.side and len(self.model.obstacle.corners) > 0
        if not (let_go or jumps or self._follows(rest)):
            if last.side is rest.side:
                return "the contact jumped"
            self._lost = "the contact was lost without a snap-off"
            if last.side is Side.AHEAD:
                self._lost = "the object was passed without a contact"
        if let_go and last.load > numerics.load_held:
            self.snap_off = where
        self._accept(p, rest)
        self._before = None
        return None

    def _lost_from(self, last: State) -> str:
        """Why no state at rest follows: corners go through a vibrissa pressed in too far."""
        self.model.imbalance(self._pose(self._p), last.angles)
        why = [self._too_coarse()]
        if last.load > _DEEP * self.model.contact_stiffness * self.model.lookout.radii.max():
            why.append(
                "no state at rest was found: the contact is so soft that its load presses it in "
                "by over a quarter of the vibrissa's radius; take a stiffer one"
            )
        found = "; ".join(filter(None, why))
        return found or "no state at rest was found near the last one, and no snap-off"

    def _accept(self, p: float, state: State) -> None:
        if p != self._p:
            if self._second.changes(self._state, state):
                last, close = At(self._p, self._state), self._numerics.smallest_step
                self._second.locate(last, At(p, state), self._relax, close)
                self._relax(p, state)  # the model is to be in the state that is gone on from
            self._before = self._p, self._state
        self._p, self._state = p, state

    def _near_rest(self, p: float) -> State:
        """From the last state on; what stops a short step, a descent decides."""
        state = self._relax(p, self._forecast(p), leave=self._state)
        if not self._leaves_its_facet(state):
            return state
        # It may have jumped there in a long step, while it is at rest on its own facet, too.
        stayed = self._on_its_facet(p)
        if stayed.settled and not self._leaves_its_facet(stayed):
            return stayed
        # The model has to be in the state that is gone on from.
        return self._relax(p, state) if self._follows(state) else state

    def _on_its_facet(self, p: float) -> State:
        """At rest on the facet of the last state, if Newton's method finds that there."""
        model, numerics, last = self.model, self._numerics, self._state
        start, step = State(last.angles, last.forces, slope=last.slope), p - self._p
        if abs(step) >= numerics.confirm_step:
            # All of the step at once would carry a stiff contact clear of its facet, and the beam
            # would straighten: a little of it shows how the beam goes along.
            place, stay = self._p + _LITTLE * step, last.slope
            near = relax(model, self._pose(place), start, self._tolerance, numerics, stay=stay)
            if near.settled and not self._leaves_its_facet(near):
                angles = last.angles + (near.angles - last.angles) / _LITTLE
                start = State(angles, near.forces, slope=last.slope)
        return self._relax(p, start, stay=last.slope)

    def _leaves_its_facet(self, state: State) -> bool:
        """Whether the last state rests on a facet between sharp corners, and `state` does not."""
        last, obstacle = self._state.slope, self.model.obstacle
        if len(obstacle.corners) == 0 or last is None or obstacle.curvature(np.array([last]))[0]:
            return False
        return state.slope is None or abs(state.slope - last) > self._numerics.same_facet

    def _pose(self, p: float) -> Pose:
        """Of the clamp on its way."""
        return self._poses.at(np.array(p))

    def _relax(
        self, p: float, start: State, leave: State | None = None, stay: float | None = None
    ) -> State:
        """At rest, if Newton's method gets there; it stops where it is sure to leave a state."""
        model, numerics, pose = self.model, self._numerics, self._pose(p)
        state = relax(model, pose, start, self._tolerance, numerics, leave=leave, stay=stay)
        short = abs(p - self._p) < numerics.confirm_step
        if state.settled or not short or not model.hold_beads():
            return state
        # A bead that slides past a joint may not come to rest; one that stays leans a little.
        return relax(model, pose, start, self._tolerance, numerics, leave=leave, held=True)

    def _forecast(self, p: float) -> State:
        """Where the beam should come to rest, by the solver's surrogate or as it went so far."""
        guess = self._guess(p)
        if not guess.forces or not (self._sharp or self._smooth):
            return guess
        foreseen = minimum if self._sharp else forecast
        return foreseen(self.model, self._pose(p), guess, self._numerics) or guess

    def _guess(self, p: float) -> State:
        """The last state, carried on along the branch; so is the place of its load."""
        state = self._state
        if self._before is None:
            return State(state.angles, state.forces, slope=state.slope)
        x, before = self._before
        ahead = (p - self._p) / (self._p - x)
        forces, slope = state.forces, state.slope
        last = len(self.model.layout.beads) - 1
        if state.forces and before.forces and max(*state.forces, *before.forces) <= last:
            shift = round(ahead * (state.loaded_bead - before.loaded_bead))
            forces = {min(max(i + shift, 0), last): f for i, f in forces.items()}
        if slope is not None and before.slope is not None:
            slope += ahead * (slope - before.slope)
        angles = state.angles + ahead * (state.angles - before.angles)
        return State(angles, forces, slope=slope)

    def _follows(self, state: State) -> bool:
        """Whether `state` is the neighbour of the last one on the branch."""
        last, numerics = self._state, self._numerics
        near = turned(state.angles, last.angles) < numerics.branch_turn
        if last.slope is not None and state.slope is not None:
            cornered = len(self.model.obstacle.corners) > 0
            largest = numerics.facet_shift if cornered else numerics.largest_shift
            near &= abs(state.slope - last.slope) < largest
        change = last.side, state.side
        passes = change in _NEIGHBOURS
        if change in _OF_A_CURVED_TIP:
            passes = self._pokes(state) and (last.side is not Side.AHEAD or self._runs_into(state))
        return state.settled and near and passes

    def _runs_into(self, state: State) -> bool:
        """Whether the tip touches where it comes from; elsewhere it went through the object."""
        pose, rate = self.model.pose, self._poses.rate(np.array(self._p))
        back_x = rate.foot_x - rate.angle * np.cos(pose.angle)
        back_y = rate.foot_y - rate.angle * np.sin(pose.angle)
        slope = state.slope
        return slope is not None and bool(back_x * np.sin(slope) > back_y * np.cos(slope))

    def _pokes(self, state: State) -> bool:
        """Whether a vibrissa that is curved at rest or leans touches with its tip alone.

        Bent forward, it turns as it goes from one side of its axis to the other, and does not let
        go.
        """
        tip = len(self.model.layout.beads) - 1
        return self._oblique and state.forces.keys() == {tip}

    def row(self) -> dict[str, Any]:
        """The readings of the state that the beam is in."""
        model, state = self.model, self._shown
        clamp, contacts = model.clamp(), model.contacts()
        places = contacts.places(model.layout)
        row: dict[str, Any] = {
            **clamp._asdict(),
            "tip_angle": float(model.layout.tip_angle(state.angles) + model.pose.angle),
            "status": "ok" if self.doubt is None else "unsettled",
            "residual": state.imbalance,
            "discrepancy": model.discrepancy(),
            "extension": model.extension(),
        }
        known = places if self.doubt is None else places[:1]

        def force_of(which: Booleans) -> float:
            return sum(state.forces[i] for i in contacts.touch[which])

        row |= contacts.of_places(model.contact_places(), known, force_of)
        out_of_balance = len(state.angles) * state.imbalance  # of which the sensors feel the sum
        if state.settled and row["discrepancy"] > _DISCREPANCY + out_of_balance:
            raise ClampError(model.pose, row["discrepancy"], _DISCREPANCY)
        return row


def _times(share: float) -> int:
    """The power of two that is as much: few different ones, so that reasons can be counted."""
    return int(2 ** math.ceil(math.log2(share)))
