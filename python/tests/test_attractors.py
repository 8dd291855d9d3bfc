"""Is an attractor of `Model.speeds` what `Model.orbits` and `Chart` find at that speed? `tests/it/same_attractors.rs` asks the commands."""

import tomllib

import numpy as np
import pytest

from corner_impact import Chart, Model, chart_variables


@pytest.mark.parametrize(("restitution", "rpm"), [(0.8, 700.0), (0.6, 750.0), (0.3, 600.0)])
def test_an_attractor_is_the_same_whoever_finds_it(paper: Model, restitution: float, rpm: float) -> None:
    model = paper.with_number("restitution", restitution)
    attractors = model.speeds((rpm, rpm + 1), step=0.5, starts=16)["attractors"]
    here = [share for one in attractors for share in one["shares"] if share["speed_rpm"] == rpm and share["share"]]
    assert here
    names = next(it for it in chart_variables() if it["name"] == "class")["attributes"]["flag_meanings"].split()
    axes = {"mass": [tomllib.loads(model.text)["follower"]["mass"]], "rpm": [rpm]}
    chart = Chart(model, axes, transient=200, record=1600, patience=100_000).compute()
    assert names[chart["class"][0, 0]] in {share["kind"] for share in here}
    for share in here:
        if share["kind"] != "periodic" or share["revolutions"] > 4:
            continue
        orbits = model.orbits(rpm, share["revolutions"])["orbits"]
        stable = [orbit for orbit in orbits if orbit["stable"] and len(orbit["impacts"]) == share["impacts"]]
        assert stable
        position, velocity = stable[0]["state"]
        found = Chart(model, axes, position=position, velocity=velocity, transient=200).compute()
        assert names[found["class"][0, 0]] == "periodic"
        assert (found["revolutions"][0, 0], found["impacts"][0, 0]) == (share["revolutions"], share["impacts"])
        assert np.isclose(found["growth_rate"][0, 0], share["growth"], rtol=1e-6)
        assert np.isclose(found["impact_speed"][0, 0], share["impact_speed_m_s"], rtol=1e-6)
