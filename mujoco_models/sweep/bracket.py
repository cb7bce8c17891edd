"""Closing in on the place where a branch of equilibria ends."""

from collections.abc import Callable

from mujoco_models.sweep.state import State


class Bracket:
    """The places ahead at which no neighbour of the last state was found."""

    def __init__(self) -> None:
        self._failed: list[tuple[float, State]] = []  # the nearest one last
        self._held = 0  # trials since the last one that failed

    def __bool__(self) -> bool:
        return bool(self._failed)

    @property
    def nearest(self) -> float:
        """Where the nearest one is [L]."""
        return self._failed[-1][0]

    @property
    def beyond(self) -> State:
        """The nearest state at rest that was found instead; if there is none, what was found."""
        resting = (state for _, state in reversed(self._failed) if state.settled)
        return next(resting, self._failed[-1][1])

    def add(self, trial: float, state: State, p: float) -> None:
        """Remember that there was no neighbour."""
        self._held = 0
        others = [(x, other) for x, other in self._failed if x != trial]
        self._failed = sorted([*others, (trial, state)], key=lambda one: -abs(one[0] - p))

    def leave_behind(self, p: float, target: float) -> None:
        """Forget those that the clamp has come past."""
        self._held += 1
        self._failed = [(x, state) for x, state in self._failed if (x - p) * (target - p) > 0]

    def aim(self, p: float, follows: Callable[[State], bool]) -> float:
        """Where to try next."""
        for x, state in self._failed:
            if follows(state):
                return x
        # How early Newton's method jumps or fails depends on how long the step was, too.
        return self.nearest if self._held > 1 else (p + self.nearest) / 2
