"""A case as it stands: object, way of the foot, the vibrissa at rest at its start and end."""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from analytic.problem.beam import Beam

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from analytic.problem.case import Case


def described(beam: Beam) -> str:
    return f"length {beam.length:g}, EI {beam.base_rigidity:g}, radius {beam.radius:g}"


def draw(case: "Case", ax: "Axes") -> None:
    for one in (case, *case.alone):
        xi, eta = one.outline()
        ax.fill_between(xi, eta, eta.max(), color="#dddddd", linewidth=0)
        ax.plot(xi, eta, color="#555555", linewidth=2.5, label=one.profile.label)
    feet, s = case.stations, np.linspace(0, 1, 33)
    ax.plot(feet.foot_x, feet.foot_y, color="#999999", linewidth=0.8)
    for station, said, colour in ((0, "start", "#0072b2"), (-1, "end", "#d55e00")):
        foot_x, foot_y, angle = (part[station] for part in feet)
        x, y, _ = replace(case.unloaded, angle=float(angle)).at(s) * np.array(case.beam.length)
        ax.plot(foot_x + x, foot_y + y, color=colour, label=f"unloaded, at the {said}")
        ax.plot(foot_x, foot_y, "s", color=colour, markersize=4)
    ax.set(xlabel="x [m]" if case.beam.si else "x", ylabel="y [m]" if case.beam.si else "y")
    ax.set_aspect("equal", adjustable="datalim")
    ax.legend(fontsize="small")


def ways(case: "Case") -> str:
    """The stations in a few words."""
    along = case.running_values
    return f"{len(along)}, {case.sweep.running} from {along[0]:.4g} to {along[-1]:.4g}"
