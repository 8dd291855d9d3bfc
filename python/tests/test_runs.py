"""Are the columns equal to the command's, to the last bit, and is a run that fails among many reported?"""

import csv
import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Command
from numpy.typing import ArrayLike, NDArray

from corner_impact import EVENTS, Chart, LocalMap, Model, ModelError

Columns = dict[str, NDArray[Any]]


def table(text: str) -> dict[str, list[str]]:
    rows = list(csv.DictReader(io.StringIO(text)))
    return {name: [row[name] for row in rows] for name in rows[0]}


def assert_same(found: Columns, text: str) -> None:
    """Assert that columns equal those of a table, by name and in its order. Words stand for codes."""
    expected = table(text)
    assert list(found) == list(expected)
    for name, cells in expected.items():
        if name == "event":
            assert [EVENTS[code] for code in found[name]] == cells
        else:
            assert np.array_equal(found[name], np.array(cells, dtype=found[name].dtype), equal_nan=True), name
    assert len(next(iter(found.values()))) > 10


@pytest.mark.parametrize("rpm", [183.0, 670.0, 700.0])
def test_events_are_those_of_the_command(paper: Model, command: Command, rpm: float) -> None:
    words = ("simulate", "--rpm", str(rpm), "--revolutions", "40", "--events", "-")
    found = paper.simulate(rpm, 40)
    assert_same(found, command(*words))
    assert_same(
        paper.simulate(rpm, 40, cam_angle=-2.0, relative_velocity=3.0),
        command(*words, "--start-angle", "-2", "--relative-velocity", "3"),
    )
    assert_same(paper.simulate(rpm, 40, position=9, velocity=np.float64(-4)), command(*words, "--state", "9,-4"))
    # A transient is the beginning of the same run.
    later, tail = paper.simulate(rpm, 10, transient=30), found["revolution"] >= 30
    assert all(np.allclose(later[name], found[name][tail], rtol=1e-6) for name in found)


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ({}, []),
        ({"threads": 1}, []),
        ({"threads": 2, "lyapunov": True}, ["--lyapunov"]),
        ({"strobe": 1.5}, ["--section", "strobe", "--strobe", "1.5"]),
        ({"strobe": 1.5, "lyapunov": True}, ["--section", "strobe", "--strobe", "1.5", "--lyapunov"]),
        ({"follow": "up"}, ["--start", "up"]),
        ({"follow": "down", "cam_angle": 1.0}, ["--start", "down", "--start-angle", "1"]),
    ],
)
def test_diagrams_are_those_of_the_command(
    paper: Model, command: Command, asked: dict[str, Any], words: list[str]
) -> None:
    found = paper.diagram((660, 750, 7), transient=50, record=20, **asked)
    line = ("diagram", "--rpm", "660:750:7", "--transient", "50", "--record", "20", "--out", "-")
    assert_same(found, command(*line, *words))


@pytest.mark.parametrize("asked", [{}, {"follow": "down"}, {"threads": 1}, {"lyapunov": True}, {"strobe": 1.0}])
def test_a_speed_that_fails_has_a_row(paper: Model, asked: dict[str, Any]) -> None:
    # Below the cam everywhere.
    found = paper.diagram((600, 700, 3), record=5, position=-1.0, velocity=0.0, **asked)
    assert sorted(found["rpm"]) == [600.0, 650.0, 700.0] and np.all(found["revolution"] == -1)
    if "strobe" not in asked:
        assert [EVENTS[code] for code in found["event"]] == ["failed"] * 3
    for name in set(found) - {"rpm", "revolution", "event"}:
        assert found[name].shape == (3,) and np.all(np.isnan(found[name])), name


def test_the_strobe_map_is_the_run(paper: Model) -> None:
    position, velocity = np.linspace(1.0, 6.0, 40), np.linspace(-60.0, 60.0, 40)
    found = paper.strobe_map(680, position, velocity, 3, cam_angle=5.76)
    states = paper.diagram((680, 680, 1), transient=0, record=4, strobe=5.76, cam_angle=5.76,
                           position=position[7], velocity=velocity[7])
    # The state at the start is not recorded.
    np.testing.assert_allclose(found["position_m"][7], states["position_m"][2], rtol=1e-10)
    np.testing.assert_allclose(found["velocity_m_s"][7], states["velocity_m_s"][2], rtol=1e-10)
    for threads in (2, None):
        other = paper.strobe_map(680, position, velocity, 3, cam_angle=5.76, threads=threads)
        assert all(np.array_equal(found[name], other[name]) for name in found)
    # Column by column, the derivative agrees with the effect of a small step.
    derived = paper.strobe_map(680, position, velocity, 3, cam_angle=5.76, jacobian=True)
    assert all(np.array_equal(found[name], derived[name]) for name in found)
    assert derived["jacobian"].shape == (40, 2, 2)
    for column, (aside, faster) in enumerate([(1e-7, 0.0), (0.0, 1e-6)]):
        right = paper.strobe_map(680, position + aside, velocity + faster, 3, cam_angle=5.76)
        left = paper.strobe_map(680, position - aside, velocity - faster, 3, cam_angle=5.76)
        for row, name in enumerate(found):
            slope = (right[name] - left[name]) / (2 * (aside + faster))
            close = np.isclose(slope, derived["jacobian"][:, row, column], rtol=1e-3, atol=1e-4)
            # A corner or a graze may lie between two starts.
            assert np.mean(close) > 0.9, (row, column)


def test_starts_of_every_kind(paper: Model) -> None:
    plain = paper.strobe_map(700, [4.0, 5.0, 6.0], [1.0, 0.0, -1.0])
    apart = np.array([[4, 9], [5, 9], [6, 9]])
    alike: list[tuple[ArrayLike, ArrayLike]] = [
        ((4, 5, 6), (1, 0, -1)),
        (apart[:, 0], np.array([1, 0, -1], dtype=np.int8)),
        (np.array([6.0, 5.0, 4.0])[::-1], np.array([1, 0, -1], dtype=np.float32)),
    ]
    for position, velocity in alike:
        found = paper.strobe_map(700, position, velocity)
        assert all(np.array_equal(found[name], plain[name]) for name in plain)
    starts = [4.0, np.nan, -1.0, np.inf, 4.0, 4.0]
    speeds = [1.0, 0.0, 0.0, 0.0, np.nan, -np.inf]
    for jacobian in (False, True):
        found = paper.strobe_map(700, starts, speeds, jacobian=jacobian)
        assert [bool(np.isnan(value)) for value in found["position_m"]] == [False] + 5 * [True]
        assert found["position_m"][0] == plain["position_m"][0]
    empty = paper.strobe_map(700, [], [], jacobian=True)
    assert empty["position_m"].shape == (0,) and empty["jacobian"].shape == (0, 2, 2)
    with pytest.raises(ValueError, match=r"the shapes do not broadcast: position \[2\], velocity \[3\]"):
        paper.strobe_map(700, [4.0, 5.0], [1.0, 0.0, -1.0])
    with pytest.raises(ValueError, match="velocity must be numbers"):
        paper.strobe_map(700, [4.0], ["fast"])


@pytest.mark.parametrize("threads", [1, 2])
def test_starts_broadcast_as_in_numpy(paper: Model, threads: int) -> None:
    position, velocity = np.linspace(2.0, 6.0, 3)[:, None], np.linspace(-20.0, 20.0, 4)
    found = paper.strobe_map(700, position, velocity, jacobian=True, threads=threads)
    assert found.position_m.shape == found.velocity_m_s.shape == (3, 4) and found.jacobian.shape == (3, 4, 2, 2)
    for row, column in [(0, 3), (2, 1)]:
        one = paper.strobe_map(700, position[row, 0], velocity[column], jacobian=True)
        assert one.position_m.shape == () and one.position_m == found.position_m[row, column]
        assert np.array_equal(one.jacobian, found.jacobian[row, column])
    angle, leaving = np.linspace(2.0, 3.0, 3), np.linspace(10.0, 80.0, 2)[:, None, None]
    next_one = paper.impact_map(670, angle, leaving, threads=threads)
    assert {column.shape for column in next_one.values()} == {(2, 1, 3)}
    assert next_one.cam_angle_rad[1, 0, 2] == paper.impact_map(670, 3.0, 80.0).cam_angle_rad
    lift = paper.cam(angle.reshape(3, 1))
    assert lift.lift_m.shape == (3, 1) and lift.lift_m[2, 0] == paper.cam(3.0).lift_m
    assert paper.strobe_map(700, np.zeros((0, 4)), 0.0).position_m.shape == (0, 4)


def test_speeds_are_a_range_or_any_sequence(paper: Model) -> None:
    spaced = paper.diagram((690, 710, 3), record=2)
    sequences: list[Any] = [[690, 700, 710], (690.0, 700.0, 710.0), np.array([690.0, 700.0, 710.0]), range(690, 711, 10)]
    for speeds in sequences:
        found = paper.diagram(speeds, record=2)
        assert all(np.array_equal(found[name], spaced[name]) for name in spaced)
    assert paper.diagram(np.linspace(660, 750, 200), transient=3, record=1).rpm[[0, -1]].tolist() == [660, 750]
    # Values in another order, and a single value.
    assert np.unique(paper.diagram([710, 690], record=1).rpm).tolist() == [690, 710]
    assert paper.diagram(np.array([700.0]), record=2).rpm.tolist() == [700, 700]
    restitution = paper.diagram(700, over=("restitution", [0.8, 0.65]), record=1)
    assert np.unique(restitution["follower.restitution"]).tolist() == [0.65, 0.8]


def test_angles_are_in_rad_or_in_deg_by_name(paper: Model) -> None:
    plain = paper.simulate(670, 20, cam_angle=1.0)
    angles: list[dict[str, Any]] = [{"start_angle_rad": 1.0}, {"start_angle_deg": np.degrees(1.0)}]
    for angle in angles:
        assert np.allclose(paper.simulate(670, 20, **angle).time_s, plain.time_s, rtol=1e-9)
    assert not np.allclose(paper.simulate(670, 1, start_angle_deg=1.0).time_s[0], plain.time_s[0])
    assert np.array_equal(plain.cam_angle_deg, np.degrees(plain.cam_angle_rad))
    degrees: list[tuple[Any, Any]] = [
        (paper.diagram([670], record=3, strobe=1.0), paper.diagram([670], record=3, strobe_deg=np.degrees(1.0))),
        (paper.strobe_map(670, 4.0, 1.0, cam_angle=1.0), paper.strobe_map(670, 4.0, 1.0, cam_angle_deg=np.degrees(1.0))),
        (paper.impact_map(670, 2.0, 70.0), paper.impact_map(670, cam_angle_deg=np.degrees(2.0), relative_velocity=70.0)),
        (paper.cam(2.0), paper.cam(angle_deg=np.degrees(2.0))),
    ]
    for one, other in degrees:
        assert all(np.allclose(one[name], other[name], rtol=1e-9) for name in one)


def test_the_impact_map_goes_from_impact_to_impact(paper: Model) -> None:
    events = paper.simulate(670, 200, transient=100)
    assert np.all(events["event"] == EVENTS.index("impact"))
    angle, after = events["cam_angle_rad"], events["velocity_after_m_s"] - events["cam_velocity_m_s"]
    found = paper.impact_map(670, angle[:-1], after[:-1], threads=2)
    np.testing.assert_allclose(found["cam_angle_rad"], angle[1:], rtol=1e-9)
    np.testing.assert_allclose(found["relative_velocity_m_s"], after[1:], rtol=1e-8)
    np.testing.assert_allclose(found["flight_s"], np.diff(events["time_s"]), rtol=1e-9)
    # No impact follows if the follower stays on the cam, or after an invalid start.
    wrong = paper.impact_map(50, [0.0, 1.0, np.nan, 1.0], [0.0, -1.0, 1.0, np.nan])
    assert all(np.all(np.isnan(column)) for column in wrong.values())
    # Angles are equal modulo a turn.
    turned = paper.impact_map(670, angle[:5] - 4 * np.pi, after[:5])
    np.testing.assert_allclose(turned["cam_angle_rad"], found["cam_angle_rad"][:5], rtol=1e-9)


def test_the_cam_is_where_the_impacts_are(paper: Model) -> None:
    events = paper.simulate(670, 50)
    lifts = paper.cam(events["cam_angle_rad"])
    np.testing.assert_allclose(lifts["lift_m"], events["position_m"], rtol=1e-14)
    np.testing.assert_allclose(lifts["slope_m_rad"] * 670 * np.pi / 30, events["cam_velocity_m_s"], rtol=1e-12)
    assert np.isnan(paper.cam([np.nan, np.inf])["lift_m"]).all()
    assert paper.cam([-1.0])["lift_m"] == paper.cam([2 * np.pi - 1.0])["lift_m"]


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (lambda it: it.simulate(0), "rpm = 0 must be a finite number above 0"),
        (lambda it: it.simulate(np.nan), "rpm = NaN must be"),
        (lambda it: it.simulate(1e10), "1e9 or less"),
        (lambda it: it.simulate(700, -1), "revolutions = -1 must be a whole number"),
        (lambda it: it.simulate(700, 1.5), "revolutions = 1.5 must be a whole number"),
        (lambda it: it.simulate(700, position=0.0), "a start is position and velocity"),
        (lambda it: it.simulate(700, position=0.0, velocity=0.0), "below the cam"),
        (lambda it: it.simulate(700, relative_velocity=-1), "must be 0 or more"),
        (lambda it: it.simulate(700, cam_angle=np.inf), "finite"),
        (lambda it: it.diagram((700, 600, 3)), "is below the lowest"),
        (lambda it: it.diagram((600, 700, 0)), "must be 1 speed or more"),
        (lambda it: it.diagram((600, 700, 1)), "1 speed needs"),
        (lambda it: it.diagram((600, 700, 3), follow="left"), "must be None"),
        (lambda it: it.diagram((600, 700, 3), strobe=np.nan), "strobe"),
        (lambda it: it.diagram((600, 700, 3), threads=0), "threads = 0 must be a whole number of threads from 1"),
        (lambda it: it.diagram((600, 700, 3), threads=100_000), "threads = 100000 must be"),
        (lambda it: it.strobe_map(700, [5.0], [0.0], threads=-1), "threads"),
        (lambda it: it.diagram([]), "there must be 1 value or more"),
        (lambda it: it.diagram([[600.0, 700.0]]), "rpm must be numbers in one dimension"),
        (lambda it: it.diagram([600.0, -1.0]), "rpm = -1 must be a finite number above 0"),
        (lambda it: it.diagram(700, over=("mass", [np.nan])), "follower.mass = NaN must be a finite number"),
        (lambda it: it.diagram(700, over=("mass",)), "must be .name, lowest, highest, how many. or .name, values."),
        (lambda it: it.simulate(700, start_angle_rad=1, start_angle_deg=1), "given more than once"),
        (lambda it: it.impact_map(700, 1.0, 1.0, cam_angle_deg=1.0), "one of cam_angle, cam_angle_rad and cam_angle_deg"),
        (lambda it: it.impact_map(700, 1.0), "relative_velocity is missing"),
        (lambda it: it.basins(700), "the starts are a grid"),
        (lambda it: it.basins(700, (0, 5)), "must have 1 to"),
        (lambda it: it.basins(700, (5, 5), position=(1, 1)), "starts"),
        (lambda it: it.continue_(700, ("rpm", 710, 690)), "is not below"),
        (lambda it: it.continue_(700, ("rpm", 690, 710), step=0), "step = 0"),
        (lambda it: it.continue_(700, ("rpm", 690, 710), doublings=11), "doublings = 11"),
        (lambda it: it.curve((600, 700), ("restitution", 0.7, 0.8), events=["bang"]), "corner, fold, flip"),
        (lambda it: it.chaos((700, 600)), "is not below"),
        (lambda it: it.figure("nothing"), "no figure called .nothing.; there are: cam-shape, cam"),
        (lambda it: it.explain("B_minos"), "did you mean B_minus"),
        (lambda it: LocalMap(it, (600, 610)), "no corner impact from 600 to 610 rpm"),
        (lambda it: it.locate((700, 600)), "is not below"),
        (lambda it: it.orbits(700, 0), "revolutions = 0 must be from 1"),
        (lambda it: it.orbits(700, impacts=1, guess=(1.0, 1.0)), "guess and impacts"),
        (lambda it: it.speeds((600, 700), step=-1), "step"),
        (lambda it: it.speeds((600, 700), starts=0), "starts = 0"),
        (lambda it: it.certify(700), "must be .lowest, highest."),
        (lambda it: it.certify(orbits=True), "at which rpm"),
        (lambda it: it.certify(bits=1), "bits = 1"),
        (lambda it: it.strobe_map([700, 710], 4.4, 0.0), r"rpm = \[700, 710\] must be one number"),
        (lambda it: it.strobe_map(700, None, 0.0), "position = None must be numbers"),
        (lambda it: it.impact_map(700, 1.0, relative_velocity=None), "relative_velocity"),
        (lambda it: it.speeds((660, 760, 5)), r"rpm = \(660, 760, 5\) must be a number or \(lowest, highest\)"),
        (lambda it: it.locate(700), r"rpm = 700 must be \(lowest, highest\)"),
        (lambda it: it.curve((665, 680), ("restitution", 0.7)), r"must be \(name, lowest, highest\)"),
        (lambda it: it.basins(700, (3, 3), strobe_rad=1, strobe_deg=1), "once: strobe_rad and strobe_deg are one"),
        (lambda it: Chart(it, {"restitution": [0.7], "mass": [1.0]}), "the speed is missing: give rpm$"),
    ],
)
def test_wrong_arguments_are_refused_with_a_sentence(paper: Model, wrong: Any, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        wrong(paper)


def test_ranges_are_any_sequences_and_one_word_is_a_list(paper: Model) -> None:
    assert paper.locate([670, 680]) == paper.locate(np.array([670, 680])) == paper.locate((670, 680))
    assert paper.chaos([670, 670.1]).rpm.tolist() == [670, 670.1] and paper.orbits(680, guess=[4.2, -31.0]).orbits[0].stable
    one = paper.curve([665, 680], ("restitution", 0.79, 0.81), events="corner")
    assert one == paper.curve((665, 680), ("restitution", 0.79, 0.81), events=["corner"])
    need = "no separation to 130 rpm"
    assert paper.design((100, 130), speeds=3, needs=need) == paper.design((100, 130), speeds=3, needs=[need])
    assert LocalMap(paper, [670, 680]).classification.scenario == "nonsmooth-fold"


def test_derivatives_of_the_cam_are_named_in_the_units_of_the_model(paper: Model) -> None:
    metres = paper.cam(angle_deg=120)
    told = Model.parse(paper.text + '\n[units]\nlength = "mm"\nangle = "deg"\n').cam(angle_deg=120)
    assert list(metres) == ["lift_m", "slope_m_rad", "curvature_m_rad2", "cam_angle_rad"]
    assert list(told) == ["lift_mm", "slope_mm_rad", "curvature_mm_rad2", "cam_angle_deg"]
    # The text of the model has the same figures in another unit of length.
    for one, other in zip(metres.values(), told.values()):
        assert float(other) == pytest.approx(120 if float(one) == metres.cam_angle_rad else float(one), rel=1e-14)
    assert told.to_pandas().attrs["units"]["curvature_mm_rad2"] == "mm/rad^2"


def test_a_table_of_lifts_is_refused_with_the_way_to_read_it(tmp_path: Path) -> None:
    (tmp_path / "lifts.csv").write_text("angle_deg,lift_mm\n0,1\n10,2\n")
    with pytest.raises(ModelError, match="a table of lifts has no follower: give both to Model.from_dict") as error:
        Model.load(tmp_path / "lifts.csv")
    assert error.value.line == 1
    (tmp_path / "model.toml").write_text("angle_deg,lift_mm\n")
    with pytest.raises(ModelError, match="^((?!lifts has).)*$"):
        Model.load(tmp_path / "model.toml")
