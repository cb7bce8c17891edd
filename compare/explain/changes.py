"""Which sweeps a budget needs: the one in question, and others that differ in one thing each."""

from dataclasses import replace

from analytic import InputError
from mujoco_models.settings import Settings

STIFFER = 10  # times the contact stiffness
SHARPER = 10  # times less of the corners' radius
CALMER = 100  # times less out of balance
_AT_REST = 1e-8  # EI/L; what all the other sweeps are out of balance by at most


def controlled_changes(
    settings: Settings, smooth: bool = True, corners: bool = False
) -> dict[str, Settings]:
    """The settings of all sweeps by name; ``base`` is the one that the budget is of.

    They lead from the base to the exact problem, one thing after the other: ``calm`` is more at
    rest, ``smooth`` has no facets, ``sharp`` has sharper corners, ``stiff`` has harder contacts,
    and ``two`` and ``four`` have more segments too. Facets come first, for without them the beam's
    order is plain to see, and segments last, since they bring more beads, which share the load and
    so harden a loose contact.
    """
    n, k = settings.segments, settings.contact_stiffness
    for name, value, most in (("segments", n, 250), ("contact_stiffness", k, 1e8)):
        if value > most:
            raise InputError(
                f"mujoco.{name} of a budget", value, f"at most {most:g}", "it is refined from there"
            )
    if corners and settings.corner_radius < 1e-8:
        raise InputError(
            "mujoco.corner_radius of a budget",
            settings.corner_radius,
            "at least 1e-08",
            "it is refined from there",
        )
    rest = replace(settings, tolerance=min(settings.tolerance, _AT_REST))
    plain = replace(rest, obstacle="primitive") if smooth else rest
    sharp = replace(plain, corner_radius=settings.corner_radius / SHARPER) if corners else plain
    stiff = replace(sharp, contact_stiffness=STIFFER * k)
    return {
        "base": settings,
        "calm": replace(settings, tolerance=min(settings.tolerance / CALMER, _AT_REST)),
        "smooth": plain,
        **({"sharp": sharp} if corners else {}),
        "stiff": stiff,
        "two": replace(stiff, segments=2 * n),
        "four": replace(stiff, segments=4 * n),
    }
