"""Is a model the same from a file, a text and a dict, and does an error name its place?"""

import pickle
import tomllib
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import MODELS

from corner_impact import Model, ModelError


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.stem)
def test_a_text_is_the_whole_model(path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    model = Model.load(path)
    # The text does not need the file of a table.
    monkeypatch.chdir(tmp_path)
    again = Model.parse(model.text)
    assert again == model and hash(again) == hash(model) and again.text == model.text
    assert (again.name, again.source, again.numbers()) == (model.name, model.source, model.numbers())
    assert pickle.loads(pickle.dumps(model)) == model
    # Machines of valves stay on their cams at 650 rpm.
    rpm = 6000 if path.parent.name == "machines" else 650
    one, other = (it.simulate(rpm, 5) for it in (model, again))
    assert all(np.array_equal(one[name], other[name]) for name in one)
    assert len(one["time_s"]) > 0


@pytest.mark.parametrize("path", [path for path in MODELS if "file = " not in path.read_text()], ids=lambda path: path.stem)
def test_a_dict_is_a_file(path: Path) -> None:
    fields = tomllib.loads(path.read_text())
    model = Model.from_dict(fields)
    assert model == Model.load(path)
    # Numbers and arrays of numpy work as well.
    fields["follower"] = {name: np.float64(value) for name, value in fields["follower"].items()}
    assert Model.from_dict(fields) == model


def test_a_number_may_have_an_error() -> None:
    fields = tomllib.loads(Model.paper().text)
    fields["follower"]["mass"] = {"value": 1.221, "error": np.float64(0.004)}
    model = Model.from_dict(fields)
    assert model.errors() == {"follower.mass": 0.004} and Model.paper().errors() == {}
    assert model.numbers() == Model.paper().numbers() and model != Model.paper()
    assert Model.parse(model.text) == model and pickle.loads(pickle.dumps(model)) == model
    (found, exact) = (it.verify(external=False).get("uncertainty") for it in (model, model.with_number("mass.error", 0)))
    assert exact is None and found is not None and found["speed_parts"]["mass_rpm"] == found["speed_rpm"] > 1
    with pytest.raises(ModelError, match="follower.mass.error = -1"):
        Model.from_dict(fields | {"follower": fields["follower"] | {"mass": {"value": 1.2, "error": -1}}})


def table(rows: Any, **more: Any) -> dict[str, Any]:
    fields = tomllib.loads(next(path for path in MODELS if path.stem == "table-cubic").read_text())
    del fields["cam"]["file"]
    fields["cam"] |= {"rows": rows} | more
    return fields


def test_what_is_odd_about_a_model_is_told() -> None:
    angle = np.arange(0.0, 360.0, 2.0)
    lift = (0.05 - 0.01 * np.cos(np.radians(angle))).round(6)
    (known,) = Model.from_dict(table(np.column_stack([angle, lift]), spline="smoothing")).notes()
    assert "so the cam's second derivative is uncertain by" in known
    with pytest.warns(UserWarning, match="did you mean mm"):
        Model.from_dict(table(np.column_stack([angle, 1000.0 * lift]), spline="cubic"))
    lift[40] += 0.001
    with pytest.warns(UserWarning, match="cam.rows: lift .* at 80 deg .* a slip") as told:
        model = Model.from_dict(table(np.column_stack([angle, lift]), spline="smoothing"))
    assert [str(one.message) for one in told] == model.notes()[:1]


def test_rows_of_a_table_stand_in_a_dict() -> None:
    path = next(path for path in MODELS if path.stem == "table-cubic")
    file = path.with_name(tomllib.loads(path.read_text())["cam"]["file"])
    rows = np.loadtxt(file, delimiter=",", skiprows=1)
    assert Model.from_dict(table(rows)) == Model.from_dict(table(rows.tolist())) == Model.load(path)
    # A last row that repeats the first one is dropped.
    closed = np.vstack([rows, [360.0, rows[0, 1]]])
    assert Model.from_dict(table(closed)) == Model.load(path)
    # Falling angles give the same cam, and a row that repeats the one before is dropped.
    assert Model.from_dict(table(rows[::-1])) == Model.load(path)
    assert Model.from_dict(table(np.vstack([rows[:9], rows[8:]]))) == Model.load(path)
    other = [[rows[8, 0], rows[8, 1] + 0.1]]
    for wrong, words in [
        (rows[:2], "cam.rows has 2 rows; 3 to 1000000 are allowed"),
        ([], "has 0 rows"),
        (rows[:, 0], "must be a list of rows, each of two finite numbers"),
        (np.delete(rows, slice(40, 80), axis=0), "rows are missing"),
        (np.vstack([rows[:9], other, rows[9:]]), "repeats the angle of the row before with another lift: must be above 8, row 9"),
        (rows * [[2.0, 1.0]], "must be within a turn of the first row"),
    ]:
        with pytest.raises(ModelError, match="dict: ") as raised:
            Model.from_dict(table(wrong))
        assert words in str(raised.value) and raised.value.line is None
    with pytest.raises(ModelError, match="must not be given together with cam.rows"):
        Model.from_dict(table(rows, file="lift.csv"))


def test_rows_in_a_text_are_told_by_their_lines(paper: Model) -> None:
    text = Model.load(next(path for path in MODELS if path.stem == "table-cubic")).text
    lines = text.splitlines()
    first = lines.index("rows = [") + 1
    lines[first + 3] = lines[first + 2].split(",")[0] + ", 1.0],"
    with pytest.raises(ModelError) as raised:
        Model.parse("\n".join(lines))
    assert raised.value.line == first + 4


def test_complaints_have_a_place(paper: Model, tmp_path: Path) -> None:
    text = paper.text.replace("mass = 1.221", "mass = -1.0")
    file = tmp_path / "wrong.toml"
    file.write_text(text)
    line = 1 + text.splitlines().index("mass = -1.0")
    with pytest.raises(ModelError, match="must be a finite number above 0") as raised:
        Model.load(file)
    assert (raised.value.file, raised.value.line, raised.value.field) == (str(file), line, "follower.mass")
    assert isinstance(raised.value, ValueError)
    again = pickle.loads(pickle.dumps(raised.value))
    assert (str(again), again.file, again.line, again.field) == (str(raised.value), str(file), line, "follower.mass")
    with pytest.raises(ModelError, match="not valid TOML") as raised:
        Model.parse("[follower\n", "that text")
    assert (raised.value.file, raised.value.line, raised.value.field) == ("that text", 1, None)
    # An impossible geometry is refused at once, not when the model is run.
    with pytest.raises(ModelError, match="cam"):
        paper.with_number("nose_radius", 7.0)
    with pytest.raises(ModelError, match="cannot be read"):
        Model.load(tmp_path / "nowhere.toml")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"mass": float("nan")}, "follower.mass = null: must be a finite number above 0"),
        ({"mass": True}, "follower.mass = true: must be a finite number above 0"),
        ({"mass": None}, "follower.mass = null"),
        ({"mass": [1.0]}, "follower.mass: must be|follower.mass must be"),
        ({"mas": 1.0}, "follower.mas: unknown field|follower.mas = 1.0: unknown field"),
        ({"a.b": 1.0}, "must not have a dot or a bracket"),
    ],
)
def test_wrong_dicts_are_refused(paper: Model, change: dict[str, Any], words: str) -> None:
    fields = tomllib.loads(paper.text)
    fields["follower"] |= change
    with pytest.raises(ModelError, match=words) as raised:
        Model.from_dict(fields)
    assert (raised.value.file, raised.value.line) == ("dict", None)


def test_a_slip_in_a_dict_is_asked_about(paper: Model) -> None:
    fields = tomllib.loads(paper.text)
    fields["follower"]["mss"] = fields["follower"].pop("mass")
    with pytest.raises(ModelError, match=r"did you mean mass where it says mss\?"):
        Model.from_dict(fields)


def test_a_number_is_changed_as_by_the_command(paper: Model) -> None:
    other = paper.with_number("restitution", 0.7)
    assert other.numbers() == paper.numbers() | {"follower.restitution": 0.7}
    assert other.name == "osorio-2008 with follower.restitution = 0.7" and other != paper
    assert other.with_number("restitution", 0.6).with_number("mass", 1.0).name == (
        "osorio-2008 with follower.restitution = 0.6, follower.mass = 1"
    )
    assert Model.parse(other.text).name == other.name
    with pytest.raises(ModelError, match=r"did you mean restitution\?"):
        paper.with_number("restitutoin", 0.7)
    with pytest.raises(ModelError, match="from 0 to 1"):
        paper.with_number("restitution", 1.7)


def test_a_model_shows_its_cam(paper: Model) -> None:
    assert ET.fromstring(paper._repr_svg_()).tag.endswith("svg")
    assert repr(paper) == "Model('osorio-2008')"


def test_pictures_take_the_looks_of_the_command() -> None:
    paper = Model.paper()
    narrow = ET.fromstring(paper.cam_picture(width="85mm", height="160mm", theme="print"))
    for name, length in [("width", 85), ("height", 160)]:
        assert float(narrow.attrib[name].removesuffix("pt")) == pytest.approx(length * 72 / 25.4, abs=1)
    words = [text.text for text in narrow.iter() if text.tag.endswith("}text")]
    assert paper.name not in words and "cam angle θ (deg)" in words
    titles: list[tuple[bool | str, str]] = [(True, paper.name), ("Another", "Another")]
    for title, shown in titles:
        titled = ET.fromstring(paper.cam_picture(width="85mm", title=title))
        assert shown in [text.text for text in titled.iter() if text.tag.endswith("}text")]
    refused: list[tuple[dict[str, Any], str]] = [
        ({"width": "85"}, "width must be a number with its unit"),
        ({"width": "1mm"}, "10.6 to 847 mm"),
        ({"height": "20mm"}, "it needs"),
        ({"legend": "left"}, "legend must be none, above, below or right"),
        ({"theme": "dark"}, "theme must be screen or print"),
        ({"x_range": (2, 1)}, "x_range must be"),
        ({"y_range": (7, 8)}, "shows nothing"),
        ({"font": "No Such Letters"}, "is installed"),
    ]
    for looks, why in refused:
        with pytest.raises(ValueError, match=why):
            paper.cam_picture(**looks)
