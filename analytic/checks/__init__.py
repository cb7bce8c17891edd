"""The paper's own routes to the tip's angle, and the boundary value problem solved directly.

Slower and less exact than `analytic.solver`, with which they share nothing but the problem: they
are what it is tested and timed against. Dimensionless, one contact at a time.
"""

from analytic.checks.boundary_value import boundary_value_problem
from analytic.checks.quadrature import tip_angle_by_quadrature
from analytic.checks.shooting import tip_angle_by_shooting

__all__ = ["boundary_value_problem", "tip_angle_by_quadrature", "tip_angle_by_shooting"]
