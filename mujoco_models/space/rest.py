"""A vibrissa at rest in space: foreseen where that can be, and confirmed by MuJoCo's own balance.

On a mesh a forecast knows where Newton's method leads, and mostly one look at MuJoCo's balance
confirms it; universal joints of the chain, which do not bend alike in all directions, and smooth
bodies have none.
"""

from typing import NamedTuple

import numpy as np

from analytic.numerics.arrays import Floats
from mujoco_models.space.balance import SHARE, Balance, State
from mujoco_models.space.forecast import Forecast, Planar
from mujoco_models.space.model import SpaceModel, Touch
from mujoco_models.space.surface import Surface, surface_at

_OVERLOOKED = 1e-8  # L; as deep as another link may be
_SWITCHES = 6  # to another link that is deeper
_DRIFT = 1e-10  # L off the mesh, from which on a face, edge or corner is found anew


class Settled(NamedTuple):
    """A state at rest."""

    state: State
    touch: Touch
    stable: bool
    surface: Surface  # what it touches
    stays: bool  # whether that is where the body is, and no other link is deeper
    tangents: Floats  # unit vectors along the links, shape (n_links, 3)
    planar: Planar | None  # what a forecast starts from; None past what there is none for


class Rest:
    """Where a model comes to rest."""

    def __init__(self, model: SpaceModel, tolerance: float) -> None:
        self.model, self._tolerance = model, tolerance
        self.balance = Balance(model, tolerance)
        self.forecast = None
        if model.beam.law is not None:
            self.forecast = Forecast(
                model.layout, model.beam.law, model.tangent, model.radius, model.contact_stiffness
            )

    def settle(
        self,
        start: State,
        surface: Surface,
        begin: Floats,
        foot: Floats,
        near: Floats | None = None,
        far: float = np.inf,
    ) -> Settled | None:
        """The equilibrium to which Newton's method leads; a stable one, if that is foreseen.

        Its first step is one along the branch: of the linearised equations at the start.
        """
        self.model.place(begin, start.configuration)
        planar = self._planar(start, surface)
        if planar is None:
            along = self.balance.along(start, surface, foot - begin)
            return self._settled(along, None, surface, foot)
        return self._foreseen(planar, surface, foot, near, far)

    def follow(
        self, held: Settled, begin: Floats, foot: Floats, far: float = np.inf
    ) -> Settled | None:
        """The stable equilibrium on the same surface to which Newton's method leads."""
        if held.planar is None:
            found = self.settle(held.state, held.surface, begin, foot)
        else:
            found = self._foreseen(held.planar, held.surface, foot, held.touch.centre, far)
        return found if found is not None and found.stable else None

    def _foreseen(
        self, start: Planar, surface: Surface, foot: Floats, near: Floats | None, far: float
    ) -> Settled | None:
        """Where it will rest stably, as MuJoCo has it."""
        assert self.forecast is not None and surface.feature is not None
        planar = self.forecast.rest(start, surface.feature, foot, near, far)
        if planar is None or not planar.stable:
            return None
        return self.confirm(planar, surface, foot)

    def confirm(self, planar: Planar, surface: Surface, foot: Floats) -> Settled | None:
        """The equilibrium by MuJoCo's own balance, next to a forecast that stays where the mesh is.

        What has left its face, edge or corner is nowhere to rest; it only says where it left.
        """
        assert self.forecast is not None
        state, touch = self._bent(planar), surface.touched(self.forecast.centre(planar, foot))
        if not surface.holds(planar.link, touch.centre):
            tangents = self._tangents(planar)
            return Settled(state, touch, planar.stable, surface, False, tangents, planar)
        return self._settled(state, planar, surface, foot)

    def _settled(
        self, state: State, planar: Planar | None, surface: Surface, foot: Floats
    ) -> Settled | None:
        """The equilibrium next to a state, where nothing is deeper."""
        model = self.model
        for _ in range(_SWITCHES):
            found = self.balance.converge(state, surface, foot)
            if found is None or found[0].force <= 0:
                return None
            forecast, (state, touch) = state, found
            deepest = touch.distance - model.shape.inscribed - _OVERLOOKED
            depth, link, s = model.deeper_link(touch, deepest)
            near = depth >= deepest
            if surface.feature is not None:
                stays = surface.holds(state.link, touch.centre)
                if near and stays and surface.missed(state.link, touch.centre) > _DRIFT:
                    surface = surface_at(model, model.touch(state.link, state.s))
                    continue  # found anew, here
                near = near and stays
            elif not near:
                state = state._replace(link=link, s=s, force=0.0, sliding=False)
                continue
            if planar is None or state.configuration is not forecast.configuration:
                stable = self.balance.is_stable(state, touch, surface)
                planar = self._planar(state, surface)
            else:
                stable = planar.stable
                planar = planar._replace(link=state.link, s=state.s, sliding=state.sliding)
            return Settled(state, touch, stable, surface, near, model.tangents, planar)
        return None

    def softest(self, found: Settled, foot: Floats) -> tuple[float, Floats]:
        """How stable an equilibrium is."""
        state = found.state
        self.model.place(foot, state.configuration)
        touch = found.surface.touch(state.link, state.s)  # which a prism's cylinder follows
        return self.balance.softest(state, touch, found.surface)

    def exactly(self, found: Settled, foot: Floats) -> Settled | None:
        """The same where the mesh has it to rounding: a face's direction is known to less."""
        model, state = self.model, found.state
        if found.surface.feature is None:
            return found
        model.place(foot, state.configuration)
        missed = found.surface.missed(state.link, found.touch.centre)
        if missed * model.contact_stiffness <= SHARE * self._tolerance:
            return found
        surface = surface_at(model, model.touch(state.link, state.s))
        return self._settled(state, found.planar, surface, foot)

    def _planar(self, state: State, surface: Surface) -> Planar | None:
        """What a forecast needs of a state in which the model is; None where there is none."""
        forecast = self.forecast
        if forecast is None or surface.feature is None or state.force <= 0:
            return None
        force = state.force * surface.touch(state.link, state.s).normal
        return forecast.planar(self.model.tangents, state.link, state.s, force, state.sliding)

    def _tangents(self, planar: Planar) -> Floats:
        """Along the links of a forecast."""
        along, aside = np.cos(planar.angles), np.sin(planar.angles)
        return np.asarray(np.outer(along, self.model.tangent) + np.outer(aside, planar.side))

    def _bent(self, planar: Planar) -> State:
        """A forecast in MuJoCo's coordinates."""
        configuration = self.model.beam.bent(self.model.frame, planar.side, planar.angles)
        force = float(np.linalg.norm(planar.force))
        return State(configuration, planar.link, planar.s, force, planar.sliding)
