"""Where along the vibrissa its joints and its contact spheres sit."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from analytic.problem.arrays import Floats, Integers
from mujoco_models.beams.vibrissa import Vibrissa
from mujoco_models.settings import Settings

# A bead is a fixed material point, so the readings err by the contour's curvature times the beads'
# spacing. It is bounded in radii of the vibrissa, in radii of curvature of the contour, and by the
# square of the cell's length, so that it does not spoil the second order.
_OF_RADIUS = 0.65
OF_CURVATURE = 0.01
_OF_CELLS = 3.0
_LEAST = 1 / 4000  # L, of thin vibrissae and sharp contours: more beads cost more than they bring
_LEAST_OF_CELLS = 1 / 8000  # L; reached from N = 155 on


@dataclass(frozen=True)
class Layout:
    """Joints and contact spheres ("beads") along the vibrissa of length 1.

    Between two joints a link is rigid in the shape of the unloaded vibrissa: an arc, if that is
    curved. So the joints turn by what bends, and by nothing at rest; and where a curved vibrissa
    touches tangentially, its slope is the link's at that place. Straight links with turned joints
    would jump there by curvature times cell, which makes readings of first order in the cell.

    Attributes
    ----------
    joints : array, shape (n_joints,)
        Arc length of each joint, or vertex, where the beam bends; link i begins at joint i. The
        first is at 0 if the clamp turns.
    compliances : array, shape (n_joints,)
        Turn of each joint by moment: of the piece of beam, a cell, that bends there, or of the
        clamp [L/EI].
    beads : array, shape (n_beads,)
        Arc length of each bead, the last one at the tip; none before the first joint.
    links : array of int, shape (n_beads,)
        The link that carries each bead; a bead at a joint is carried by the link that ends there.
    vibrissa : Vibrissa
        What the beam stands for.
    base : array, shape (n_joints, 2)
        Where each link of the unloaded beam begins, as seen from the foot [L].
    chords : array, shape (n_joints,)
        Distance from a link's begin to its end; of a straight one, its length [L].
    headings : array, shape (n_joints,)
        Turn of the chord of each link of the unloaded beam from the upright, to the left [rad].
    """

    joints: Floats
    compliances: Floats
    beads: Floats
    links: Integers
    vibrissa: Vibrissa
    base: Floats
    chords: Floats
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
        """Beads at most `spacing` apart, and at least two to a link, or one at each link's end.

        Parameters
        ----------
        joints : array, shape (n,)
            Arc lengths where cells of a uniform beam bend; one that varies bends as far from there
            as the centroid of a cell's compliance is from its middle [L].
        cells : array, shape (n,)
            Their lengths [L].
        edges : array, shape (n + 1,)
            Where one cell ends and the next one begins [L].
        spacing : float
            Of the beads [L]; infinite for one a link.
        vibrissa : Vibrissa, optional
            Straight, uniform and rigidly clamped if it is not given.

        Returns
        -------
        Layout
            With a joint more if the clamp turns.
        """
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
        """Let beads be elsewhere on their links.

        Parameters
        ----------
        beads : array of int, shape (n,)
            Their numbers.
        places : array, shape (n,)
            Their arc lengths [L].
        """
        self.beads[beads] = places
        self.__dict__.pop("from_links", None)

    def tip_angle(self, angles: Floats) -> float:
        """Slope angle of the tip.

        Parameters
        ----------
        angles : array, shape (n_joints,)
            Turns of the joints [rad].

        Returns
        -------
        float
            Angle from the foot line [rad].
        """
        return np.pi / 2 + float(angles.sum()) + self._tip_turn

    @cached_property
    def _tip_turn(self) -> float:
        """Of the unloaded tip from the upright, to the left [rad]."""
        return float(self.vibrissa.turn(np.array(1.0)))

    def step(self, link: int) -> tuple[Floats, float]:
        """From one link's frame to the next one's, unloaded.

        A link's frame has its origin where the link begins, and its y axis along the chord; the
        foot's is upright.

        Parameters
        ----------
        link : int
            Number of the link; the one before it is the foot, for 0.

        Returns
        -------
        offset : array, shape (2,)
            Of the link's origin, in the frame before [L].
        turn : float
            Of the link's axes from the axes before [rad].
        """
        before, heading = np.zeros(2), 0.0
        if link > 0:
            before, heading = self.base[link - 1], float(self.headings[link - 1])
        return turned(self.base[link] - before, -heading), self.headings[link] - heading

    def within(self, link: int, s: Floats) -> Floats:
        """Where arc lengths are in the frame of their link.

        Parameters
        ----------
        link : int
            Number of the link.
        s : array, shape (n,)
            Arc lengths [L].

        Returns
        -------
        array, shape (2, n)
            Across and along the chord [L].
        """
        there = self.vibrissa.at(s) - self.base[link]
        return turned(there.T, -float(self.headings[link]))


def turned(vector: Floats, angle: float | Floats) -> Floats:
    """A vector, turned to the left.

    Parameters
    ----------
    vector : array, shape (2, ...)
        One, or several.
    angle : float, or array, shape (...)
        Angle [rad].

    Returns
    -------
    array, shape of `vector`
        The turned ones.
    """
    cos, sin = np.cos(angle), np.sin(angle)
    return np.array([cos * vector[0] - sin * vector[1], sin * vector[0] + cos * vector[1]])


def bead_spacing(segments: int, radius: float, curvature: float) -> float:
    """How far apart beads may be on a beam of so many segments [L].

    Parameters
    ----------
    segments : int
        Number of segments.
    radius : float
        Of the vibrissa [L].
    curvature : float
        Largest curvature of the contour, may be 0 [1/L].

    Returns
    -------
    float
        Spacing [L].
    """
    turning = OF_CURVATURE / max(curvature, OF_CURVATURE)
    of_contact = max(min(_OF_RADIUS * radius, turning), _LEAST)
    return min(of_contact, max(_OF_CELLS / segments**2, _LEAST_OF_CELLS))


def vertices(settings: Settings, grading: float = 0.0) -> Floats:
    """Arc lengths of the vertices of a beam that MuJoCo builds from N segments.

    The first segment is rigid in the clamp. If it straddles the clamp, as much before it as behind,
    the vertices that bend sit at the centres of their cells, and the beam is of second order; if it
    begins there (the naive beam), it is of first order.

    Parameters
    ----------
    settings : Settings
        Number of segments, and which clamp.
    grading : float
        How much longer segments grow towards the tip: by (1 + 3 grading) from the clamp on. The
        naive beam has equal ones.

    Returns
    -------
    array, shape (N + 1,)
        Arc lengths, ascending [L].
    """
    n = settings.segments
    if settings.clamp == "naive":
        return np.asarray(np.arange(n + 1) / n)
    # An odd and smooth map of equal segments: it keeps the symmetry at the clamp, and the order.
    u = (np.arange(n + 1) - 0.5) / (n - 0.5)
    return np.asarray(u * (1 + grading * u**2) / (1 + grading))
