"""Where a vibrissa begins and ends to touch in a second place, as far as links show two."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from analytic.numerics.arrays import Floats
from mujoco_models.beams.layout import Layout
from mujoco_models.model.contacts import places_after
from mujoco_models.sweep.state import State

_START, _END = "second_contact_start", "second_contact_end"
_MERGES = 0.5  # of the stretch that two places span, by one place that followed them


class At(NamedTuple):
    """A state on the branch, and where on its way the clamp is then."""

    p: float
    state: State


class SecondContact:
    def __init__(self, layout: Layout) -> None:
        self._layout = layout
        # None of what does not happen; nothing of what happens where links do not show.
        self.events: dict[str, float | None] = {}
        if not layout.vibrissa.is_straight:  # which touches one object in one place
            self.events = dict.fromkeys((_START, _END))

    def changes(self, before: State, after: State) -> bool:
        """Whether there is one in one of two states; a snap-off ends both contacts."""
        return bool(self.events and after.forces) and self._is(before) != self._is(after)

    def locate(
        self, near: At, far: At, relax: Callable[[float, State], State], close: float
    ) -> None:
        """Find the place between two states."""
        begins, known = self._is(far.state), True
        while known and abs(far.p - near.p) > close:
            p, angles = (near.p + far.p) / 2, (near.state.angles + far.state.angles) / 2
            found = relax(p, State(angles, far.state.forces, slope=far.state.slope))
            known = found.settled
            if self._is(found) == begins:
                far = At(p, found)
            else:
                near = At(p, found)
        # Two that come so near that links show one place may go on.
        one, two = (near.state, far.state) if begins else (far.state, near.state)
        known &= bool(np.ptp(self._along(one)) < _MERGES * np.ptp(self._along(two)))
        if begins:
            self.events[_END] = None  # not for good, if it has ended before
        if begins and self.events.get(_START) is not None:
            return
        name = _START if begins else _END
        self.events[name] = (near.p + far.p) / 2
        if not known:
            del self.events[name]

    def _is(self, state: State) -> bool:
        return len(state.forces) > 1 and len(places_after(self._along(state), self._layout)) > 0

    def _along(self, state: State) -> Floats:
        """Arc lengths of the loaded contacts; of a link's side where the link begins [L]."""
        layout = self._layout
        beads, links = len(layout.beads), len(layout.joints)
        places = (
            layout.beads[i] if i < beads else layout.joints[(i - beads) % links]
            for i in state.forces
        )
        return np.fromiter(places, float)
