"""One call for every simulation: in the plane or in space, at rest or in motion, by any engine."""

from collections.abc import Callable
from dataclasses import replace

from analytic import Case, InputError, Readings
from analytic.problem.errors import require
from analytic.space import SpatialCase, SpatialReadings
from mujoco_models import simulate_model, simulate_motion, simulate_space, simulate_sweep
from mujoco_models.allowed import CONTACT_STIFFNESSES
from mujoco_models.motion import Motion
from mujoco_models.settings import Settings, SpatialSettings
from mujoco_models.user_model.names import OwnModel

MUJOCO = "mujoco"


def _nothing(*_: object) -> None:
    pass


def simulate(
    case: Case | SpatialCase,
    settings: Settings | SpatialSettings,
    motion: Motion | None = None,
    model: OwnModel | None = None,
    engine: str = MUJOCO,
    advance: Callable[[], None] = _nothing,
    keep: Callable[..., None] = _nothing,
) -> Readings | SpatialReadings:
    """The sweep of a case: of our beam, or of a user's model; at rest if there is no motion.

    `advance` is called after every station. `keep` is given the stations so far when MuJoCo's sweep
    ends early; other engines keep none.
    """
    kinds = {"in space": isinstance(case, SpatialCase), "of a model": model, "in motion": motion}
    kind = next((name for name, is_so in kinds.items() if is_so), "")
    if kind and engine != MUJOCO:
        remedy = "the others sweep at rest, in the plane"
        raise InputError("engine", repr(engine), f"{MUJOCO} {kind}", remedy)
    if isinstance(case, SpatialCase):
        spatial = require("settings", settings, SpatialSettings, "as SpatialSettings(segments=40)")
        if motion is not None:
            return simulate_motion(case, motion, spatial, advance, keep)
        return simulate_space(case, spatial, advance, keep)
    settings = require("settings", settings, Settings, "as Settings(segments=40)")
    if model is not None:
        return simulate_model(case, model, motion, settings, advance, keep)
    if motion is not None:
        return simulate_motion(case, motion, settings, advance, keep)
    if engine == MUJOCO:
        return simulate_sweep(case, settings, advance, keep)
    from engines import find_engine  # engines are imported only where they are used
    from engines.apart import checked as checked_readings

    case.require_sweep(f"the engine {engine}")
    return checked_readings(find_engine(engine).sweep(case, settings, advance), case)


def at_rest(settings: Settings, motion: Motion | None) -> Settings:
    """Settings of the sweep at rest that one in motion tends to, with contacts as stiff as ours."""
    if motion is None or motion.solref is not None:
        return settings
    return softened(settings, motion)


def softened(settings: Settings, motion: Motion) -> Settings:
    """Settings at rest with contacts as stiff as ours are in a motion, as far as they can be."""
    least, largest = CONTACT_STIFFNESSES
    return replace(settings, contact_stiffness=min(max(motion.stiffness, least), largest))
