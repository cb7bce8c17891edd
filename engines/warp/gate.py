"""A sweep at rest in double precision, looked at in single: where contacts are lost, and why.

Every state is MuJoCo's own, at rest. MuJoCo Warp then evaluates it, so that what differs is not the
way to a balance but the balance itself.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import pandas as pd

from analytic.problem.case import Case
from analytic.problem.errors import InputError
from engines.warp.resolution import across, chance_of_loss, covariance, force_deviation
from engines.warp.subject import evaluate
from mujoco_models.model.model import BeamModel
from mujoco_models.settings import Settings
from mujoco_models.sweep.sweep import set_out

STIFFNESSES = (1e4, 1e5, 1e6, 1e7, 1e8, 1e9)
"""Contact stiffnesses that are looked at, unless others are named [EI/L^3]."""


def gate(
    case: Case,
    settings: Settings,
    stiffnesses: Sequence[float] = STIFFNESSES,
    advance: Callable[[], None] = lambda: None,
) -> pd.DataFrame:
    """Evaluate MuJoCo's states at rest in single precision, for several contact stiffnesses."""
    if settings.beam != "chain" or not settings.planar:
        raise InputError(
            "beam for mujoco-warp",
            repr(settings.beam),
            "'chain' in the plane",
            "take --beam chain",
        )
    # The mirror image has the same numbers, but for the sign of x.
    leftward = case.mirrored() if case.foot_x[-1] > case.foot_x[0] else case
    rows = []
    for stiffness in stiffnesses:
        numerics = replace(settings, obstacle="primitive", contact_stiffness=stiffness)
        walk = set_out(leftward, numerics)
        for foot_x in (leftward.foot_x / leftward.beam.length).tolist():
            walk.go_to(foot_x)
            if walk.doubt is None and walk.model.contacts().loaded.any():
                about = {"contact_stiffness": stiffness, "foot_x": foot_x}
                rows.append(about | _looked_at(walk.model))
            advance()
    if not rows:
        raise InputError("case", case.name, "with a station in contact", "let the sweep reach it")
    return pd.DataFrame(rows)


def by_stiffness(table: pd.DataFrame) -> pd.DataFrame:
    """What was found and what was predicted, for each contact stiffness."""
    rows = []
    for stiffness, group in table.groupby("contact_stiffness"):
        largest = group["load"].max()
        off = (group["depth_error"] / group["resolution"]).dropna()
        rows.append(
            {
                "contact_stiffness": stiffness,
                "stations": len(group),
                "depth": group["depth"].median(),
                "resolution": group["resolution"].median(),
                "lost": int(group["lost"].sum()),
                "predicted_lost": group["chance"].sum(),
                "force_error": _rms(group["force_error"]) / largest,
                "predicted_force_error": _rms(group["predicted_force_error"]) / largest,
                "imbalance": _rms(group["imbalance"]),
                "predicted_imbalance": _rms(group["predicted_imbalance"]),
                "depth_error": _rms(off) if len(off) else np.nan,
            }
        )
    return pd.DataFrame(rows)


def _rms(numbers: pd.Series) -> float:
    return float(np.sqrt((numbers**2).mean()))


def _looked_at(model: BeamModel) -> dict[str, float | bool]:
    """A state at rest, in both precisions."""
    contacts, stiffness, single = model.contacts(), model.contact_stiffness, evaluate(model)
    depth, normal = -contacts.distance, contacts.normal
    together = covariance(model, normal, contacts.touch)
    deviation = np.sqrt(np.diag(together))
    force = stiffness * np.maximum(depth, 0) @ normal
    # The forces are as alike as the depths are, and each as far off as its contact lets it be.
    off = stiffness * force_deviation(depth, deviation) / deviation
    forces = np.outer(off, off) * together
    levers = (contacts.point[:, None] - model.joint_positions()) @ across(normal)[:, :, None]
    carried = np.arange(levers.shape[1]) <= contacts.link[:, None]
    moments = np.einsum("ij,ik,jk->k", forces, *2 * [carried * levers[:, :, 0]])
    deepest = int(np.argmax(depth))
    seen = -single.distance[contacts.touch[deepest]]
    return {
        "load": float(np.hypot(*force)),
        "depth": float(depth[deepest]),
        "resolution": float(deviation[deepest]),
        "depth_error": float(seen - depth[deepest]) if np.isfinite(seen) else np.nan,
        "lost": not (single.distance < 0).any(),
        "chance": chance_of_loss(depth, together),
        "force_error": float(np.hypot(*(single.force - force))),
        "predicted_force_error": float(np.sqrt((forces * (normal @ normal.T)).sum())),
        "imbalance": single.imbalance,
        "predicted_imbalance": float(np.sqrt(moments.max())),
    }
