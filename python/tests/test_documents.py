"""Do the examples of docs/python.md hold?"""

import doctest
from pathlib import Path

import pytest


def test_the_page_holds() -> None:
    pytest.importorskip("xarray")
    page = Path(__file__).parents[2] / "docs/python.md"
    failed, attempted = doctest.testfile(str(page), module_relative=False, optionflags=doctest.ELLIPSIS)
    assert failed == 0 and attempted >= 19, attempted


def test_the_examples_of_charts_hold() -> None:
    charts = pytest.importorskip("corner_impact.charts")
    failed, attempted = doctest.testmod(charts)
    assert failed == 0 and attempted >= 4, attempted
