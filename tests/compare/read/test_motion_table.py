"""The [motion] table of a case file: natural units and quantities with units."""

import math

import pytest

from mujoco_models import Motion

STEEL = """
[beam]
length = "100 mm"
flexural_rigidity = "6.4e-4 N m^2"
radius = "0.25 mm"
[profile]
kind = "circle"
radius = "80 mm"
lowest = ["0 mm", "40 mm"]
[motion]
"""
PLAIN = '[profile]\nkind = "circle"\nradius = 1.0\nlowest = [0.0, 0.4]\n[motion]\n'


def test_units_become_natural_ones_by_the_density(load):
    found = load(
        STEEL + 'density = "7850 kg/m^3"\nspeed = "20 mm/s"\ntimestep = "0.5 ms"\n'
        'solref = ["5 ms", 0.8]\ncutoff = "500 Hz"\nramp = 2.0\n',
    ).motion
    # Rao, Mechanical Vibrations: omega = 1.8751^2 sqrt(EI/(rho A L^4)) of a uniform cantilever.
    mass = 7850 * math.pi * 0.25e-3**2
    period = 2 * math.pi / (1.8751040687**2 * math.sqrt(6.4e-4 / (mass * 0.1**4)))
    assert period == pytest.approx(27.7e-3, rel=2e-3)
    assert found.speed == pytest.approx(0.2 * period, rel=1e-9)
    assert found.timestep == pytest.approx(0.5e-3 / period, rel=1e-9)
    assert found.solref == pytest.approx((5e-3 / period, 0.8), rel=1e-9)
    assert found.cutoff == pytest.approx(500 * period, rel=1e-9)
    assert found.ramp == 2.0  # a plain number is in T1
    by_period = STEEL + f'period = "{1e3 * period} ms"\nspeed = "20 mm/s"\n'
    assert load(by_period).motion.speed == pytest.approx(found.speed, rel=1e-9)
    assert load(PLAIN).motion == Motion()
    assert load(PLAIN.removesuffix("[motion]\n")).motion is None


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (STEEL + 'speed = "20 mm/s"\n', "add period"),
        (STEEL + 'speed = "20 mm"\n', "line 11: motion.speed = '20 mm': must be a number, or a"),
        (STEEL + 'period = "1 ms"\ndensity = "1 g/cm^3"\n', "motion.density"),
        (PLAIN + 'density = "7850 kg/m^3"\n', "dimensions have no units"),
        (PLAIN + 'period = "28 ms"\nspeed = "1 m/s"\n', "motion.speed"),
        (PLAIN + "sped = 0.1\n", "did you mean speed?"),
        (PLAIN + "solref = [0.1, 1.0]\ncontact_stiffness = 1e4\n", "motion.contact_stiffness"),
    ],
)
def test_what_is_wrong_is_one_line(refused, text, said):
    assert said in refused(text)
