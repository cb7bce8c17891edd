"""Figures 12, 14, 15 and 16 of Behn's group, redrawn from the solver for any case.

C. Will, J. Steigenberger, C. Behn, *Quasi-static object scanning using technical vibrissae*.
``python -m docs.figures.paper CASE DIR`` writes them, and the vibrissa at some stations.
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from analytic import (
    CLAMP_READINGS,
    Case,
    Readings,
    find_events,
    reconstruct,
    reconstruct_by_decision,
    solve_sweep,
    surplus,
)
from compare.read.case import load_job
from compare.show import style
from compare.show.figures.geometry import at_equal_scales, reconstruction
from compare.show.figures.over_foot import foot, unit
from compare.show.page import write_all

_A, _B = style.PHASE_COLOURS["tip"], style.PHASE_COLOURS["tangent"]


def paper_figures(case: Case, readings: Readings) -> dict[str, Figure]:
    """Draw the paper's figures for a case, as far as they are of its vibrissa."""
    case.require_sweep("the paper's figures")
    if case.beam.varies:
        return {"figure-14": profile(readings), "figure-15": observables(readings)}
    return {
        **({"figure-12": contact_length(case)} if case.is_plain else {}),
        "figure-14": profile(readings),
        "figure-15": observables(readings),
        "figure-16": reconstruction_error(readings),
        "shapes": reconstruction(readings, reconstruct(readings)),
    }


def contact_length(case: Case) -> Figure:
    """Draw fig. 12: s1 of eq. 21 over the contour, with the limits of Phase B."""
    figure = Figure(figsize=(6.5, 4), layout="constrained")
    ax = figure.subplots()
    case.require_plain("figure 12")
    events = find_events(case.profile, case.beam)
    centreline, length = case.centreline, case.beam.length
    first = events.first_contact.contact_angle
    lowest = events.contact_length_minimum.contact_angle
    angle = np.linspace(first, min(events.snap_off.contact_angle, 2 * lowest - first), 801)[1:]
    shortened = surplus(centreline, centreline.parameter(angle))
    s1 = 1 / (1 - shortened)
    ax.plot(np.rad2deg(angle), np.where(shortened < 1, s1, np.nan), color=style.INK)
    ax.axhline(1, color=style.FAINT, linestyle="--", linewidth=0.9)
    for name, event, colour in (
        ("start of Phase B", events.phase_b_start, _B),
        ("end of Phase B", events.phase_b_end, _A),
        ("least $s_1$", events.contact_length_minimum, style.GREEN),
    ):
        if event is not None:
            ax.plot(
                np.rad2deg(event.contact_angle),
                event.contact_arc_length / length,
                "o",
                color=colour,
                label=f"{name}: {np.rad2deg(event.contact_angle):.4g}°, "
                f"{event.contact_arc_length / length:.4g} L",
            )
    ax.set_xlabel(r"slope angle $\alpha$ of the contour / °")
    ax.set_ylabel("$s_1$ / $L$  (eq. 21)")
    ax.set_ylim(0, 2)
    ax.legend(fontsize=style.SMALL, frameon=False)
    return figure


def profile(readings: Readings) -> Figure:
    """Draw fig. 14: the contour, with the contacts of the sweep by phase."""
    figure = Figure(layout="constrained")
    ax = figure.subplots()
    scale = readings.beam.length
    xi, eta = (np.asarray(c) / scale for c in readings.provenance["contour"])
    ax.plot(xi, eta, color=style.INK, linewidth=1)
    for phase, name, colour in (("tip", "Phase A", _A), ("tangent", "Phase B", _B)):
        here = (readings.table["phase"] == phase).to_numpy()
        x, y = readings.values("contact_x")[here], readings.values("contact_y")[here]
        ax.plot(x / scale, y / scale, ".", color=colour, label=name)
    ax.set_xlabel(r"$\xi$ / $L$")
    ax.set_ylabel(r"$\eta$ / $L$")
    ax.set_title(style.label(readings.provenance["profile"]), fontsize=style.NORMAL)
    figure.legend(loc="outside lower center", ncols=2, frameon=False)
    at_equal_scales(figure, [ax], 6.5)
    return figure


def observables(readings: Readings) -> Figure:
    """Draw fig. 15: clamp force, clamp moment and the error of the reconstruction over x0."""
    figure = Figure(figsize=(9, 6), layout="constrained")
    axes = figure.subplots(2, 2).ravel()
    x = foot(readings)
    for ax, name in zip(axes[:3], CLAMP_READINGS, strict=True):
        for phase, colour in style.PHASE_COLOURS.items():
            here = (readings.table["phase"] == phase).to_numpy()
            ax.plot(
                x[here],
                readings.values(name)[here] / unit(readings, name),
                ".",
                color=colour,
                markersize=3,
            )
        ax.set_ylabel(style.axis_label(name))
    if readings.beam.varies:
        axes[3].set_visible(False)
    else:
        _error(axes[3], readings)
    for ax in axes:
        ax.set_xlabel("$x_0$ / $L$")
    return figure


def reconstruction_error(readings: Readings) -> Figure:
    """Draw fig. 16: the error of the reconstruction, by integration and in closed form."""
    figure = Figure(figsize=(6.5, 4), layout="constrained")
    ax = figure.subplots()
    _error(ax, readings)
    ax.set_xlabel("$x_0$ / $L$")
    return figure


def _error(ax: Axes, readings: Readings) -> None:
    """Distance of the reconstructed from the true contact, over the foot position."""
    scale = readings.beam.length
    found_by = {"closed form": reconstruct(readings)}
    if not readings.beyond_the_paper:
        found_by = {"(26) and integration": reconstruct_by_decision(readings), **found_by}
    for method, found in found_by.items():
        colour = style.INK if method == "closed form" else style.YELLOW
        error = np.hypot(
            found["contact_x"] - readings.values("contact_x"),
            found["contact_y"] - readings.values("contact_y"),
        )
        shown = np.maximum(error / scale, 1e-17)  # zero has no place on a logarithmic axis
        ax.semilogy(foot(readings), shown, ".", markersize=3, color=colour, label=method)
    ax.set_ylabel("error of the contact point / $L$")
    ax.legend(fontsize=style.SMALL, frameon=False)


if __name__ == "__main__":
    given, folder = load_job(sys.argv[1]).case, Path(sys.argv[2])
    figures = paper_figures(given, solve_sweep(given))
    for path in write_all(folder, {f"{name}.png": one for name, one in figures.items()}):
        print(path)
