"""Are the documents equal to those of the command?"""

import json
import venv
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Command
from test_runs import table

from corner_impact import Model


@pytest.mark.parametrize(
    ("ask", "words"),
    [
        (lambda it: it.orbits(680), ["orbit", "--rpm", "680"]),
        (lambda it: it.orbits(745, 2, 2), ["orbit", "--rpm", "745", "--revolutions", "2", "--impacts", "2"]),
        (lambda it: it.orbits(680, guess=(4.15, -31.3)), ["orbit", "--rpm", "680", "--guess", "4.15,-31.3"]),
        (lambda it: it.locate((670, 680)), ["locate", "--rpm", "670:680"]),
        (lambda it: it.verify(external=False), ["verify", "--no-external"]),
        (
            lambda it: it.speeds((700, 710), speeds=4, starts=6),
            ["speeds", "--rpm", "700:710", "--speeds", "4", "--starts", "6"],
        ),
        (
            lambda it: it.design((100, 130), speeds=3, needs=["no separation to 130 rpm"]),
            ["design", "--rpm", "100:130", "--speeds", "3", "--need", "no separation to 130 rpm"],
        ),
        (
            lambda it: it.design(200, over=("mass", 1, 4, 3), log=True),
            ["design", "--rpm", "200", "--over", "mass=1:4:3:log"],
        ),
        (lambda it: it.design(200), ["design", "--rpm", "200"]),
        (lambda it: it.compare(it.with_number("restitution", 0.7), external=False), ["compare", "--set", "restitution=0.7", "--no-external"]),
        (lambda it: it.certify((670, 680)), ["certify", "--rpm", "670:680"]),
        (lambda it: it.certify((690, 700), orbits=True), ["certify", "--rpm", "690:700", "--orbits"]),
        (lambda it: it.basins(678, (20, 15), strobe_rad=5.76), ["basins", "--rpm", "678", "--strobe", "5.76", "--grid", "20x15"]),
        (
            lambda it: it.basins(678, states=[(4.0, 1.0), (5.0, 0.0)], patience=5000, threads=1),
            ["basins", "--rpm", "678", "--state", "4,1", "--state", "5,0", "--patience", "5000"],
        ),
        (
            lambda it: it.basins(700, (5, 5), over=("restitution", 0.7, 0.8, 2)),
            ["basins", "--rpm", "700", "--grid", "5x5", "--over", "restitution=0.7:0.8:2"],
        ),
        (lambda it: it.basins((700, 710, 2), (5, 5)), ["basins", "--rpm", "700:710:2", "--grid", "5x5"]),
        (
            lambda it: it.continue_(738, ("rpm", 735, 745), doublings=1, step=0.05),
            ["continue", "--rpm", "738", "--over", "rpm=735:745", "--all=1", "--step", "0.05"],
        ),
        (
            lambda it: it.curve((660, 690), ("restitution", 0.79, 0.81), events=["corner", "fold"], impacts=1),
            ["curve", "--rpm", "660:690", "--over", "restitution=0.79:0.81", "--event", "corner", "--event", "fold", "--impacts", "1"],
        ),
        (lambda it: it.chaos(670), ["chaos", "--rpm", "670"]),
        (lambda it: it.chaos((673, 673.1), trapping=True), ["chaos", "--rpm", "673:673.1", "--trapping"]),
        (lambda it: it.figure(), ["figure"]),
        (lambda it: it.figure("cam"), ["figure", "cam"]),
        (lambda it: it.figure("slow-impacts", rpm=(100, 110)), ["figure", "slow-impacts", "--rpm", "100:110"]),
        (lambda it: it.explain("B_minus", external=False), ["explain", "B_minus", "--no-external"]),
        (lambda it: it.explain("CAM_JUMP"), ["explain", "CAM_JUMP"]),
    ],
)
def test_documents_are_those_of_the_command(paper: Model, command: Command, ask: Any, words: list[str]) -> None:
    found, expected = ask(paper), json.loads(command(*words, "--json"))
    # Only the time that it took differs.
    assert ("wall_s" in found) == ("wall_s" in expected)
    assert found.to_dict() | {"wall_s": 0} == expected | {"wall_s": 0} and json.loads(json.dumps(found)) == found
    assert found["schema"] == f"corner-impact/{words[0]}/1"


def test_basins_have_the_motion_of_each_start(paper: Model, command: Command) -> None:
    found = paper.basins(678, (20, 15), strobe_deg=330, position=(0.2, 8), velocity=(-60, 60))
    rows = table(command("basins", "--rpm", "678", "--strobe", "330deg", "--grid", "20x15", "--position", "0.2:8", "--velocity=-60:60", "--out", "-"))
    ending = found.ending.ravel()
    assert found.ending.shape == (15, 20) and np.unique(ending).tolist() == [-1, 0, 1]
    # A table has the starts that were run.
    words = [found.endings[index].ending for index in ending if index >= 0]
    column = next(cells for cells in rows.values() if set(cells) >= {"periodic", "chaotic"})
    assert [cell for cell in column if cell in words] == words
    position, velocity = np.meshgrid(found.positions, found.velocities)
    assert np.isnan(paper.strobe_map(678, position, velocity, cam_angle_deg=330).position_m[found.ending < 0]).all()
    assert (found.ending >= 0).sum() == found["starts"] and (found.ending == 0).sum() == found.endings[0].starts
    assert "ending" not in vars(paper.basins(678, states=[(4.0, 1.0)]))


def test_a_figure_has_its_picture(paper: Model) -> None:
    found = paper.figure("cam")
    assert found.svg.startswith("<svg") and found.title in found.svg
    with pytest.raises(ValueError, match="no figure local-map: "):
        Model.parse(paper.text.replace("rpm_max = 760.0", "rpm_max = 610.0")).figure("local-map")


def test_an_explanation_without_values_warns(paper: Model) -> None:
    without = Model.parse(paper.text.replace("rpm_max = 760.0", "rpm_max = 610.0"))
    with pytest.warns(UserWarning, match="no values: .*corner impact"):
        found = without.explain("B_minus", external=False)
    assert found.value is None and found.label == "eq:PT"


def test_a_model_with_another_number_is_that_of_the_command(paper: Model, command: Command) -> None:
    found = paper.with_number("restitution", 0.7).orbits(680)
    assert found == json.loads(command("orbit", "--rpm", "680", "--set", "restitution=0.7", "--json"))


def test_what_python_lacks_is_told(paper: Model, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CORNER_IMPACT_PYTHON", "/nowhere/python")
    with pytest.raises(ValueError, match="/nowhere/python.* did not start"):
        paper.certify((670, 680))
    with pytest.warns(UserWarning, match="the route (symbolic|scipy|certificate) failed, and so the routes do not agree: .*did not start"):
        found = paper.verify()
    assert not found["agrees"] and repr(found).startswith("<Verification agrees=False: ") and "scipy" in repr(found)
    assert {skipped["route"] for skipped in found["skipped"] if skipped["failed"]} == {
        "symbolic",
        "scipy",
        "certificate",
    }


def test_a_missing_package_is_told(paper: Model, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    bare = tmp_path / "bare"
    venv.create(bare, with_pip=False)
    monkeypatch.setenv("CORNER_IMPACT_PYTHON", str(bare / "bin" / "python"))
    with pytest.raises(ImportError, match="python-flint is missing") as raised:
        paper.certify((670, 680))
    assert "pip install 'corner-impact[routes]'" in str(raised.value)


def test_the_routes_run_in_this_interpreter(paper: Model, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("CORNER_IMPACT_PYTHON", raising=False)
    # Neither the interpreter of a build of the command nor the one on the PATH is used.
    monkeypatch.setenv("PATH", "")
    found = paper.verify()
    assert found["agrees"] and {"symbolic", "scipy", "certificate"} <= set(found["routes"])


def test_no_corner_impact_is_an_error(paper: Model) -> None:
    with pytest.raises(ValueError, match="corner impact"):
        Model.parse(paper.text.replace("rpm_max = 760.0", "rpm_max = 610.0")).verify(external=False)


def test_surveys_go_over_any_number(paper: Model) -> None:
    name = "follower.restitution"
    found = paper.diagram(700, over=("restitution", 0.65, 0.8, 2), record=2)
    assert next(iter(found)) == name
    for value in (0.65, 0.8):
        alone = paper.with_number("restitution", value).diagram((700, 700, 1), record=2)
        for column in ("cam_angle_rad", "velocity_before_m_s"):
            assert np.array_equal(found[column][found[name] == value], alone[column])
    logarithmic = paper.diagram(700, over=("mass", 0.25, 1, 3), log=True, record=1)
    assert np.unique(logarithmic["follower.mass"]).tolist() == pytest.approx([0.25, 0.5, 1])
    survey = paper.speeds(700, over=("restitution", 0.65, 0.75), step=0.05, starts=4)
    assert (survey["over"], survey["range"], survey["rpm"]) == (name, [0.65, 0.75], [700, 700])
    assert {at["value"] for row in survey["attractors"] for at in row["shares"]} == {0.65, 0.7, 0.75}
    for call in (
        lambda: paper.diagram(700),
        lambda: paper.diagram((600, 700, 2), over=("mass", 1, 2, 2)),
        lambda: paper.diagram(700, over=("mass", 2, 1, 2)),
        lambda: paper.diagram(700, over=("restitution", 0, 1, 2), log=True),
        lambda: paper.speeds((600, 700), over=("mass", 1, 2)),
        lambda: paper.design((600, 700), over=("mass", 1, 2, 2)),
        lambda: paper.design(over=("mass", 1, 2, 2)),
        lambda: paper.design((600, 700), log=True),
        lambda: paper.speeds(700),
    ):
        with pytest.raises(ValueError):
            call()
