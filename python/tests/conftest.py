"""Fixtures of all tests: the paper's model, and the command, with whose output the package is compared."""

import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from corner_impact import Model

ROOT = Path(__file__).parents[2]
MODELS = sorted((ROOT / "models").rglob("*.toml"))

Command = Callable[..., str]

# A process that a shell starts in the background ignores Ctrl-C, and so do its children: the tests would wait for ever.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session")
def paper() -> Model:
    return Model.paper()


@pytest.fixture(scope="session")
def command() -> Command:
    """Return a function that runs the installed command with some words and returns what it prints."""

    def run(*words: str) -> str:
        line = [sys.executable, "-m", "corner_impact", *words]
        return subprocess.run(line, capture_output=True, text=True, check=True, cwd=ROOT).stdout

    return run
