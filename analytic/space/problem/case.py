"""The problem in space: a vibrissa, a convex body, and the way of the foot."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from analytic.problem.beam import Beam
from analytic.problem.errors import InputError, require
from analytic.problem.numbers import within
from analytic.problem.shown import Shown, described, new_figure
from analytic.problem.support import require_plain
from analytic.space.problem.bodies.body import Body
from analytic.space.problem.bodies.polyhedron import Polyhedron
from analytic.space.problem.path import FootPath, StraightVibrissa

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from mpl_toolkits.mplot3d import Axes3D

_FARTHEST = 1e4  # L, from the origin: positions are then good to 2e-12 L
_LARGEST = 1e3  # L, of a mesh: a larger one is a wall, or in another unit
_LEAST_FRICTION = 1e-6
_SMALLEST = 1e-3  # L: a smaller one is a grain, or in another unit


@dataclass(frozen=True, repr=False)
class SpatialCase(Shown):
    """What every engine is given: physics only, no numerics.

    The frame is that of the planar problem: y is up, the base plane is normal to it, x, y and z are
    right-handed.

    Parameters
    ----------
    beam : Beam
        The vibrissa, straight and uniform.
    body : Body
        In the unit of length of `beam`.
    path : FootPath
        The way of the foot, likewise.
    friction : float
        Coulomb's coefficient, 0 or from 1e-6 to 1. It acts on the vibrissa's axis: with a radius
        the body is thicker by that, and a moment of at most radius times friction is left out.
    name : str
        What files and reports call the case.

    Raises
    ------
    InputError
        If a field is of another kind, the vibrissa is not the paper's, the way does not start clear
        of the body or never touches it, or the body is too far away, too large or too small.
    """

    beam: Beam = field(default_factory=Beam)
    body: Body = field(kw_only=True)
    path: FootPath = field(kw_only=True)
    friction: float = field(default=0.0, kw_only=True)
    name: str = field(default="case", kw_only=True)

    def __post_init__(self) -> None:
        for name, kind, remedy in (
            ("beam", Beam, "as Beam(length=..., flexural_rigidity=...)"),
            ("body", Body, "as sphere(1.0, centre=(0, 1.4, 0))"),
            ("path", FootPath, "as FootPath([[1, 0.2], [-1, 0.2]])"),
            ("name", str, "it names files and reports"),
        ):
            require(f"case.{name}", getattr(self, name), kind, remedy)
        require_plain("a sweep in space", self.beam)
        usual = "0 is none, 0.1 to 0.5 is usual"
        if within("friction", self.friction, 0.0, 1.0, usual):  # less is lost in rounding
            within("friction", self.friction, _LEAST_FRICTION, 1.0, usual)
        if self.friction and not self.body.smooth and self.beam.radius == 0:
            allowed = f"0 for a vibrissa without a radius past edges ({self.body.label})"
            raise InputError("friction", self.friction, allowed, "give the vibrissa a radius")
        self._check_place()
        way = self.way
        begin = way.gap(0.0)
        if begin.size <= 0:
            allowed = f"such that the straight vibrissa starts clear of the {self.body.label}"
            foot = way.foot(0.0) * self.beam.length
            raise InputError("path.points[0]", foot, allowed, "start farther away")
        into = way.meets_clamp()
        if into is not None:
            what = f"into the body ({self.body.label}) at {self._place(into)}"
            remedy = "raise the body, or move the path"
            raise InputError("path", what, "past it: the clamp has to pass, too", remedy)
        if way.next_touch(0.0) is None:
            travel, gap = way.nearest()
            distance = f"at a distance of {gap.size:.4g} L, with the foot at {self._place(travel)}"
            what, remedy = f"passing the {self.body.label} {distance}", "check body, path and unit"
            raise InputError("path", what, "within reach of the vibrissa", remedy)

    @property
    def way(self) -> StraightVibrissa:
        """The straight vibrissa along the way of its foot, in units of its length."""
        length = self.beam.length
        return StraightVibrissa(self.body.scaled(1 / length), self.path, length, self.beam.radius)

    def provenance(self) -> dict[str, Any]:
        """What readings of this case say of it.

        Returns
        -------
        dict
            Anything JSON can hold.
        """
        return {
            "case": self.name,
            "frame": "world, y up, right-handed; the clamp's action on the vibrissa at the foot",
            "body": self.body.label,
            **({"friction": self.friction} if self.friction else {}),
            "path": {
                "points": np.asarray(self.path.points).tolist(),
                "height": self.path.height,
                "tangent": self.path.clamp_tangent.tolist(),
            },
        }

    def plot(self, ax: "Axes3D | None" = None) -> "Axes3D":
        """Draw the body, the way of the foot, and the vibrissa at its corners.

        Parameters
        ----------
        ax : mpl_toolkits.mplot3d.Axes3D, optional
            New ones if not given.

        Returns
        -------
        mpl_toolkits.mplot3d.Axes3D
            With equal scales, the case's y upwards.
        """
        ax = new_figure().add_subplot(projection="3d") if ax is None else ax
        feet = self.path.corners
        tips = feet + self.beam.length * self.path.clamp_tangent
        middle, reach = (feet + tips).mean(axis=0) / 2, 1.5 * self.beam.length
        from mpl_toolkits.mplot3d.art3d import Poly3DCollection

        faces = self.body.patches(middle, reach)
        near = faces[(np.abs(faces - middle) <= reach).all(axis=(1, 2))]
        ax.add_collection3d(Poly3DCollection(near[..., [0, 2, 1]], facecolor="#dddddd80"))
        ax.plot(feet[:, 0], feet[:, 2], feet[:, 1], "--", color="#555555", label="way of the foot")
        for foot, tip in zip(feet, tips, strict=True):
            ax.plot(*np.stack([foot, tip])[:, [0, 2, 1]].T, color="#0072b2")
        ax.set(xlabel="x", ylabel="z", zlabel="y", aspect="equal")
        ax.legend()
        return ax

    def _draw(self, figure: "Figure") -> None:
        self.plot(figure.add_subplot(projection="3d"))

    def _tiles(self) -> dict[str, object]:
        return {
            "case": self.name,
            "body": self.body.label,
            "beam": described(self.beam),
            "stations": f"{self.path.stations}, travel from 0 to {self.path.marks[-1]:.4g}",
        }

    def _place(self, travel: float) -> str:
        x, _, z = (np.round(self.way.foot(travel), 12) + 0.0) * self.beam.length
        return f"({x:.4g}, {z:.4g})"

    def _check_place(self) -> None:
        length = self.beam.length
        far = float(np.abs(self.path.corners).max()) / length
        near = f"within {_FARTHEST:g} L of the origin"
        if far > _FARTHEST:
            raise InputError("path.points", f"{far:.4g} L away", near, "check their unit")
        if not isinstance(self.body, Polyhedron):
            return
        low, high = self.body.vertices.min(axis=0), self.body.vertices.max(axis=0)
        size, away = float((high - low).max()), float(np.abs([low, high]).max())
        what = f"body ({self.body.label})"
        if not _SMALLEST * length <= size <= _LARGEST * length:
            allowed = f"{_SMALLEST:g} to {_LARGEST:g} L"
            remedy = 'the file is in another unit: give that as scale, 1e-3 or "1 mm"'
            raise InputError(what, f"{size / length:.4g} L in size", allowed, remedy)
        if away > _FARTHEST * length:
            x, y, z = (low + high) / 2
            around = f"around ({x:.4g}, {y:.4g}, {z:.4g})"
            raise InputError(what, around, near, "move it with offset, or check its unit")
