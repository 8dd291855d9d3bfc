"""Time and accuracy of every peer on the same cam, measured together on this machine.

  python run.py [--quick] [--only NAME] [--question time|grazes|chattering|attractors] [--markdown FILE]

Prints one table per question, in Markdown, with the machine and the versions above them; `--markdown` writes the same to a file.
README.md says what each question is and how each peer is started.
"""

import argparse
import csv
import importlib.metadata
import json
import math
import platform
import statistics
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

import mpmath as mp

import attractors
from reference import Reference

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
MODEL = ROOT / "models/osorio-2008.toml"
PROGRAM = ROOT / "target/release/corner-impact"

# Name, variant, command, tolerance, and True if restarted at corners (None for both: the peer has neither).
PEERS = [
    ("diffrax", "default, across", [sys.executable, "diffrax_events.py"], "default", False),
    ("diffrax", "default, restarted", [sys.executable, "diffrax_events.py"], "default", True),
    ("diffrax", "tightest, across", [sys.executable, "diffrax_events.py"], "tightest", False),
    ("diffrax", "tightest, restarted", [sys.executable, "diffrax_events.py"], "tightest", True),
    ("scipy", "default, across", [sys.executable, "scipy_events.py"], "default", False),
    ("scipy", "default, restarted", [sys.executable, "scipy_events.py"], "default", True),
    ("scipy", "tightest, across", [sys.executable, "scipy_events.py"], "tightest", False),
    ("scipy", "tightest, restarted", [sys.executable, "scipy_events.py"], "tightest", True),
    ("heyoka.py", "default, restarted", [sys.executable, "heyoka_events.py"], "default", True),
    ("heyoka.py", "tightest, restarted", [sys.executable, "heyoka_events.py"], "tightest", True),
    ("SUNDIALS CVODE", "default, across", [sys.executable, "sundials_events.py"], "default", False),
    ("SUNDIALS CVODE", "default, restarted", [sys.executable, "sundials_events.py"], "default", True),
    ("SUNDIALS CVODE", "tightest, across", [sys.executable, "sundials_events.py"], "tightest", False),
    ("SUNDIALS CVODE", "tightest, restarted", [sys.executable, "sundials_events.py"], "tightest", True),
    ("diffsol", "default, across", ["diffsol/target/release/diffsol-events"], "default", False),
    ("diffsol", "default, restarted", ["diffsol/target/release/diffsol-events"], "default", True),
    ("diffsol", "tightest, across", ["diffsol/target/release/diffsol-events"], "tightest", False),
    ("diffsol", "tightest, restarted", ["diffsol/target/release/diffsol-events"], "tightest", True),
    ("scan and bisect", "256 steps a revolution", [str(ROOT / "target/release/baseline")], None, None),
    ("corner-impact", "", [str(PROGRAM)], None, None),
]
# The paper's x* in the cam's coordinates, to the digits that every program is given.
START = 5.397, 0.0
ROUNDS = 5
REVOLUTIONS, CHAOTIC_REVOLUTIONS = 100, 300
# A chaotic run is lost once an impact is off by this much, rad.
LOST = 1e-3
# Where and how deep flights dip into the cam: tangent to the nose, from several starts, so that no grid is lucky.
TOUCHES, BACKS = (2.70, 2.74, 2.78), (0.25, 0.29, 0.33, 0.37, 0.41, 0.45, 0.49, 0.53)
DEPTHS = range(2, 15)
# Longest time for one run, s, and for a process with all of its runs.
SECONDS, PROCESS_SECONDS = 30.0, 180.0
NOT_THERE = "not there"


def model():
    return tomllib.loads(MODEL.read_text())


class Answerless(Exception):
    """A peer gave no answer. The message says why."""


def task_for(reference, rpm, starts, turn, **options):
    arcs = [[float(x) for x in (c.start, c.distance, c.direction, c.radius)] for c in reference.circles]
    problem = {name: float(getattr(reference, name)) for name in ("omega0_squared", "equilibrium", "restitution", "omega")}
    numbers = {"rpm": rpm, "turn": turn, "starts": [[float(x) for x in start] for start in starts]}
    limits = {"repeats": 1, "look": False, "seconds": SECONDS}
    return {"model": str(MODEL), "problem": {**problem, "arcs": arcs}, **numbers, **limits, **options}


def ask(peer, task):
    """Return the results of a peer, one for each start. Raise Answerless if it gives none."""
    name, _, command, tolerance, restart = peer
    if not Path(command[0]).is_absolute():
        command = [str(HERE / command[0])]
    if not Path(command[0]).exists():
        raise Answerless(NOT_THERE)
    if name == "corner-impact":
        return [simulate(task, start) for start in task["starts"]]
    words = json.dumps({**task, "tolerance": tolerance, "restart": restart})
    try:
        done = subprocess.run(command, input=words, capture_output=True, text=True, cwd=HERE, timeout=PROCESS_SECONDS)
    except subprocess.TimeoutExpired:
        raise Answerless(f"no end in {PROCESS_SECONDS:.0f} s") from None
    if done.returncode != 0:
        raise Answerless((done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[-1])
    return json.loads(done.stdout)


def simulate(task, start):
    """Return the results of the project's own program, run by its command line. The wall time is that of the simulation, from its summary."""
    angle, q, v = start
    common = [str(PROGRAM), "simulate", str(MODEL), "--rpm", repr(task["rpm"])]
    common += ["--start-angle", repr(angle), "--state", f"{q!r},{v!r}"]
    # A run of less than a revolution is asked for its first impact only.
    revolutions = task["turn"] / math.tau
    length = ["--revolutions", str(round(revolutions))] if revolutions >= 1.0 else ["--impacts", "1"]
    with tempfile.TemporaryDirectory() as folder:
        events, walls = Path(folder) / "events.csv", []
        for output in [["--events", str(events)], *[[]] * task["repeats"]]:
            command = common + length + output + ["--json"]
            try:
                done = subprocess.run(command, capture_output=True, text=True, timeout=PROCESS_SECONDS)
            except subprocess.TimeoutExpired:
                raise Answerless(f"no end in {PROCESS_SECONDS:.0f} s") from None
            if done.returncode != 0:
                reason = (done.stderr.strip().splitlines() or [""])[0]
                raise Answerless(NOT_THERE if "unrecognized subcommand" in reason else reason)
            summary = json.loads(done.stdout)
            walls.append(summary["wall_s"])
        rows = list(csv.DictReader(events.read_text().splitlines()))
    turned = [(math.radians(6.0 * task["rpm"]) * float(row["time_s"]), row) for row in rows]
    impacts = [
        (turn, *(float(row[key]) for key in ("cam_angle_rad", "velocity_before_m_s", "velocity_after_m_s")))
        for turn, row in turned
        if row["event"] in ("impact", "stick") and turn <= task["turn"]
    ]
    kinds = [row["event"] for row in rows]
    return {
        "impacts": impacts, "sticks": kinds.count("stick"), "releases": kinds.count("release"), "wall_s": walls[1:],
        "ended": "done", "turned": task["turn"],
    }  # fmt: skip


def phase_errors(impacts, reference):
    """Return |phase error| of each impact, rad. It is infinite where an impact is missing or another one has come between."""
    errors = []
    for (turned, angle, *_), (wanted_turned, wanted_angle, *_) in zip(impacts, reference):
        error = abs(float(mp.fmod(mp.mpf(angle) - wanted_angle + mp.pi, 2 * mp.pi) - mp.pi))
        errors.append(error if abs(turned - float(wanted_turned)) < 1.0 else math.inf)
    return errors


# ------------------------------------------------------------------------------------------------------------- The tables


def speed_and_accuracy(peers, quick):
    """Measure the time of a revolution at 700 rpm with the phase error at the end, and how long chaos at 670 rpm is followed."""
    turn, long_turn = (math.tau * (10 if quick else revolutions) for revolutions in (REVOLUTIONS, CHAOTIC_REVOLUTIONS))
    calm, wild = Reference(model(), 700), Reference(model(), 670)
    start = float(calm.corner + mp.pi), *START
    steady, chaos = calm.run(start[0], start[1:], turn), wild.run(start[0], start[1:], long_turn)
    times, results = {peer: [] for peer in peers}, {}
    task = task_for(calm, 700.0, [start], turn)
    # Round after round, so that a slow spell of the machine affects all peers.
    for _ in range(1 if quick else ROUNDS):
        for peer in peers:
            try:
                results[peer] = ask(peer, task)[0]
                times[peer] += results[peer]["wall_s"]
            except Answerless as reason:
                results[peer] = reason
    rows = []
    for peer in peers:
        found = results[peer]
        if isinstance(found, Answerless):
            rows.append([*peer[:2], str(found), "", "", ""])
            continue
        errors = phase_errors(found["impacts"], steady)
        if found["ended"] != "done":
            error = found["ended"]
        elif len(found["impacts"]) != len(steady):
            error = f"{len(found['impacts'])} impacts instead of {len(steady)}"
        else:
            error = f"{errors[-1]:.0e}"
        time = statistics.median(times[peer]) / (found["turned"] / math.tau)
        try:
            followed = ask(peer, task_for(wild, 670.0, [start], long_turn))[0]["impacts"]
            errors = phase_errors(followed, chaos)
            lost = next((k for k, error in enumerate(errors) if not error <= LOST), len(errors))
            at = chaos[lost][0] if lost < len(chaos) else long_turn
            kept = f"{'' if lost < len(chaos) else '> '}{int(at / (2 * mp.pi))}"
        except Answerless as reason:
            kept = str(reason)
        first = found["setup_s"] if "setup_s" in found else 0.0
        rows.append([*peer[:2], nanoseconds(time), milliseconds(first), error, kept])
    head = ["by", "how", "time a revolution", "to set up", f"phase error, rad, after {turn / math.tau:.0f} revolutions"]
    return head + ["revolutions of chaos followed"], rows


def nanoseconds(seconds):
    return f"{seconds * 1e9:,.0f} ns"


def milliseconds(seconds):
    return f"{seconds * 1e3:.0f} ms" if seconds > 5e-4 else ""


def grazes(peers, quick):
    """Find the shallowest dip below the cam that is found from all starts, with all deeper ones. Also count hits of flights that pass
    above."""
    reference = Reference(model(), 700)
    backs = BACKS[::4] if quick else BACKS
    places = [(touch, back) for touch in TOUCHES for back in backs]
    # Far enough for the widest dip, and not so far that a flight returns.
    turn = max(backs) + 0.15

    def start(place, offset):
        return reference.graze(*place, mp.mpf(offset))

    for place in places:
        theta, *state = start(place, -1e-2)
        assert state[0] - reference.circle_at(theta).law(theta)[0] > 1e-3, "flights start above the cam"
        assert not reference.run(theta, start(place, 1e-14)[1:], turn), "and pass it once"
        assert reference.run(theta, start(place, -1e-14)[1:], turn, most=1), "and dip into it"
    starts = {sign: [start(place, sign * mp.mpf(10) ** -depth) for depth in DEPTHS for place in places] for sign in (-1, 1)}
    rows = []
    for peer in peers:
        try:
            hits = {}
            for sign, flights in starts.items():
                found = iter(ask(peer, task_for(reference, 700.0, flights, turn)))
                hits[sign] = {depth: sum(near(next(found), back) for _, back in places) for depth in DEPTHS}
        except Answerless as reason:
            rows.append([*peer[:2], str(reason), "", ""])
            continue
        whole = len(places)
        rows.append([
            *peer[:2],
            shallowest(depth for depth in DEPTHS if hits[-1][depth] < whole),
            " ".join(f"{hits[-1][depth]}" for depth in DEPTHS),
            " ".join(f"{hits[1][depth]}" for depth in DEPTHS) if any(hits[1].values()) else "none",
        ])  # fmt: skip
    head = ["by", "how", "smallest graze always found", f"found of {len(places)} at 1e-2 m, 1e-3 m, … 1e-14 m"]
    return head + ["hits where the flight passes above"], rows


def near(result, back):
    """Return True if there is an impact near the graze."""
    return any(abs(turned - back) < 0.15 for turned, *_ in result["impacts"])


def shallowest(missed):
    """Return the depth before the first one that was missed."""
    first = min(missed, default=max(DEPTHS) + 1)
    return f"1e-{first - 1} m" if first > min(DEPTHS) else f"misses 1e-{first} m"


def chattering(peers, quick):
    """Run one revolution at 183 rpm from a flight that ends in infinitely many impacts, sticking and release."""
    reference = Reference(model(), 183)
    # The follower is released at P, where the cam's acceleration jumps. The start is 0.3 rad later.
    theta = reference.corner + mp.mpf("0.3")
    lift, slope = reference.circle_at(reference.corner).law(reference.corner)
    start = theta, *reference.flight((lift, reference.omega * slope), mp.mpf("0.3") / reference.omega)
    rows = []
    for peer in peers:
        try:
            found = ask(peer, task_for(reference, 183.0, [start], math.tau, look=True, repeats=1))[0]
        except Answerless as reason:
            rows.append([*peer[:2], str(reason), "", "", ""])
            continue
        impacts, ended = found["impacts"], found["ended"]
        count = found.get("count", len(impacts))
        turned = math.degrees(found["turned"])
        words = {
            "done": "gets through the revolution",
            "through the cam": f"falls through the cam, {turned:.2f}° on",
            "time limit": f"no end in {SECONDS:.0f} s, {turned:.2f}° on",
            "stands still": f"impacts without end at one instant, {turned:.4f}° on",
        }.get(ended, f"{ended}, {turned:.2f}° on")
        sticks = f", sticks {found['sticks']}, releases {found['releases']}" if "sticks" in found else ""
        last = f"{abs(impacts[-1][3] - impacts[-1][2]):.0e}" if impacts else ""
        rows.append([*peer[:2], words + sticks, f"{count:,}", last, f"{statistics.median(found['wall_s']):.2g} s"])
    return ["by", "how", "what it does", "impacts", "last jump of the velocity, m/s", "time"], rows


def global_answer(peers, quick):
    """Find the attractors at twenty speeds, and how many starts end on each."""
    loop = ROOT / "target/release/baseline"
    reference = Reference(model(), 700)
    circles = task_for(reference, 700.0, [], 0.0)["problem"]["arcs"]
    return attractors.table(loop, PROGRAM, MODEL, circles, float(reference.restitution))


QUESTIONS = {
    "time": ("Time and accuracy", speed_and_accuracy),
    "grazes": ("Grazes", grazes),
    "chattering": ("Chattering at 183 rpm", chattering),
    "attractors": ("What runs end on", global_answer),
}


def machine():
    """Return the kind of machine and the versions with which the numbers were measured, without naming the machine."""
    cpu = next(line.split(":")[1].strip() for line in Path("/proc/cpuinfo").read_text().splitlines() if "model name" in line)
    cores = sum(line.startswith("processor") for line in Path("/proc/cpuinfo").read_text().splitlines())
    release = platform.freedesktop_os_release()["PRETTY_NAME"]
    rust = subprocess.run(["rustc", "--version"], capture_output=True, text=True).stdout.split()[1]
    pinned = (HERE / "requirements.txt").read_text().split()
    packages = [f"{name} {importlib.metadata.version(name)}" for name in (line.split("==")[0] for line in pinned)]
    lock = tomllib.loads((HERE / "diffsol/Cargo.lock").read_text())["package"]
    packages += [f"diffsol {package['version']}" for package in lock if package["name"] == "diffsol"]
    return (
        f"{cpu}, {cores} cores, {platform.system()} {platform.release().split('-')[0]}, {release}; rustc {rust}, "
        f"Python {platform.python_version()}, {', '.join(packages)}."
    )


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer revolutions, rounds and starts: does it run?")
    parser.add_argument("--only", help="peers whose name contains this")
    parser.add_argument("--question", choices=QUESTIONS, help="this one alone")
    parser.add_argument("--markdown", type=Path, help="write the tables to this file too")
    arguments = parser.parse_args()
    peers = [(name, how, tuple(command), *rest) for name, how, command, *rest in PEERS]
    peers = [peer for peer in peers if not arguments.only or arguments.only in peer[0]]
    parts = [machine()]
    print(parts[0], flush=True)
    for name, (title, question) in QUESTIONS.items():
        if arguments.question not in (None, name):
            continue
        parts.append(f"### {title}\n\n{table(*question(peers, arguments.quick))}")
        print("\n" + parts[-1], flush=True)
    if arguments.markdown:
        arguments.markdown.write_text("\n\n".join(parts) + "\n")


if __name__ == "__main__":
    main()
