"""Do the examples of the documentation hold, and is the command installed?"""

import doctest
import inspect
import subprocess
import sys
from pathlib import Path

import corner_impact
from corner_impact import Model


def test_the_examples_hold() -> None:
    failed, attempted = doctest.testmod(corner_impact, extraglobs={"Model": corner_impact.Model})
    assert failed == 0 and attempted >= 25, attempted


def test_everything_is_documented() -> None:
    assert inspect.getdoc(corner_impact)
    for name in corner_impact.__all__:
        if name in ("EVENTS", "__version__"):
            continue
        value = getattr(corner_impact, name)
        assert inspect.getdoc(value), name
        for inside, method in vars(value).items() if inspect.isclass(value) else ():
            if not inside.startswith("_"):
                assert inspect.getdoc(method), f"{name}.{inside}"


def test_the_command_is_installed() -> None:
    line = [sys.executable, "-m", "corner_impact"]
    version = subprocess.run([*line, "--version"], capture_output=True, text=True, check=True).stdout
    assert version == f"corner-impact {corner_impact.__version__}\n"
    wrong = subprocess.run([*line, "simulate", "--rpm", "0"], capture_output=True, text=True)
    assert wrong.returncode == 2 and "above 0" in wrong.stderr


def test_a_live_page_is_shown_and_saved(tmp_path: Path) -> None:
    try:
        page = Model.paper().with_number("restitution", 0.7).explore()
    except RuntimeError as error:
        assert "make explore" in str(error)
        return
    assert "Explore.mount" in page.html and "restitution = 0.7" in page.html
    page.save(tmp_path / "page.html")
    assert (tmp_path / "page.html").read_text(encoding="utf-8") == page.html
    assert page._repr_html_().startswith("<iframe") and 'srcdoc="' in page._repr_html_()
