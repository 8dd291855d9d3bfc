"""Does Ctrl-C end long calls, and does other work continue meanwhile?"""

import os
import signal
import threading
import time
from typing import Any

import numpy as np
import pytest

from corner_impact import Chart, Model

MANY = np.full(1000, 5.0)


@pytest.mark.parametrize(
    "work",
    [
        lambda it: it.simulate(670, transient=10**12),
        lambda it: it.simulate(115, transient=10**12),
        lambda it: it.diagram((600, 700, 9), transient=10**11),
        lambda it: it.diagram((600, 700, 9), transient=10**11, follow="up"),
        lambda it: it.diagram((600, 700, 9), record=10**11, threads=1, strobe=1.0, lyapunov=True),
        lambda it: it.strobe_map(670, MANY, 0 * MANY, 10**10),
        lambda it: it.strobe_map(670, MANY, 0 * MANY, 10**10, jacobian=True, threads=2),
        lambda it: Chart(it, {"mass": 1.0 + 0.001 * MANY * np.arange(1000), "rpm": 600 + np.arange(1000.0)}).compute(),
        lambda it: it.locate((50, 3000), 4),
        lambda it: it.speeds((50, 3000), speeds=10_000),
        lambda it: it.certify((300, 1500), orbits=True, bits=16000),
    ],
    ids=["simulate", "touching", "diagram", "following", "strobe", "strobe_map", "jacobian", "grid", "locate",
         "speeds", "certify"],
)
def test_ctrl_c_ends_it(paper: Model, work: Any) -> None:
    turns = 0
    stop = threading.Event()

    def count() -> None:
        nonlocal turns
        while not stop.wait(0.01):
            turns += 1

    counting = threading.Thread(target=count)
    timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    counting.start()
    timer.start()
    begun = time.monotonic()
    try:
        with pytest.raises(KeyboardInterrupt):
            work(paper)
    finally:
        timer.cancel()
        stop.set()
        counting.join()
    # Without Ctrl-C each takes minutes. On a busy machine one second may become three.
    assert time.monotonic() - begun < 3.5
    assert turns > 10


def test_verify_ends_with_the_scripts_that_it_runs(
    paper: Model, tmp_path: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    script, told = tmp_path / "python", tmp_path / "told"
    script.write_text(f"#!/bin/sh\necho $$ >> {told}\nexec sleep 100\n")
    script.chmod(0o755)
    monkeypatch.setenv("CORNER_IMPACT_PYTHON", str(script))
    timer = threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    begun = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        paper.verify()
    assert time.monotonic() - begun < 5
    children = [int(line) for line in told.read_text().split()]
    assert len(children) == 3
    for child in children:
        until = time.monotonic() + 5
        while time.monotonic() < until:
            try:
                os.kill(child, 0)
            except ProcessLookupError:
                break
            time.sleep(0.01)
        else:
            pytest.fail(f"{child} is still there")


def test_a_handler_may_use_the_package(paper: Model) -> None:
    seen: list[int] = []

    def handler(*_: object) -> None:
        seen.append(len(paper.simulate(700, 10)["time_s"]))

    before = signal.signal(signal.SIGALRM, handler)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        paper.simulate(670, 1, transient=3_000_000)
    finally:
        signal.signal(signal.SIGALRM, before)
    assert len(seen) == 1 and seen[0] > 5
