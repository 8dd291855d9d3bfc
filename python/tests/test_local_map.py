"""Is the local map the one that `verify` finds, and are its iterates and orbits those of its matrices?"""

import pickle

import numpy as np
import pytest
from conftest import MODELS

from corner_impact import LocalMap, Model


@pytest.fixture(scope="module")
def local(paper: Model) -> LocalMap:
    return LocalMap(paper)


def test_its_matrices_are_those_of_verify(paper: Model, local: LocalMap) -> None:
    found = paper.verify(external=False)
    route = found.routes.variational
    for side in ("minus", "plus"):
        assert np.array_equal(getattr(local, f"A_{side}"), getattr(route, side).A)
        assert np.array_equal(getattr(local, f"B_{side}"), getattr(route, side).B)
    assert np.array_equal(local.C, route.C) and local.D == route.D and np.array_equal(local.border, route.border)
    assert local.classification.scenario == found.classification.scenario
    assert local.corner_impact.speed_rpm == found.corner_impact.speed_rpm
    assert np.degrees(local.corner_impact.cam_angle_rad) == local.corner_impact.cam_angle_deg
    assert local.corner_impact == paper.locate((600, 760)).corner_impacts[0]
    assert local.classification == paper.locate((600, 760)).corner_impacts[0].classification
    for sign, told in zip((-1.0, 1.0, 0.0), found.local_map):
        outcome = local.outcome(1e-3 * sign)
        assert outcome.speeds == told.speeds and [end.end for end in outcome.ends] == [end.end for end in told.ends]
        for one, other in zip(outcome.periodic_orbits, told.periodic_orbits, strict=True):
            assert one.word == other.word and np.allclose(one.points, other.points, rtol=1e-9)


def test_it_maps_arrays_of_any_shape(local: LocalMap) -> None:
    dx = np.random.default_rng(1).normal(size=(5, 1, 2)) * [0.01, 1.0]
    change = np.array([-1e-5, 0.0, 1e-5])
    found, side = local(dx, change), local.side(dx, change)
    assert found.shape == (5, 3, 2) and side.shape == (5, 3) and set(side.ravel()) == {-1, 1}
    height = dx @ local.border[:2] + local.border[2] * change
    assert np.array_equal(side, np.where(height < 0, -1, 1))
    minus = dx @ local.A_minus.T + np.multiply.outer(change, local.B_minus)
    plus = dx @ local.A_plus.T + np.multiply.outer(change, local.B_plus)
    np.testing.assert_allclose(found, np.where(side[..., None] < 0, minus, plus), rtol=1e-12, atol=1e-15)
    np.testing.assert_array_equal(local(dx, change, steps=3), local(local(found, change), change))
    assert local([0.0, 0.0], 0.0).tolist() == [0, 0] and local(np.zeros((0, 2)), 1.0).shape == (0, 2)
    refused = [(np.zeros(3), "the last axis must be 2"), (np.array(1.0), "the last axis must be 2"), (np.zeros((4, 2)), "do not broadcast")]
    for wrong, words in refused:
        with pytest.raises(ValueError, match=words):
            local(wrong, change)


def test_an_orbit_repeats_its_word(local: LocalMap) -> None:
    assert (local.orbit("R", -1e-4).stable, local.orbit("L", -1e-4).stable) == (True, False)
    orbit = local.orbit("LLR", 1e-4)
    assert orbit.points.shape == (3, 2) and orbit.multipliers.dtype == complex
    matrix, turned = np.eye(2), orbit.points[0]
    for letter in orbit.word:
        A, B = (local.A_minus, local.B_minus) if letter == "L" else (local.A_plus, local.B_plus)
        matrix, turned = A @ matrix, A @ turned + B * 1e-4
    np.testing.assert_allclose(turned, orbit.points[0], rtol=1e-9)
    np.testing.assert_allclose(np.sort(orbit.multipliers), np.sort(np.linalg.eigvals(matrix).astype(complex)), rtol=1e-9)
    on_side = np.where(local.side(orbit.points, 1e-4) < 0, "L", "R").tolist() == list(orbit.word)
    assert orbit.admissible == on_side
    assert [one.word for one in local.orbits(-1e-4).orbits] == ["L", "R"]
    for word in ("", "LX"):
        with pytest.raises(ValueError, match="must be of one or more letters L and R"):
            local.orbit(word, 1.0)


def test_it_is_pickled_and_shown(local: LocalMap) -> None:
    again = pickle.loads(pickle.dumps(local))
    assert np.array_equal(again.A_plus, local.A_plus) and repr(again) == repr(local)
    assert "A_minus" in local._repr_html_() and "673.2" in repr(local)


def test_a_jump_of_velocity_has_no_such_map() -> None:
    model = Model.load(next(path for path in MODELS if path.stem == "rectified-sine"))
    speeds = [one for one in model.locate((10, 400)).corner_impacts if one.jump_order == 1]
    if not speeds:
        pytest.skip("no corner impact at a jump of the velocity")
    rpm = speeds[0].speed_rpm
    with pytest.raises(ValueError, match="derivative of order 1 jumps"):
        LocalMap(model, (0.999 * rpm, 1.001 * rpm))
