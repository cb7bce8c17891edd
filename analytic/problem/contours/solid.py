"""What a contour may be the lower side of, beyond the plane of the sweep."""

from dataclasses import dataclass, replace

from analytic.problem.arrays import Floats


@dataclass(frozen=True, eq=False)
class ConvexMesh:
    """The hull of points, cut by the plane of the sweep at z = 0.

    Parameters
    ----------
    vertices : array, shape (n, 3)
        In the case's frame [length].
    tilt : float
        The largest z component of its unit normals along the lower side of the section: 0 where
        the mesh is a prism there, or symmetric about the plane.
    name : str
        Of the file.
    """

    vertices: Floats
    tilt: float
    name: str

    def scaled(self, factor: float) -> "ConvexMesh":
        """Enlarged by `factor` about the origin."""
        return replace(self, vertices=factor * self.vertices)

    def mirrored(self) -> "ConvexMesh":
        """The mirror image, x to -x."""
        return replace(self, vertices=self.vertices * [-1, 1, 1])
