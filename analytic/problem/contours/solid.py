"""What a contour may be the lower side of, beyond the plane of the sweep."""

import math
from dataclasses import dataclass, replace

from analytic.problem.arrays import Floats


@dataclass(frozen=True, eq=False)
class ConvexMesh:
    """The hull of points, cut by the plane of the sweep at z = 0."""

    vertices: Floats  # shape (n, 3); In the case's frame [length]
    # The largest z component of its unit normals along the lower side of the section: 0 where the
    # mesh is a prism there, or symmetric about the plane. Where it is not, the section is not what
    # a bead touches; see `gap`.
    tilt: float
    name: str  # of the file

    def gap(self, radius: float) -> float:
        """How much earlier a bead touches the body than it would touch the section's prism."""
        return radius * (1 / math.sqrt(max(1 - self.tilt**2, 1e-300)) - 1)

    def scaled(self, factor: float) -> "ConvexMesh":
        return replace(self, vertices=factor * self.vertices)

    def mirrored(self) -> "ConvexMesh":
        return replace(self, vertices=self.vertices * [-1, 1, 1])
