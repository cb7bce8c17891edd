"""Closing in on the place where a branch of equilibria ends.

Near a fold the foot's position is a parabola over what the vibrissa turns by. Three states at rest
show where its end is; a trial short of it seldom fails, and one that fails costs several that hold.
"""

from collections.abc import Callable, Sequence

from mujoco_models.sweep.state import State

_SHORT = 0.8  # of the way to a fold that is foreseen: what is left is its uncertainty


class Walls:
    """The places ahead at which no neighbour of the last state was found."""

    def __init__(self, smallest_step: float) -> None:
        self._found: list[tuple[float, State]] = []  # the nearest one last
        self._smallest_step = smallest_step
        self._fold: float | None = None
        self._held = 0  # trials since the last one that failed

    def __bool__(self) -> bool:
        return bool(self._found)

    @property
    def nearest(self) -> float:
        """Where the nearest one is [L]."""
        return self._found[-1][0]

    @property
    def beyond(self) -> State:
        """The nearest state at rest that was found instead; if there is none, what was found."""
        resting = (state for _, state in reversed(self._found) if state.settled)
        return next(resting, self._found[-1][1])

    def add(self, trial: float, state: State, foot_x: float) -> None:
        """Remember that there was no neighbour."""
        self._held = 0
        others = [(x, other) for x, other in self._found if x != trial]
        self._found = sorted([*others, (trial, state)], key=lambda wall: -abs(wall[0] - foot_x))

    def leave_behind(self, foot_x: float, target: float) -> None:
        """Forget those that the foot has come past."""
        self._held += 1
        self._found = [
            (x, state) for x, state in self._found if (x - foot_x) * (target - foot_x) > 0
        ]

    def aim(self, trail: Sequence[tuple[float, State]], follows: Callable[[State], bool]) -> float:
        """Where to try next."""
        for x, state in self._found:
            if follows(state):
                return x
        (foot_x, last), (wall, beyond) = trail[-1], self._found[-1]
        room = wall - foot_x
        jumped = beyond.settled and beyond.stance is last.stance
        # After a fold that was foreseen where there was none, the next one is not believed.
        passed = self._fold is not None and (self._fold - foot_x) * room <= 0
        self._fold = None if passed or jumped else fold(trail)
        if self._fold is not None and 0 <= (self._fold - foot_x) / room < 1:
            least = min(self._smallest_step / abs(room), 0.5)
            return foot_x + max(_SHORT * (self._fold - foot_x) / room, least) * room
        # How early Newton's method jumps or fails depends on how long the step was, too.
        return wall if self._held > 1 else foot_x + room / 2


def fold(trail: Sequence[tuple[float, State]]) -> float | None:
    """Where a branch turns back, by the parabola through its last three states."""
    if len(trail) < 3 or len({state.stance for _, state in trail[-3:]}) > 1:
        return None
    x0, x1, x2 = (x for x, _ in trail[-3:])
    s0, s1, s2 = (float(state.angles.sum()) for _, state in trail[-3:])  # the tip's slope angle
    if not (s0 < s1 < s2 or s0 > s1 > s2):
        return None
    slope = (x2 - x1) / (s2 - s1)
    bend = (slope - (x1 - x0) / (s1 - s0)) / (s2 - s0)
    if bend == 0 or (end := (s1 + s2) / 2 - slope / (2 * bend)) == s2:
        return None
    if (end - s2) * (s2 - s1) < 0:
        return None
    return x2 + slope * (end - s2) + bend * (end - s1) * (end - s2)
