"""Cases and readings that not everybody can take: who cannot do with what refuses it."""

from analytic.problem.beam import Beam, Varying
from analytic.problem.clamp_path import ClampWay, Sweep
from analytic.problem.contours.contour import Contour
from analytic.problem.errors import InputError, require
from analytic.problem.support import (
    Support,
    beyond_the_paper,
    is_plain,
    refuse,
    require_plain,
    require_weightless,
)


def given_contour(profile: Contour, beam: Beam) -> Contour:
    """What the centreline feels, a cone's at its tip, in units of the vibrissa's length."""
    require("profile", profile, Contour, "as catenary(0.5, -0.8), or a case's profile")
    require("beam", beam, Beam, "as Beam(length=..., flexural_rigidity=...)")
    return profile.scaled(1 / beam.length).offset(beam.unloaded.tip_radius)


class OfVibrissa:
    """What is of a vibrissa in a clamp: a case, or its readings."""

    beam: Beam

    @property
    def support(self) -> Support:
        raise NotImplementedError

    @property
    def beyond_the_paper(self) -> dict[str, Varying]:
        """What of vibrissa, clamp and contact is not the paper's, by what it is."""
        return beyond_the_paper(self.beam, self.support)

    def require_sweep(self, who: str) -> object:
        """Refuse a clamp that turns or leaves its line on its way, for who cannot do with that."""
        raise NotImplementedError

    def require_plain(self, who: str) -> None:
        """Refuse what is not of the paper's vibrissa, for who can take nothing else."""
        require_plain(who, self.beam, self.support)
        self.require_sweep(who)


class AnyCase(OfVibrissa):
    """What there may be in a case."""

    sweep: ClampWay
    others: tuple[Contour, ...]

    @property
    def is_plain(self) -> bool:
        """Whether vibrissa and object are the paper's: straight, uniform, upright, one contour."""
        one = not self.others and isinstance(self.sweep, Sweep)
        return one and is_plain(self.beam, self.support)

    def require_upright(self, who: str) -> None:
        """Refuse a clamp that leans, turns or leaves its line, and a weight."""
        self.require_sweep(who)
        require_weightless(who, self.support)
        refuse(who, "clamp_angle", self.support.clamp_angle, 0.0)

    def require_sweep(self, who: str) -> Sweep:
        """Refuse several objects, and a clamp that turns or leaves its line on its way."""
        self.require_one_object(who)
        return self.require_line(who)

    def require_one_object(self, who: str) -> None:
        if self.others:
            allowed = f"1: {who} can take no more"
            remedy = "solve it in closed form (exact), sweep MuJoCo in motion, or sweep past one"
            raise InputError("number of objects", 1 + len(self.others), allowed, remedy)

    def require_line(self, who: str) -> Sweep:
        """Refuse a clamp that turns or leaves its line on its way."""
        if not isinstance(self.sweep, Sweep):
            what = "of a clamp that turns" if self.sweep.running == "clamp_angle" else "of any path"
            allowed = f"a Sweep, with the foot along its line: {who} can do no other"
            remedy = "take the closed form or MuJoCo"
            raise InputError("way of the clamp", what, allowed, remedy)
        return self.sweep
