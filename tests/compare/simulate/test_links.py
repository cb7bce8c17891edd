"""What more links of the same layout would give: held against models that have them."""

import re

import numpy as np
import pytest

from compare.simulate.inspection import Inspection
from compare.simulate.links import order_in_links, tips_of_chain
from compare.simulate.rigidity import tip_of
from mujoco_models import inspect_model, shipped_models
from tests.mujoco_models.inspect.chains import Chain, OnRail


def order(tmp_path, **kinds):
    return order_in_links(inspect_model(Chain(**kinds).write(tmp_path)))


@pytest.mark.parametrize(
    ("layout", "expected"),
    [
        ({"first": "centre"}, 2.0),  # the midpoint rule
        ({"first": "start"}, 1.0),  # a whole cell's compliance at the clamp
        ({"first": "end"}, 1.0),  # a whole cell that is rigid
        ({"first": "start", "stiffer": {1: 2.0}}, 2.0),  # the trapezoidal rule
    ],
)
def test_the_order_is_that_of_models_with_twice_as_many_links(tmp_path, layout, expected):
    found = order(tmp_path, links=10, **layout)
    twice = order(tmp_path, links=20, **layout)
    assert found.order == pytest.approx(expected, abs=0.03)
    # MuJoCo's own chain of 20, against what that of 10 said of it.
    assert twice.error == pytest.approx(found.error_of_twice, rel=2e-3)
    assert twice.error_of_twice == pytest.approx(found.error_of_fourfold, rel=2e-3)
    assert found.order == pytest.approx(np.log2(found.error_of_twice / found.error_of_fourfold))
    assert np.log2(found.error / twice.error) == pytest.approx(expected, abs=0.05)


def test_the_order_is_printed_with_the_two_that_it_is_of(tmp_path):
    found = Inspection(inspect_model(Chain(links=10).write(tmp_path)))
    (line,) = (line for line in found.lines() if "order in its links" in line)
    order, own, twice, fourfold = (float(x) for x in re.findall(r"[\d.]+e-\d+|\d\.\d", line))
    assert own > twice > fourfold
    assert np.log2(twice / fourfold) == pytest.approx(order, abs=0.06)


def test_an_order_that_its_ends_suit_alone_is_no_order(tmp_path):
    """A first joint that makes the tip right with 20 links is a little off with more."""
    found = Inspection(inspect_model(OnRail(first="start", stiffer={1: 2.0508}).write(tmp_path)))
    assert found.sound
    (line,) = (line for line in found.lines() if "order in its links" in line)
    assert ", as its ends suit 20 alone:" in line


def test_fine_chains_tend_to_the_exact_cantilever():
    loads = np.array([0.01, 1.0, 10.0])
    places = (np.arange(400) + 0.5) / 400
    np.testing.assert_allclose(
        tips_of_chain(places, np.full(400, 1 / 400), loads), tip_of(loads), atol=3e-6
    )


def test_one_joint_that_is_off_is_no_matter_of_the_order(tmp_path):
    found = order(tmp_path, links=20, stiffer={7: 1.2})
    assert found.order == pytest.approx(2.0, abs=0.03)
    assert found.error > 10 * found.error_of_twice


def test_a_curve_or_a_taper_has_no_order(tmp_path):
    assert order(tmp_path, curvature=0.4) is None
    assert order_in_links(inspect_model(shipped_models()["tapered-whisker"])) is None
