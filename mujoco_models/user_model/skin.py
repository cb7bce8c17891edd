"""Where on a user's vibrissa a contact is: on the geom of a link, or on an edge of a flex."""

import mujoco
import numpy as np

from analytic.problem.arrays import Floats
from mujoco_models.inspect.parts import radius_of
from mujoco_models.inspect.rod import Rod


class Links:
    """Geoms on bodies with hinges."""

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        chain: tuple[int, ...],
        geoms: frozenset[int],
        nodes: Floats,
        tip: Floats,
    ) -> None:
        self._model, self._data, self._chain = model, data, chain
        self._geoms, self._nodes, self._tip = geoms, nodes, tip

    def has(self, contact: int) -> bool:
        """Whether a contact is one of the vibrissa's geoms."""
        return not self._geoms.isdisjoint(self._data.contact.geom[contact].tolist())

    def arc_length(self, contact: int, inward: Floats) -> float:
        """Along the link; a piece that is fixed to the foot ends at the first joint."""
        geom = next(g for g in self._data.contact.geom[contact].tolist() if g in self._geoms)
        point = self._data.contact.pos[contact] + radius_of(self._model, geom) * inward
        body = int(self._model.geom_bodyid[geom])
        if body not in self._chain:
            short = (self._joint(0) - point) @ self._direction(0)
            return float(np.clip(self._nodes[0] - short, 0, self._nodes[0]) / self._nodes[-1])
        link = self._chain.index(body)
        room = self._nodes[link + 1] - self._nodes[link]
        along = float(np.clip(self._direction(link) @ (point - self._joint(link)), 0, room))
        return float((self._nodes[link] + along) / self._nodes[-1])

    def tip_direction(self) -> Floats:
        """Of the last link."""
        return self._direction(len(self._chain) - 1)

    def elastic_energy(self) -> float:
        """By MuJoCo, which must be asked to count it."""
        return float(self._data.energy[0])

    def _joint(self, link: int) -> Floats:
        return np.asarray(self._data.xanchor[self._model.body_jntadr[self._chain[link]]])

    def _direction(self, link: int) -> Floats:
        """Of a link, from its joint to the next one, or the last one's."""
        if link + 1 < len(self._chain):
            far = self._joint(link + 1)
        else:
            turn = self._data.xmat[self._chain[-1]].reshape(3, 3)
            far = self._data.xpos[self._chain[-1]] + turn @ self._tip
        way = far - self._joint(link)
        return np.asarray(way / np.linalg.norm(way))


class Edges:
    """A flex."""

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        rod: Rod,
        nodes: Floats,
        compliances: Floats,
    ) -> None:
        self._model, self._data, self._rod = model, data, rod
        self._nodes, self._compliances = nodes, compliances

    def has(self, contact: int) -> bool:
        """Whether a contact is one of its flex."""
        return self._rod.flex in self._data.contact.flex[contact].tolist()

    def arc_length(self, contact: int, inward: Floats) -> float:
        """Of the nearest edge."""
        radius = self._model.flex_radius[self._rod.flex]
        point = self._data.contact.pos[contact] + radius * inward
        vertices = self._data.flexvert_xpos[list(self._rod.vertices)]
        edges = np.diff(vertices, axis=0)
        squares = (edges**2).sum(axis=1)
        shares = np.clip(((point - vertices[:-1]) * edges).sum(axis=1) / squares, 0, 1)
        off = np.linalg.norm(vertices[:-1] + shares[:, None] * edges - point, axis=1)
        nearest = int(np.argmin(off))
        left = (1 - shares[nearest]) * np.sqrt(squares[nearest])
        return float(max(self._nodes[nearest] - left, 0) / self._nodes[-1])

    def tip_direction(self) -> Floats:
        """Of the last edge."""
        edge = np.diff(self._data.flexvert_xpos[list(self._rod.vertices[-2:])], axis=0)[0]
        return np.asarray(edge / np.linalg.norm(edge))

    def elastic_energy(self) -> float:
        """Of bending, as measured: MuJoCo counts none of a flex."""
        edges = np.diff(self._data.flexvert_xpos[list(self._rod.vertices)], axis=0)
        edges /= np.linalg.norm(edges, axis=1)[:, None]
        turns = 2 * np.arcsin(np.linalg.norm(np.diff(edges, axis=0), axis=1) / 2)
        return float((turns**2 / self._compliances).sum() / 2)
