"""What a measured model is along its vibrissa, beside what its material would have."""

import numpy as np
from matplotlib.figure import Figure

from analytic.numerics.arrays import Floats
from mujoco_models.inspect.measured import MeasuredBeam

_SIZE = 7.0, 5.0  # inches


def profile(found: MeasuredBeam) -> dict[str, tuple[Floats, Floats]]:
    """By name, what each joint has, and what a round and solid beam of its radius would have.

    The material is that which the median joint is made of: EI goes with r^4, the mass with r^2, and
    dampers with the stiffness.
    """
    s, cells, compliances, angles, damping, masses = np.array([
        [j.s, j.cell, j.compliance, j.angle, j.damping, j.mass] for j in found.joints
    ]).T  # fmt: skip
    radius = np.interp(s, [g.middle for g in found.geoms], [g.radius for g in found.geoms])
    links = np.diff(s, append=found.length)
    measured = {
        "EI": (cells / compliances, radius**4),
        "curvature": (angles / cells, np.ones_like(s)),
        "mass per length": (masses / links, radius**2),
        "damping times cell": (damping * cells, radius**4),
    }
    return {name: (own, law * np.median(own / law)) for name, (own, law) in measured.items()}


def picture(found: MeasuredBeam) -> Figure:
    figure = Figure(figsize=_SIZE, layout="constrained")
    s = np.array([joint.s for joint in found.joints]) / found.length
    for ax, (name, (own, material)) in zip(
        figure.subplots(2, 2, sharex=True).flat, profile(found).items(), strict=True
    ):
        ax.plot(s, own, "o", markersize=4, label="the model's joints")
        ax.plot(s, material, color="0.4", label="one material of these radii")
        ax.set_title(name, fontsize=10)
        ax.set_ylim(min(0.0, 1.2 * float(own.min())), 1.3 * max(float(own.max()), 1e-300))
    figure.axes[0].legend(frameon=False, fontsize=8)
    figure.supxlabel("arc length over length", fontsize=9)
    figure.suptitle(f"{found.model or 'model'}, in its own units", fontsize=11)
    return figure
