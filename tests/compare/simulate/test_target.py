"""Settings for a wanted error, from parts that are known."""

import math
from dataclasses import asdict, replace
from types import SimpleNamespace

import pytest

from analytic import CLAMP_READINGS, InputError
from compare.explain.parts import Part
from compare.simulate import target
from compare.simulate.target import advised
from mujoco_models import Settings

BASE = Settings(segments=40, contour_points=1000, contact_stiffness=1e6)


def chosen(wanted, smooth="primitive", base=BASE, **sizes):
    """What is advised where each part has that size in the worst of the readings."""
    zero = dict.fromkeys(("discretisation", "facets", "softness", "unexplained"), 0.0)
    worst = dict(zip(CLAMP_READINGS, (1.0, 0.5, 0.2), strict=True))
    parts = {
        name: {reading: Part(size * share, 0.0) for reading, share in worst.items()}
        for name, size in (zero | sizes).items()
    }
    swept = {"base": asdict(base), "smooth": asdict(base) | {"obstacle": smooth}}
    runs = {name: SimpleNamespace(provenance={"settings": of}) for name, of in swept.items()}
    return advised(SimpleNamespace(parts=parts, order=2.0), runs, wanted)


@pytest.mark.parametrize("wanted", [1e-3, 4e-3, 2e-2])
def test_the_beam_alone_follows_its_order(wanted):
    settings, error = chosen(wanted, discretisation=4e-3)
    assert settings.segments == math.ceil(40 * math.sqrt(4e-3 / (0.9 * wanted * math.sqrt(0.8))))
    assert error == pytest.approx(4e-3 * (40 / settings.segments) ** 2)
    assert error <= 0.9 * wanted


@pytest.mark.parametrize(("power", "segments"), [(2, 58), (3, 179)])
def test_where_far_less_is_measured_fewer_segments_do(power, segments, monkeypatch):
    """A wire of nitinol got 179 for 5e-4, which left 4.6e-5; those of another order stay."""

    def swept(_, settings):
        about = {"seconds": 1.0, "segments": settings.segments}
        return SimpleNamespace(provenance=about, table=[1])

    def error(_, made):
        return 4.6e-5 * (179 / made.provenance["segments"]) ** power

    advice = replace(BASE, segments=179), 4.5e-4
    fakes = {
        "simulate_sweep": swept,
        "largest_rms": error,
        "advised": lambda *_: advice,
        "solve_sweep": lambda _: None,
    }
    for name, fake in fakes.items():
        monkeypatch.setattr(target, name, fake)
    found = target.follow_advice(None, None, None, 5e-4)
    assert found.settings.segments == segments
    assert found.reached


def test_facets_fall_slowly_and_grow_fast():
    """As their normals where there are to be more, as their chords where fewer."""
    share = 0.9e-3 * math.sqrt(0.2)
    assert chosen(1e-3, facets=4 * share)[0].contour_points == 4000
    assert chosen(1e-3, facets=share / 4)[0].contour_points == 500


def test_where_facets_are_not_known_they_stay():
    assert chosen(1e-3, smooth="mesh", facets=1e-5)[0].contour_points == BASE.contour_points


def test_contacts_become_as_stiff_as_they_must():
    settings, error = chosen(1e-3, softness=6e-4)
    assert settings.contact_stiffness == pytest.approx(2e6)
    assert error == pytest.approx(3e-4)
    assert chosen(1e-3, softness=2e-4)[0].contact_stiffness == BASE.contact_stiffness


@pytest.mark.parametrize("part", ["unexplained", "corner"])
def test_what_nothing_lowers_is_the_least(part):
    with pytest.raises(InputError, match=r"must be at least"):
        chosen(1e-3, **{part: 2e-3})


def test_a_clamp_of_first_order_is_advised_against_first():
    """More segments were, where no number of them would do."""
    with pytest.raises(InputError, match='leave clamp = "naive" out'):
        chosen(1e-5, base=replace(BASE, clamp="naive"), discretisation=0.1)
