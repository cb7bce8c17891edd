"""What a contour may be the lower side of, beyond the plane of the sweep."""

from dataclasses import dataclass


@dataclass(frozen=True)
class EllipticCylinder:
    """A cylinder along z whose section is an ellipse with axes along x and y, or a circle.

    Parameters
    ----------
    centre : tuple of float
        Of the section [length].
    semi_axes : tuple of float
        Along x, along y [length].
    """

    centre: tuple[float, float]
    semi_axes: tuple[float, float]

    def scaled(self, factor: float) -> "EllipticCylinder":
        """Enlarged by `factor` about the origin."""
        (x, y), (across, upward) = self.centre, self.semi_axes
        return EllipticCylinder((factor * x, factor * y), (factor * across, factor * upward))

    def mirrored(self) -> "EllipticCylinder":
        """The mirror image, x to -x."""
        return EllipticCylinder((-self.centre[0], self.centre[1]), self.semi_axes)
