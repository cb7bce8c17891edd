"""Case files of a user, and a rig's readings in its own columns and units."""

import pandas as pd

from analytic import Readings

RIG_COLUMNS = tuple(
    word
    for column in ("foot_x=stage:mm", "force_x=Fx:mN", "force_y=Fy:mN", "moment_z=Mz:mN mm")
    for word in ("--column", column)
)


def as_a_rig(sweep: Readings) -> pd.DataFrame:
    """A sweep in SI units in millimetres and millinewtons."""
    names = {"foot_x": "stage", "force_x": "Fx", "force_y": "Fy", "moment_z": "Mz"}
    return sweep.table[[*names]].rename(columns=names) * [1e3, 1e3, 1e3, 1e6]


CASE = """
name = "small object"
[beam]
length = 1.0
[profile]
kind = "circle"
radius = 1.0
lowest = [0.0, 0.4]
[sweep]
stations = 30
[mujoco]
segments = 10
"""

WIRE = """[beam]
length = "50 mm"
flexural_rigidity = "2e-6 N m^2"
radius = "0.25 mm"
"""
POST = """[profile]
kind = "circle"
radius = "40 mm"
lowest = ["0 mm", "20 mm"]
"""
BALL = """[body]
kind = "sphere"
radius = 1
centre = [0, 1.4, 0]
"""
BALL_OF_50_MM = """[body]
kind = "sphere"
radius = "50 mm"
centre = ["0 mm", "70 mm", "0 mm"]
"""

UNITS = f"""
{WIRE}[profile]
kind = "catenary"
a = 0.5
c = -0.8
scale = "5 cm"
[sweep]
stations = 30
"""
