"""Case files of a user."""

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

UNITS = """
[beam]
length = "50 mm"
flexural_rigidity = "2e-6 N m^2"
radius = "0.25 mm"
[profile]
kind = "catenary"
a = 0.5
c = -0.8
scale = "5 cm"
[sweep]
stations = 30
"""
