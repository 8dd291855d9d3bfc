"""Do a chart, a survey and the command give the motion from one start the same class and the same growth?"""

import json
from typing import Any

import numpy as np
import pytest
from conftest import Command

from corner_impact import Chart, Model, chart_variables

BUDGET = {"transient": 60, "record": 64, "longest": 8, "patience": 400}
WORDS = tuple(word for name, value in BUDGET.items() for word in (f"--{name}", str(value)))


def told(entry: dict[str, Any]) -> tuple[str, float, int]:
    growth = entry["growth"]
    return entry.get("kind") or entry["ending"], -np.inf if growth is None else growth, entry["followed"]


@pytest.mark.parametrize("rpm", [183.0, 664.0, 670.0, 700.0])
def test_a_chart_a_survey_and_the_command_agree(paper: Model, command: Command, rpm: float) -> None:
    chart = Chart(paper, {"rpm": [rpm], "restitution": [0.8]}, position=0.8, velocity=0, **BUDGET)
    assert (chart.longest, chart.patience) == (8, 400)
    found = chart.compute()
    meanings = next(it for it in chart_variables() if it["name"] == "class")["attributes"]["flag_meanings"].split()
    word = meanings[int(found["class"][0, 0])]
    expected = (word, float(found["growth_rate"][0, 0]), int(found["followed"][0, 0]))
    survey = paper.speeds(
        (rpm, rpm + 1), step=1, states=[(0.8, 0)], transient=60, record=64, longest=8, patience=400
    )
    here = [at for it in survey["attractors"] for at in it["shares"] if at["speed_rpm"] == rpm]
    assert [told(at) for at in here] == [expected]
    basins = json.loads(command("basins", "--rpm", str(rpm), "--state", "0.8,0", "--summary", *WORDS))
    assert [told(it) for it in basins["endings"]] == [expected]


def test_a_budget_that_cannot_be_is_refused(paper: Model) -> None:
    for name in ("record", "longest"):
        with pytest.raises(ValueError, match=f"{name} 0: "):
            Chart(paper, {"rpm": [700.0], "restitution": [0.8]}, **{name: 0})
