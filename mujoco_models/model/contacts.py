"""The contacts that MuJoCo reports."""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import mujoco
import numpy as np

from analytic.numerics.arrays import Booleans, Floats, Integers
from mujoco_models.beams.layout import Layout
from mujoco_models.model.sides import FUSED, Sides
from mujoco_models.model.surface import CONTACT_GAP, Surface

_AT_TIP = 1e-9  # L
# Loaded contacts of one place are closer along a curved vibrissa: one link's, or one facet's.
_APART, _LINKS = 0.05, 2.5  # L, and in links
NOWHERE = dict.fromkeys(("contact_angle", "contact_arc_length", "contact_x", "contact_y"), np.nan)


class Contacts(NamedTuple):
    """The contacts of one configuration, loaded or within the gap; arrays of n contacts."""

    # Shape (n,); What touches: the number of the bead or, from n_beads on, one for each corner and
    # link.
    touch: Integers
    link: Integers  # shape (n,); The link that carries it
    # Shape (n,); Whether a corner is on the side of the link, along which it slides.
    on_side: Booleans
    # Shape (n, 2); The corner then; else the centre of the bead, or of the link's round end [L].
    point: Floats
    arc_length: Floats  # shape (n,); Along the beam [L]
    normal: Floats  # shape (n, 2); Unit normal, away from the obstacle
    # Shape (n,); Of the beam's surface from the obstacle; negative where the contact is loaded [L].
    distance: Floats
    # Shape (n,); Which of them another contact stands for, see `BeamModel.evaluate`; they count as
    # being as far off as MuJoCo looks.
    fused: Booleans
    passed: bool  # whether a corner has gone through a link's axis, and MuJoCo pushes the wrong way

    @classmethod
    def of(
        cls,
        data: mujoco.MjData,
        surface: Surface,
        layout: Layout,
        joints: Floats,
        sides: Sides | None = None,
    ) -> "Contacts":
        """All contacts that MuJoCo reports."""
        contact = data.contact
        if data.ncon == 0:
            none, nothing = np.zeros(0), np.zeros(0, dtype=int)
            nowhere, no = np.zeros((0, 2)), none > 0
            return cls(nothing, nothing, no, nowhere, none, nowhere, none, no, passed=False)
        moves = surface.moves[contact.geom]
        normal = np.where(moves[:, :1], -1.0, 1.0) * contact.frame[:, :2]
        bead = surface.bead_of[contact.geom].max(axis=1)
        centre = data.geom_xpos[surface.beads[bead], :2]
        no = np.zeros(len(bead), dtype=bool)
        beads = cls(
            bead,
            layout.links[bead],
            no,
            centre,
            layout.beads[bead],
            normal,
            contact.dist.copy(),
            no,
            passed=False,
        )
        if len(surface.sides) == 0:
            return beads
        sides = sides or Sides.of(data, surface, layout, joints)
        return beads._with_sides(data, surface, layout, sides)

    def _with_sides(
        self, data: mujoco.MjData, surface: Surface, layout: Layout, sides: Sides
    ) -> "Contacts":
        """The same, where what is no bead is a link that touches a corner."""
        fused = data.contact.exclude == FUSED
        # Deeper than the axis of a link, MuJoCo sees the corner from behind; so it sees one hidden
        # beside another, but then the axis is outside.
        behind = sides.along & (self.distance < 0) & ~fused
        behind &= (self.normal * surface.corners.outward[sides.edge]).sum(axis=1) < 0
        for i in behind.nonzero()[0]:
            axis = sides.point[i] + (self.distance[i] + surface.radius) * self.normal[i]
            behind[i] = not surface.corners.in_front(np.append(axis, 0.0), int(sides.edge[i]))
        number = len(surface.beads) + sides.edge * len(layout.joints) + sides.link
        distance = np.where(behind, -self.distance - 2 * surface.radius, self.distance)
        return Contacts(
            np.where(sides.touch, number, self.touch),
            np.where(sides.touch, sides.link, self.link),
            sides.along,
            np.where(sides.touch[:, None], sides.point, self.point),
            np.where(sides.touch, layout.joints[sides.link] + sides.s, self.arc_length),
            np.where(behind[:, None], -self.normal, self.normal),
            np.where(fused, CONTACT_GAP, distance),
            fused,
            passed=bool(behind.any()),
        )

    def nearest(self, count: int) -> "Contacts":
        """Those with the smallest distances, in the same order."""
        if len(self.distance) <= count:
            return self
        return self.only(np.sort(np.argpartition(self.distance, count)[:count]))

    def only(self, kept: Integers | Booleans) -> "Contacts":
        """Some of them."""
        columns = {
            name: column[kept] for name, column in self._asdict().items() if name != "passed"
        }
        return self._replace(**columns)

    @property
    def loaded(self) -> Booleans:
        """Which of them carry a load, shape (n,)."""
        return np.asarray(self.distance < 0)

    def as_reading(self, place: Floats, loaded: Booleans) -> dict[str, Any]:
        """Phase and contact as a row of readings has them: some contacts' mean, by force."""
        if not loaded.any():
            return {"phase": "free", **NOWHERE, "penetration": 0.0}
        depth, s = self.distance[loaded], self.arc_length[loaded]
        weight = depth / depth.sum()
        normal_x, normal_y = (weight @ self.normal[loaded]).tolist()
        x, y = (weight @ place[loaded]).tolist()
        return {
            "phase": "tip" if s.min() > 1 - _AT_TIP else "tangent",
            "contact_angle": math.atan2(normal_x, -normal_y),
            "contact_arc_length": float(weight @ s),
            "contact_x": x,
            "contact_y": y,
            "penetration": float(-weight @ depth),
        }

    def of_places(
        self, where: Floats, places: list[Booleans], force_of: Callable[[Booleans], float]
    ) -> dict[str, Any]:
        """Phase and contact of the place next to the clamp, and the contact of another one."""
        first, *others = places
        row = self.as_reading(where, first)
        if len(others) == 1:
            second = self.as_reading(where, others[0])
            row |= {f"second_{name}": second[name] for name in NOWHERE}
            row["second_contact_force"] = force_of(others[0])
        elif others:
            row.update(NOWHERE, status="touches again")
        return row

    def places(self, layout: Layout) -> list[Booleans]:
        """Which of them are in one place of the vibrissa and which in another, from the clamp on.

        There are two places where loaded contacts are farther apart than those of one place are,
        and three or more where that is so again; a straight vibrissa touches in one.
        """
        loaded = self.loaded
        after = places_after(self.arc_length[loaded], layout)
        number = np.searchsorted(after, self.arc_length, side="right")
        return [loaded & (number == i) for i in range(len(after) + 1)]

    @property
    def slope(self) -> Floats:
        """Slope angles of the contour with these normals, shape (n,) [rad]."""
        return slope_angle(self.normal)


def places_after(loaded: Floats, layout: Layout) -> Floats:
    """Of loaded contacts' arc lengths those with which another place begins [L]."""
    if layout.vibrissa.is_straight:
        return np.zeros(0)
    along = np.sort(loaded)
    return along[1:][np.diff(along) > max(_APART, _LINKS * float(layout.lengths.max()))]


def slope_angle(normal: Floats) -> Floats:
    """Slope angles of the contour with these normals."""
    return np.asarray(np.arctan2(normal[:, 0], -normal[:, 1]))
