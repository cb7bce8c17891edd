"""A simulator and a rig held against the closed form: copy this file and make it yours."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analytic import Case, Readings, solve_sweep
from compare import Limit, Tolerances, read_measured


def my_simulator(case: Case) -> Readings:
    """Yours, in place of this stand-in: the closed form, a tenth of a per cent too stiff.

    A simulator gets the problem (`case.beam`, `case.profile`, `case.foot_x`) and returns what the
    clamp does to the vibrissa at every station. Thickness counts: the axis of the vibrissa stays
    `case.beam.radius` off the profile.
    """
    exact = solve_sweep(case)
    table = pd.DataFrame(
        {
            "foot_x": case.foot_x,
            "force_x": 1.001 * exact.values("force_x"),
            "force_y": 1.001 * exact.values("force_y"),
            "moment_z": 1.001 * exact.values("moment_z"),
        }
    )
    return Readings(table, case.beam, "my simulator")


@pytest.mark.vibrissa("catenary", "parabola")  # without: all named cases, or --vibrissa-case
def test_my_simulator(vibrissa_case, vibrissa_agreement):
    vibrissa_agreement(my_simulator(vibrissa_case))


@pytest.mark.vibrissa("tip-only")
def test_my_simulator_against_mujoco(vibrissa_case, vibrissa_sweep, vibrissa_agreement):
    allowed = Tolerances(rms=Limit(3e-3, "MuJoCo's chain of 20 segments is itself off by 2e-3"))
    vibrissa_agreement(my_simulator(vibrissa_case), vibrissa_sweep("chain", segments=20), allowed)


@pytest.fixture
def rig_csv(vibrissa_case, tmp_path) -> Path:
    """Your rig's file, in place of this stand-in: 3 mm off, with half a per cent of noise."""
    exact = solve_sweep(vibrissa_case)
    rng = np.random.default_rng(0)

    def noisy(name: str, unit: float) -> np.ndarray:
        values = exact.values(name) / unit
        return values + 5e-3 * np.abs(values).max() * rng.standard_normal(len(values))

    table = pd.DataFrame(
        {
            "stage": exact.values("foot_x") * 1e3 + 3.0,
            "Fx": noisy("force_x", 1e-3),
            "Fy": noisy("force_y", 1e-3),
            "Mz": noisy("moment_z", 1e-6),
        }
    )
    table.to_csv(tmp_path / "rig.csv", index=False)
    return tmp_path / "rig.csv"


@pytest.mark.vibrissa(str(Path(__file__).with_name("rig.toml")))
def test_my_rig(vibrissa_case, rig_csv, vibrissa_agreement):
    columns = ["foot_x=stage:mm", "force_x=Fx:mN", "force_y=Fy:mN", "moment_z=Mz:mN mm"]
    measured = read_measured(rig_csv, columns=columns, otherwise=vibrissa_case.beam)
    found = vibrissa_agreement(measured, offset="auto", noise=5e-3)
    assert found.offset.value == pytest.approx(3e-3, abs=2 * found.offset.uncertainty)
