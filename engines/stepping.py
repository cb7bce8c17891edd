"""A sweep by an engine that only steps in time: damped to rest at every station.

Whether it rests is asked of the moments that the case's springs have in its shape, and whether it
is right of `engines.agreement`. A station where springs, contacts and clamp disagree is not "ok".
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, Protocol

import numpy as np

from analytic.problem.case import Case
from analytic.problem.readings import Readings
from engines.agreement import Agreement, State, on_axis
from engines.stations import Row, free_row, sweep_stations
from mujoco_models.beams.layout import Layout

_REST = 1e-5  # of the largest force or moment; a tenth of what the rod's 40 links leave
_STILL = 1e-6  # L, in a sixteenth of a swing; slower is only a contact that gives way
_ASLEEP, _NAPS = 1e-9, 8  # L; what moves less, so many looks long, has come to rest as it is
_LOOKS = 16  # in a swing
_SWINGS = 100  # until it counts as not at rest
_SMALLEST = 1e-4  # L; the step of the foot in which a snap-off is located: each takes a new rest
_NO_LOAD = 1e-9  # EI/L^2
_RESTLESS = Row(force_x=np.nan, doubt="it does not come to rest")  # which is no snap-off, either


class Stepper(Protocol):
    """What an engine supplies that only steps; seen from the foot, dimensionless: L = EI = 1.

    It damps its motion itself, so that the vibrissa comes to rest in some of its swings.
    """

    layout: Layout
    """Where its vibrissa bends, as `engines.hinges` has it."""
    period: int
    """How many steps the slowest swing of the vibrissa takes, roughly."""

    def step(self, foot_x: float) -> None:
        """Step once in time.

        Parameters
        ----------
        foot_x : float
            Where the foot is at the end of the step [L].
        """

    def look(self) -> State:
        """Report the state that it is in.

        Returns
        -------
        State
            Places, and what the clamp and the contacts do.
        """

    def keep(self) -> Any:  # noqa: ANN401  # the engine's own
        """Copy all that a step changes.

        Returns
        -------
        object
            Whatever `go_back` takes.
        """

    def go_back(self, kept: Any) -> None:  # noqa: ANN401
        """Go on from a state that was kept.

        Parameters
        ----------
        kept : object
            What `keep` returned.
        """


def sweep_stepping(
    case: Case,
    stepper: Callable[[Case], Stepper],
    source: str,
    about: Mapping[str, Any],
    advance: Callable[[], None] = lambda: None,
    smallest: float = _SMALLEST,
) -> Readings:
    """Sweep a case with an engine that only steps.

    Parameters
    ----------
    case : Case
        The problem, in any units, whichever way its foot moves.
    stepper : callable
        Makes the engine's model of a case whose foot moves to the left, in units of that case.
    source : str
        What the readings call the engine.
    about : mapping
        ``engine``, with its version, and ``settings``, for the provenance.
    advance : callable
        Called after every station.
    smallest : float
        The step of the foot in which a snap-off is located [L].

    Returns
    -------
    Readings
        As those of `sweep_stations`. A station is unsettled if springs, contacts and clamp
        disagree there; what does, is counted in the provenance.

    Raises
    ------
    InputError
        As `stepper` does.
    """
    return sweep_stations(
        case, lambda left: SteppedRest(left, stepper(left)), source, about, advance, smallest
    )


class SteppedRest:
    """A stepper that is left to itself until it rests; see `engines.stations.Rest`."""

    def __init__(self, case: Case, stepper: Stepper) -> None:
        self._stepper, self._free = stepper, free_row(case)
        self._agreement = Agreement(case, stepper.layout)
        self._unbent = stepper.layout.vibrissa.at(np.append(stepper.layout.joints, 1.0))
        self._foot_x = float(case.foot_x[0]) / case.beam.length
        self._kept = stepper.keep()
        self._found = self._foot_x, self._kept

    def at(self, foot_x: float) -> Row:
        stepper = self._stepper
        stepper.go_back(self._kept)
        for place in np.linspace(self._foot_x, foot_x, 1 + stepper.period)[1:].tolist():
            stepper.step(place)
        state = self._wait(foot_x)
        self._found = foot_x, stepper.keep()
        return self._row(state, foot_x) if isinstance(state, State) else state

    def accept(self) -> None:
        self._foot_x, self._kept = self._found

    def _wait(self, foot_x: float) -> State | Row:
        """The state in which it rests, or sleeps; or what it will read, if it has let go.

        That is what touches nothing for a swing, neither now nor once it is straight.
        """
        stepper, naps, last = self._stepper, 0, self._stepper.look()
        untouched, clear = 0, self._agreement.is_clear(self._unbent, foot_x)
        for _ in range(_SWINGS * _LOOKS):
            for _ in range(max(1, stepper.period // _LOOKS)):
                stepper.step(foot_x)
            state = stepper.look()
            moved = float(np.abs(state.joints - last.joints).max())
            if not np.isfinite(moved):
                return _RESTLESS
            naps = naps + 1 if moved < _ASLEEP else 0
            if naps == _NAPS or (moved < _STILL and self._agreement.imbalance(state) < _REST):
                return state
            untouched = 0 if state.forces.any() else untouched + 1
            if clear and untouched >= _LOOKS and self._agreement.is_clear(state.joints, foot_x):
                return self._free
            last = state
        return _RESTLESS

    def _row(self, state: State, foot_x: float) -> Row:
        doubt = self._agreement.doubt(state, foot_x)
        fx, fy, moment = state.clamp.tolist()
        size = np.hypot(*state.forces.T)
        if size.sum() < _NO_LOAD:
            return replace(self._free, force_x=fx, force_y=fy, moment_z=moment, doubt=doubt)
        layout = self._stepper.layout
        link, place, _ = on_axis(state, state.points)
        weight = size / size.sum()
        arc_length = float(weight @ (layout.joints[link] + place * layout.lengths[link]))
        (x, y), (push_x, push_y) = weight @ state.points, state.forces.sum(axis=0)
        run, rise = state.joints[-1] - state.joints[-2]
        bent = float(np.arctan2(rise, run)) - np.pi / 2 - float(layout.headings[-1])
        return Row(
            fx,
            fy,
            moment,
            tip_angle=layout.tip_angle(np.array([bent])),
            phase="tip" if arc_length > 1 - _ASLEEP else "tangent",
            contact_angle=float(np.arctan2(push_x, -push_y)),
            contact_arc_length=arc_length,
            contact_x=float(x) + foot_x,
            contact_y=float(y),
            residual=self._agreement.imbalance(state),
            doubt=doubt,
        )
