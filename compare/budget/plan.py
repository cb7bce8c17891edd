"""Which sweeps a budget needs: the one in question, and others that differ in one thing each."""

from dataclasses import replace

from mujoco_models.settings import Settings

REFINED = 4  # times the facets
STIFFER = 10  # times the contact stiffness
CALMER = 100  # times less out of balance


def controlled_changes(settings: Settings) -> dict[str, Settings]:
    """The settings of all sweeps by name; ``base`` is the one that the budget is of.

    Facets are changed where segments are finest, lest a long rigid link bridge several of them, and
    stiffness where facets are finest: a soft contact spreads the load over several and hides them.
    """
    n, points, k = settings.segments, settings.contour_points, settings.contact_stiffness
    smooth = replace(settings, contour_points=REFINED * points)
    return {
        "base": settings,
        "two": replace(settings, segments=2 * n),
        "four": replace(settings, segments=4 * n),
        "four_smooth": replace(smooth, segments=4 * n),
        "smooth": smooth,
        "smooth_stiff": replace(smooth, contact_stiffness=STIFFER * k),
        "calm": replace(settings, tolerance=settings.tolerance / CALMER),
    }
