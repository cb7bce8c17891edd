"""Where the beam will rest, before the engine is asked.

The rest solver's own picture of links, springs and polygon: Newton's method comes to rest in it at
a fraction of the cost, the slide of the contact from bead to bead and from facet to facet included,
and the engine has only to confirm what was found. Nothing of it is in a reading: what the engine
does not confirm, its own balance corrects.
"""

from collections.abc import Iterable

import numpy as np

from analytic.problem.arrays import Booleans, Floats, Integers
from mujoco_models.beams.layout import OF_CURVATURE
from mujoco_models.model.balance import Balance
from mujoco_models.model.contacts import Contacts, slope_angle
from mujoco_models.sweep.newton import Newton
from mujoco_models.sweep.numerics import Numerics
from mujoco_models.sweep.state import State, turned

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(3)


class Picture:
    """What of a `Balance` Newton's method needs, without an engine.

    Parameters
    ----------
    model : Balance
        Whose picture it is; it is not evaluated.
    beads : iterable of int
        The beads that may touch.

    Attributes
    ----------
    radii : array, shape (n_beads,)
        Theirs [L].
    """

    def __init__(self, model: Balance, beads: Iterable[int]) -> None:
        self._model, self.layout, self.obstacle = model, model.layout, model.obstacle
        self.contact_stiffness = model.contact_stiffness
        self.contact_curvature = model.contact_curvature
        self.stiffness = model.stiffness
        self._beads: Integers = np.array(sorted(beads), dtype=int)
        self._links = self.layout.links[self._beads]
        self._places = self.layout.beads[self._beads]
        self._from_link = self.layout.from_links[:, self._beads]
        self.radii = model.lookout.radii[self._beads]
        self._none = np.zeros(len(self._beads), dtype=bool)
        self._joints, self._elastic = self.layout.base, np.zeros(len(self.layout.joints))

    def look(self, foot_x: float, angles: Floats) -> Contacts | None:
        """Where a configuration touches; what else is asked is of that.

        Parameters
        ----------
        foot_x : float
            Foot position [L].
        angles : array, shape (n_joints,)
            Joint angles [rad].

        Returns
        -------
        Contacts or None
            Of the beads; None if the obstacle says nothing of that.
        """
        layout = self.layout
        heading = layout.headings + angles.cumsum()
        along = np.array([-np.sin(heading), np.cos(heading)])
        joints = layout.chords * along
        joints[:, 1:] = joints[:, :-1].cumsum(axis=1)
        joints[:, 0] = 0.0
        joints += (layout.base[0] + [foot_x, 0.0])[:, None]
        # The springs' moments, from their stiffness at the nodes of Gauss and Legendre.
        part = [
            w * self.stiffness(angles * (1 + x) / 2) for x, w in zip(_NODES, _WEIGHTS, strict=True)
        ]
        self._elastic = -angles * sum(part) / 2
        ahead, aside = along[:, self._links], self._from_link
        points = joints[:, self._links] + aside[1] * ahead
        points += aside[0] * np.array([ahead[1], -ahead[0]])
        gap = self.obstacle.gap(self._model.lookout.window, points.T)
        if gap is None:
            return None
        distance, normal = gap
        self._joints, no = joints.T, self._none
        distance = distance - self.radii
        return Contacts(
            self._beads, self._links, no, points.T, self._places, normal, distance, no, False
        )

    def joint_positions(self) -> Floats:
        """Where the joints are."""
        return self._joints

    def elastic_moments(self) -> Floats:
        """The beam's own moment at each joint."""
        return self._elastic

    def slides(self, contacts: Contacts) -> Booleans:
        """No bead does."""
        return self._none[: len(contacts.link)]


def forecast(model: Balance, foot_x: float, start: State, numerics: Numerics) -> State | None:
    """Where the beam will rest with its foot at `foot_x`, near `start`.

    Parameters
    ----------
    model : Balance
        The beam and the obstacle.
    foot_x : float
        Foot position [L].
    start : State
        Where to start from, with a load.
    numerics : Numerics
        Constants of the way there.

    Returns
    -------
    State or None
        Not known to be at rest; None if nothing is found, or it is of no use: past sharp corners,
        where beads slide, or inside the object. The lookout faces what is touched.
    """
    obstacle, spacing = model.obstacle, model.layout.spacing
    if len(obstacle.corners) or obstacle.largest_curvature * spacing > 2 * OF_CURVATURE:
        return None
    count, reach = len(model.layout.beads), numerics.ahead
    low, high = min(start.forces) - reach, max(start.forces) + reach
    picture = Picture(model, range(max(low, 0), min(high + 1, count)))
    newton, state = Newton(picture, numerics), start
    for _ in range(numerics.forecasts):
        contacts = picture.look(foot_x, state.angles)
        if contacts is None or not (contacts.distance > -picture.radii / 2).all():
            return None
        slope = float(slope_angle(contacts.normal[[contacts.distance.argmin()]])[0])
        model.lookout.face(slope)  # each window rounds the obstacle's vertices anew
        before, state = state, newton.step(state, contacts)
        if turned(state.angles, before.angles) < numerics.foreseen:
            return State(state.angles, state.forces, slope=slope, foreseen=True)
    return None
