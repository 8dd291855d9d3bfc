"""Do the notebooks run from top to bottom, and do the recipes for one machine run?"""

import runpy
import subprocess
import sys
import warnings
from pathlib import Path

import pytest

NOTEBOOKS = sorted((Path(__file__).parents[1] / "notebooks").glob("*.py"))


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_it_runs(notebook: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    assert notebook.read_text().startswith("# ---\n# jupyter:\n")
    with warnings.catch_warnings():
        # matplotlib warns that nothing is shown.
        warnings.filterwarnings("ignore", message="FigureCanvasAgg is non-interactive")
        runpy.run_path(str(notebook), run_name="__main__")


@pytest.mark.parametrize("name", ["processes", "dask_here"])
def test_a_recipe_runs(name: str, tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    recipe, model = (Path(__file__).parents[1] / part for part in (f"recipes/{name}.py", "../models/osorio-2008.toml"))
    words = [sys.executable, str(recipe), str(model), "chart.zarr", "12", "1"]
    ended = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, timeout=100)
    assert ended.stdout.splitlines() == ["0 of 1 blocks", "1 of 1 blocks"], ended.stderr
