"""What a sweep in motion asks of a model, ours or a user's."""

from typing import Any, Protocol

from mujoco_models.model.clamp import Clamp


class Moving(Protocol):
    """A model in motion; dimensionless, L = EI = T1 = 1.

    Attributes
    ----------
    time : float
        Of the state that is reported: MuJoCo's sensors are of the beginning of a step [T1].
    """

    time: float

    @property
    def now(self) -> float:
        """Time of the present state [T1]."""

    @property
    def foot_x(self) -> float:
        """Where the foot is [L]."""

    @property
    def touches(self) -> bool:
        """Whether a contact is loaded."""

    @property
    def label(self) -> str:
        """What the object is."""

    def step(self, speed: float) -> None:
        """One step, at whose end the foot has a speed to the left.

        Parameters
        ----------
        speed : float
            Of the foot [L/T1].
        """

    def clamp(self) -> Clamp:
        """The clamp's action on the vibrissa.

        Returns
        -------
        Clamp
            At the foot [EI/L^2, EI/L].
        """

    def state(self, speed: float) -> dict[str, Any]:
        """What else there is to say of the state that is reported.

        Parameters
        ----------
        speed : float
            Of the foot [L/T1].

        Returns
        -------
        dict
            By column.
        """
