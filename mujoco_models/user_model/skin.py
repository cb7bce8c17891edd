"""Where on a user's vibrissa a contact is: on the geom of a link, or on an edge of a flex."""

from dataclasses import dataclass

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats
from mujoco_models.inspect.parts import radius_of
from mujoco_models.inspect.rod import Rod


@dataclass(frozen=True, eq=False)
class Links:
    """Geoms on bodies with hinges."""

    model: mujoco.MjModel
    data: mujoco.MjData
    chain: tuple[int, ...]
    geoms: frozenset[int]
    nodes: Floats  # arc lengths of the joints and the tip
    tip: Floats  # in the frame of the last body

    def has(self, contact: int) -> bool:
        return not self.geoms.isdisjoint(self.data.contact.geom[contact].tolist())

    def arc_length(self, contact: int, inward: Floats) -> float:
        geom = next(g for g in self.data.contact.geom[contact].tolist() if g in self.geoms)
        point = self.data.contact.pos[contact] + radius_of(self.model, geom) * inward
        body = int(self.model.body_weldid[self.model.geom_bodyid[geom]])
        if body not in self.chain:
            short = (self._joint(0) - point) @ self._direction(0)
            return float(np.clip(self.nodes[0] - short, 0, self.nodes[0]) / self.nodes[-1])
        link = self.chain.index(body)
        room = self.nodes[link + 1] - self.nodes[link]
        along = float(np.clip(self._direction(link) @ (point - self._joint(link)), 0, room))
        return float((self.nodes[link] + along) / self.nodes[-1])

    def tip_direction(self) -> Floats:
        return self._direction(len(self.chain) - 1)

    def elastic_energy(self) -> float:
        """By MuJoCo, which must be asked to count it."""
        return float(self.data.energy[0])

    def _joint(self, link: int) -> Floats:
        return np.asarray(self.data.xanchor[self.model.body_jntadr[self.chain[link]]])

    def _direction(self, link: int) -> Floats:
        """Of a link, from its joint to the next one, or the last one's."""
        if link + 1 < len(self.chain):
            far = self._joint(link + 1)
        else:
            turn = self.data.xmat[self.chain[-1]].reshape(3, 3)
            far = self.data.xpos[self.chain[-1]] + turn @ self.tip
        way = far - self._joint(link)
        return np.asarray(way / np.linalg.norm(way))


@dataclass(frozen=True, eq=False)
class Edges:
    """A flex."""

    model: mujoco.MjModel
    data: mujoco.MjData
    rod: Rod
    nodes: Floats  # arc lengths of the vertices at which it bends, and of the tip
    compliances: Floats

    def has(self, contact: int) -> bool:
        return self.rod.flex in self.data.contact.flex[contact].tolist()

    def arc_length(self, contact: int, inward: Floats) -> float:
        radius = self.model.flex_radius[self.rod.flex]
        point = self.data.contact.pos[contact] + radius * inward
        vertices = self.data.flexvert_xpos[list(self.rod.vertices)]
        edges = np.diff(vertices, axis=0)
        squares = (edges**2).sum(axis=1)
        shares = np.clip(((point - vertices[:-1]) * edges).sum(axis=1) / squares, 0, 1)
        off = np.linalg.norm(vertices[:-1] + shares[:, None] * edges - point, axis=1)
        nearest = int(np.argmin(off))
        left = (1 - shares[nearest]) * np.sqrt(squares[nearest])
        return float(max(self.nodes[nearest] - left, 0) / self.nodes[-1])

    def tip_direction(self) -> Floats:
        edge = np.diff(self.data.flexvert_xpos[list(self.rod.vertices[-2:])], axis=0)[0]
        return np.asarray(edge / np.linalg.norm(edge))

    def elastic_energy(self) -> float:
        """Of bending, as measured: MuJoCo counts none of a flex."""
        edges = np.diff(self.data.flexvert_xpos[list(self.rod.vertices)], axis=0)
        edges /= np.linalg.norm(edges, axis=1)[:, None]
        turns = 2 * np.arcsin(np.linalg.norm(np.diff(edges, axis=0), axis=1) / 2)
        return float((turns**2 / self.compliances).sum() / 2)
