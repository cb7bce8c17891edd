"""Where along the vibrissa its joints and its contact spheres sit."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from analytic.numerics.arrays import Floats, Integers
from mujoco_models.beams.vibrissa import Vibrissa
from mujoco_models.settings import Settings

# A bead is a fixed material point, so the readings err by the contour's curvature times the beads'
# spacing. It is bounded in radii of the vibrissa, in radii of curvature of the contour, and by the
# square of the cell's length, so that it does not spoil the second order.
_OF_RADIUS = 0.65
OF_CURVATURE = 0.01
_OF_CELLS = 3.0
_LEAST = 1 / 4000  # L, of thin vibrissae and sharp contours: more beads cost more than they bring
MOST_BENT = 0.8
"""Of a joint [rad]. Readings are off by 0.08 times its square, in the median of 6,000 stations past
random objects: 5 % here, and up to 21 %."""
# Past circles near the clamp, a force on n segments up to its contact is off by 0.6/n^2 of itself,
# by 7 % at three. That is ten times what N segments are off elsewhere, 3/N^2, from here on.
_COARSE = 3.0
_NEAR = 0.14  # L
_LEAST_OF_CELLS = 1 / 8000  # L; reached from N = 155 on


@dataclass(frozen=True)
class Layout:
    """Joints and contact spheres ("beads") along the vibrissa of length 1.

    Between two joints a link is rigid in the shape of the unloaded vibrissa: an arc, if that is
    curved. So the joints turn by what bends, and by nothing at rest; and where a curved vibrissa
    touches tangentially, its slope is the link's at that place. Straight links with turned joints
    would jump there by curvature times cell, which makes readings of first order in the cell.
    """

    # Shape (n_joints,); Arc length of each joint, or vertex, where the beam bends; link i begins at
    # joint i. The first is at 0 if the clamp turns.
    joints: Floats
    # Shape (n_joints,); Turn of each joint by moment: of the piece of beam, a cell, that bends
    # there, or of the clamp [L/EI].
    compliances: Floats
    # Shape (n_beads,); Arc length of each bead, the last one at the tip; none before the first
    # joint.
    beads: Floats
    # Shape (n_beads,); The link that carries each bead; a bead at a joint is carried by the link
    # that ends there.
    links: Integers
    vibrissa: Vibrissa  # what the beam stands for
    # Shape (n_joints, 2); Where each link of the unloaded beam begins, as seen from the foot [L].
    base: Floats
    # Shape (n_joints,); Distance from a link's begin to its end; of a straight one, its length [L].
    chords: Floats
    # Shape (n_joints,); Turn of the chord of each link of the unloaded beam from the upright, to
    # the left [rad].
    headings: Floats

    @classmethod
    def of(
        cls,
        joints: Floats,
        cells: Floats,
        edges: Floats,
        spacing: float,
        vibrissa: Vibrissa | None = None,
    ) -> "Layout":
        """Beads at most `spacing` apart, and at least two to a link, or one at each link's end."""
        vibrissa = vibrissa or Vibrissa()
        softness, offset = vibrissa.bending(edges)
        joints, compliances = joints + offset, cells * softness
        if vibrissa.clamp_compliance > 0:
            joints = np.insert(joints, 0, 0.0)
            compliances = np.insert(compliances, 0, vibrissa.clamp_compliance)
        lengths = np.diff(joints, append=1.0)
        fewest = 1 if spacing == np.inf else 2
        counts = np.maximum(fewest, np.ceil(lengths / spacing - 1e-9).astype(int))
        beads = [
            start + length * np.arange(1, count + 1) / count
            for start, length, count in zip(joints, lengths, counts, strict=True)
        ]
        links = np.repeat(np.arange(len(joints)), counts)
        ends = vibrissa.at(np.append(joints, 1.0))
        x, y = np.diff(ends, axis=0).T
        return cls(
            joints,
            compliances,
            np.concatenate(beads),
            links,
            vibrissa,
            ends[:-1],
            np.hypot(x, y),
            np.arctan2(-x, y),
        )

    @property
    def lengths(self) -> Floats:
        """Length of each link, shape (n_joints,)."""
        return np.diff(self.joints, append=1.0)

    @cached_property
    def arched(self) -> float:
        """By how much all links are longer than their chords [L]."""
        return float((self.lengths - self.chords).sum())

    @property
    def thickness(self) -> Floats:
        """Radius of each link in its middle over that at the clamp, shape (n_joints,)."""
        return self.vibrissa.thickness(self.joints + self.lengths / 2)

    @property
    def clamp_turns(self) -> bool:
        """Whether the first joint is the clamp's."""
        return self.vibrissa.clamp_compliance > 0

    @cached_property
    def hanging(self) -> Floats:
        """First moments about its begin of each link and of what hangs on its end [L^2]."""
        beyond = 1 - self.joints - self.lengths
        return np.asarray(self.chords * (beyond + self.lengths / 2))

    def weigh(self, headings: Floats) -> tuple[Floats, Floats]:
        """Moment of the weight on each link, and its stiffness, by the turns of the chords."""
        w_x, w_y = self.vibrissa.weight
        sin, cos = np.sin(headings), np.cos(headings)
        along, across = w_y * cos - w_x * sin, -w_x * cos - w_y * sin
        return self.hanging * across, self.hanging * along

    @cached_property
    def spacing(self) -> float:
        """The largest distance of neighbouring beads [L]."""
        return float(np.diff(self.beads).max(initial=0.0))

    @cached_property
    def from_links(self) -> Floats:
        """Where the beads are in the frames of their links, shape (2, n_beads) [L].

        Across and along the chords.
        """
        there = self.vibrissa.at(self.beads) - self.base[self.links]
        return turned(there.T, -self.headings[self.links])

    def move(self, beads: Integers, places: Floats) -> None:
        """Let beads be elsewhere on their links."""
        self.beads[beads] = places
        self.__dict__.pop("from_links", None)

    @property
    def too_near(self) -> float:
        """From the clamp, within which a contact is resolved much worse than elsewhere [L].

        The first cell always is, and as much as three segments are, up to `_NEAR`.
        """
        first = int(self.clamp_turns)
        end = float(self.joints[first] + self.lengths[first] / 2)
        return max(end, min(_COARSE / len(self.joints[first:]), _NEAR))

    def tip_angle(self, angles: Floats) -> float:
        return np.pi / 2 + float(angles.sum()) + self._tip_turn

    @cached_property
    def _tip_turn(self) -> float:
        """Of the unloaded tip from the upright, to the left [rad]."""
        return float(self.vibrissa.turn(np.array(1.0)))

    def step(self, link: int) -> tuple[Floats, float]:
        """From one link's frame to the next one's, unloaded.

        A link's frame has its origin where the link begins, and its y axis along the chord; the
        foot's is upright.
        """
        before, heading = np.zeros(2), 0.0
        if link > 0:
            before, heading = self.base[link - 1], float(self.headings[link - 1])
        return turned(self.base[link] - before, -heading), self.headings[link] - heading

    def within(self, link: int, s: Floats) -> Floats:
        """Where arc lengths are in the frame of their link."""
        there = self.vibrissa.at(s) - self.base[link]
        return turned(there.T, -float(self.headings[link]))


def turned(vector: Floats, angle: float | Floats) -> Floats:
    cos, sin = np.cos(angle), np.sin(angle)
    return np.array([cos * vector[0] - sin * vector[1], sin * vector[0] + cos * vector[1]])


def bead_spacing(segments: int, radius: float, curvature: float) -> float:
    """How far apart beads may be on a beam of so many segments [L]."""
    turning = OF_CURVATURE / max(curvature, OF_CURVATURE)
    of_contact = max(min(_OF_RADIUS * radius, turning), _LEAST)
    return min(of_contact, max(_OF_CELLS / segments**2, _LEAST_OF_CELLS))


def vertices(settings: Settings, grading: float = 0.0) -> Floats:
    """Arc lengths of the vertices of a beam that MuJoCo builds from N segments.

    The first segment is rigid in the clamp. If it straddles the clamp, as much before it as behind,
    the vertices that bend sit at the centres of their cells, and the beam is of second order; if it
    begins there (the naive beam), it is of first order.
    """
    n = settings.segments
    if settings.clamp == "naive":
        return np.asarray(np.arange(n + 1) / n)
    # An odd and smooth map of equal segments: it keeps the symmetry at the clamp, and the order.
    u = (np.arange(n + 1) - 0.5) / (n - 0.5)
    return np.asarray(u * (1 + grading * u**2) / (1 + grading))
