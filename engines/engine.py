"""What an engine is: a sweep, and what it says of itself."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Literal, Protocol, TypeAlias

from analytic.problem.case import Case
from mujoco_models.settings import Settings

if TYPE_CHECKING:  # whether a case names known engines is checked before pandas is needed
    from analytic.problem.readings import Readings

Role: TypeAlias = Literal["subject", "twin", "other model"]
"""Of an engine in a comparison of many.

The ``subject`` is MuJoCo. A ``twin`` computes MuJoCo's very model, with the same settings: what it
differs by from MuJoCo is implementation. An ``other model`` has a discretisation of its own.
"""


class Engine(Protocol):
    """What can sweep a case; found by `engines.find_engine`.

    It never sees the exact solution: `analytic.problem` states the case, and that is all. It may
    say more of itself: ``role``, one of `Role`, ``"other model"`` by default; ``requires``, the
    distribution that it needs, as pip writes it (``"drake>=1.40,<2"``); ``tuned``, what was set
    for it, why and by whom, for a fair comparison.
    """

    def sweep(
        self, case: Case, settings: Settings, advance: Callable[[], None] = lambda: None
    ) -> "Readings":
        """Sweep a case quasi-statically, at rest at every station.

        Parameters
        ----------
        case : Case
            The problem, whichever way its foot moves: `analytic.problem.recorder` turns it.
        settings : Settings
            Number of segments, contact stiffness and the like; what has no meaning for the engine
            it ignores.
        advance : callable
            To be called after every station.

        Returns
        -------
        Readings
            A row a station, in the units of the case's beam. A station that cannot be trusted is
            there with another status than ``"ok"``. ``provenance["engine"]`` is its name and
            version, ``provenance["seconds"]`` the processor time, and
            ``provenance["events"]["snap_off"]`` where the vibrissa let go.

        Raises
        ------
        InputError
            If the engine has no such vibrissa, object or contact.
        DivergedError
            If it is not a number any more.
        """
