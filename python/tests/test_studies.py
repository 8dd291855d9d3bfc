"""Are the documents those of the command?"""

import json
import venv
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Command

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
    ],
)
def test_documents_are_those_of_the_command(paper: Model, command: Command, ask: Any, words: list[str]) -> None:
    found = ask(paper)
    assert found == json.loads(command(*words, "--json"))
    assert found["schema"] == f"corner-impact/{words[0]}/1"


def test_a_model_with_another_number_is_that_of_the_command(paper: Model, command: Command) -> None:
    found = paper.with_number("restitution", 0.7).orbits(680)
    assert found == json.loads(command("orbit", "--rpm", "680", "--set", "restitution=0.7", "--json"))


def test_what_python_lacks_is_told(paper: Model, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CORNER_IMPACT_PYTHON", "/nowhere/python")
    with pytest.raises(ValueError, match="/nowhere/python.* did not start"):
        paper.certify((670, 680))
    found = paper.verify()
    assert not found["agrees"]
    assert {skipped["route"] for skipped in found["skipped"] if skipped["failed"]} == {
        "symbolic",
        "scipy",
        "certificate",
    }


def test_a_missing_package_is_told(paper: Model, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    bare = tmp_path / "bare"
    venv.create(bare, with_pip=False)
    monkeypatch.setenv("CORNER_IMPACT_PYTHON", str(bare / "bin" / "python"))
    with pytest.raises(ValueError, match="python-flint is missing") as raised:
        paper.certify((670, 680))
    assert "pip install 'corner-impact[routes]'" in str(raised.value)


def test_the_routes_run_in_this_interpreter(paper: Model, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("CORNER_IMPACT_PYTHON", raising=False)
    # Not the one of a build of the command, nor that of the PATH.
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
