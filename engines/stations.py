"""A sweep by an engine that can solve a station: in smaller steps where it takes them.

For engines with a static solver of their own. They say where the vibrissa is at rest with the foot
at a place, from their last state; the way from station to station, the snap-off, the units and the
form of the readings are the same for all of them, and here.
"""

import time
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any, Protocol

import numpy as np

from analytic.problem.case import Case
from analytic.problem.errors import InputError, require
from analytic.problem.readings import Readings
from analytic.problem.recorder import Recorder, facing, leftward

# L; where nothing else is asked for, a step of the foot that small which leaves the branch is at
# its end
_SMALLEST = 1e-6
_TURN = 0.35  # rad; a tip that turns farther in a step has left the branch
_SHIFT = 1.0  # rad; so has a contact whose slope angle jumps by more
_HELD = 1e-2  # EI/L^2; a load that vanishes at once was let go, one below this just faded
# At a fold a state changes like the square root of the way to it, so ten times as fast a hundredth
# of the way before. Where it is not three times as fast, the solver failed for its own sake.
_FAR, _FASTER = 100.0, 3.0


@dataclass(frozen=True)
class Row:
    """A state at rest, dimensionless: L = EI = 1.

    Attributes
    ----------
    force_x, force_y, moment_z : float
        The clamp's action on the vibrissa, at the foot.
    tip_angle : float
        Slope angle of the tip [rad].
    phase : str
        ``"free"``, ``"tip"`` or ``"tangent"``.
    contact_angle, contact_arc_length, contact_x, contact_y : float
        Slope angle of the contour, arc length and place of the contact; NaN where nothing touches.
    residual : float
        Largest force or moment out of balance, by the engine's own account.
    doubt : str
        Why the station cannot be trusted; empty if it can.
    """

    force_x: float = 0.0
    force_y: float = 0.0
    moment_z: float = 0.0
    tip_angle: float = float(np.pi / 2)
    phase: str = "free"
    contact_angle: float = np.nan
    contact_arc_length: float = np.nan
    contact_x: float = np.nan
    contact_y: float = np.nan
    residual: float = 0.0
    doubt: str = ""

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if name not in ("phase", "doubt"):
                try:  # an array of one number is one, too
                    object.__setattr__(self, name, float(np.asarray(value).item()))
                except (TypeError, ValueError) as error:
                    what = f"{value!r}"[:80]
                    raise InputError(f"Row.{name}", what, "a number", "give a float") from error

    @property
    def missing(self) -> list[str]:
        """What of the state is no number, though it has to be one."""
        sensed = "force_x", "force_y", "moment_z", "tip_angle"
        return [name for name in sensed if not np.isfinite(getattr(self, name))]

    @property
    def load(self) -> float:
        """Of the contact, which the clamp holds."""
        return float(np.hypot(self.force_x, self.force_y))


def free_row(case: Case) -> Row:
    return Row(tip_angle=float(case.unloaded.at(np.array(1.0))[2]))


class Rest(Protocol):
    """What an engine is asked: a station, from the last state that was accepted."""

    def at(self, foot_x: float) -> Row | None:
        """Bring the vibrissa to rest.

        Parameters
        ----------
        foot_x : float
            Foot position [L].

        Returns
        -------
        Row or None
            None if it did not come to rest.
        """

    def accept(self) -> None:
        """Go on from the state of the last `at`, which is on the branch."""


def sweep_stations(
    case: Case,
    rest: Callable[[Case], Rest],
    source: str,
    about: Mapping[str, Any],
    advance: Callable[[], None] = lambda: None,
    smallest: float = _SMALLEST,
) -> Readings:
    """Sweep a case with an engine that solves stations.

    Parameters
    ----------
    case : Case
        The problem, in any units, whichever way its foot moves.
    rest : callable
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
        In the units of the case's beam, with a column ``residual``. Snap-off is where even the
        smallest step leaves the branch, if it ends free, or if the state changed ever faster on the
        way there, as at a fold; if neither, that station and all after it are unsettled, and no
        snap-off is known.

    Raises
    ------
    InputError
        As `rest` does.
    """
    begun, swept = time.process_time(), leftward(case)
    swept.require_upright(source)
    stations = (swept.foot_x / swept.beam.length).tolist()
    walk = _Walk(rest(swept), free_row(swept), stations[0], smallest)
    unsettled: Counter[str] = Counter()
    recorder = Recorder(
        swept,
        source,
        {**about, "unsettled": unsettled},
        lambda: {"snap_off": walk.snap_off},
        begun=begun,
    )
    for target in stations:
        row = walk.go_to(target)
        unsettled.update([row.doubt] if row.doubt else [])
        columns = asdict(row)
        status = "unsettled" if columns.pop("doubt") else "ok"
        recorder.rows.append({**columns, "status": status})
        advance()
    return facing(case, recorder.readings())


class _Walk:
    """The vibrissa on its way: the last state on the branch."""

    def __init__(self, rest: Rest, free: Row, foot_x: float, smallest: float) -> None:
        self._rest, self._smallest = rest, smallest
        self._last = self._free = free
        self._trail: list[tuple[float, ...]] = []  # foot position, clamp's readings, tip angle
        self._lost: str | None = None
        self.foot_x = foot_x
        self.snap_off: float | None = None

    def go_to(self, target: float) -> Row:
        if self.snap_off is not None:
            return self._free
        if self._lost is None:
            self._advance(target)
        if self._lost is not None:
            return replace(self._last, doubt=self._lost)
        return self._free if self.snap_off is not None else self._last

    def _advance(self, target: float) -> None:
        step, begin = target - self.foot_x, self.foot_x == target
        while begin or self.foot_x != target:
            begin = False
            trial = target if abs(step) >= abs(target - self.foot_x) else self.foot_x + step
            row = self._rest.at(trial)
            if row is not None:
                require("what `at` returned", row, Row, "as Row(force_x=..., ...), or None")
            if row is not None and self._follows(row):
                self._rest.accept()
                self.foot_x, self._last = trial, row
                sensed = row.force_x, row.force_y, row.moment_z
                self._trail.append((trial, *sensed, row.tip_angle))
                step *= 2
            elif abs(trial - self.foot_x) > self._smallest:
                step = (trial - self.foot_x) / 2
            else:
                self._end(trial, row)
                return

    def _follows(self, row: Row) -> bool:
        """Whether a state is the neighbour of the last one."""
        last = self._last
        if row.missing:
            return False
        near = abs(row.tip_angle - last.tip_angle) < _TURN
        if row.phase == "free":
            return near and last.load < _HELD
        if last.phase == "free":
            return near
        # An engine need not know the slope of the contour.
        return near and not abs(row.contact_angle - last.contact_angle) >= _SHIFT

    def _end(self, trial: float, row: Row | None) -> None:
        """The branch ends here: it let go, in a fold, or the solver failed."""
        let_go, doubt = row is not None and row.phase == "free", row.doubt if row else ""
        if row is not None and row.missing:
            doubt = doubt or f"at(foot_x={trial:.4g}) gave no number in {', '.join(row.missing)}"
        if not doubt and self._last.load >= _HELD and (let_go or self._folds(trial)):
            self.snap_off = (self.foot_x + trial) / 2
        else:
            nothing = "the solver found no neighbour of the last state at rest, and no fold"
            self._lost = doubt or nothing

    def _folds(self, end: float) -> bool:
        """Whether the state changed ever faster on the way there."""
        trail = np.array(self._trail[::-1])
        x, state = trail[:, 0], trail[:, 1:]
        way = np.abs(x - end)
        near, far = np.searchsorted(way, [10 * self._smallest, 10 * self._smallest * _FAR])
        if far + 1 >= len(x) or near == 0:
            return False
        fast = np.linalg.norm(state[0] - state[near]) / abs(x[0] - x[near])
        slow = np.linalg.norm(state[far] - state[far + 1]) / abs(x[far] - x[far + 1])
        return bool(fast > _FASTER * slow)
