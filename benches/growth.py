"""Growth of the work of each command with its size: processor seconds, size by size, and the power between neighbouring sizes.

  python benches/growth.py [--seconds 30] [--only WORD]      or make bench-growth

Prints a table in Markdown. A row ends at the first size that takes more than --seconds. The program is built by `cargo build
--release`. The time of start-up, about 10 ms, is subtracted.
"""

import argparse
import math
import resource
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PROGRAM = ROOT / "target/release/corner-impact"
PAPER = ROOT / "models/osorio-2008.toml"
ROWS = [10, 100, 1_000, 10_000, 100_000]
FOLLOWER = """
name = "lobe"
[follower]
mass = 1.0
damping = 0.0
stiffness = 10000.0
gravity = 9.81
rest_position = -0.02
restitution = 0.6
[cam]
law = "table"
spline = "quintic"
file = "lobe.csv"
"""


def lobe(folder, rows):
    """Write a 3-4-5 lobe of 10 mm over the whole turn, as a table of so many rows, and return its model file."""
    lines = ["angle_deg,lift_m"]
    for row in range(rows):
        x = 1.0 - abs(2.0 * row / rows - 1.0)
        lines.append(f"{360.0 * row / rows!r},{0.01 * x**3 * (10.0 - 15.0 * x + 6.0 * x * x)!r}")
    (folder / "lobe.csv").write_text("\n".join(lines) + "\n")
    (folder / "lobe.toml").write_text(FOLLOWER)
    return folder / "lobe.toml"


def rows(words):
    return "rows", ROWS, lambda folder, size: [words[0], str(lobe(folder, size)), *words[1:]]


def paper(words, of, sizes):
    return of, sizes, lambda _, size: [words[0], str(PAPER), *(word.replace("N", str(size)) for word in words[1:])]


def square(words, sizes):
    """Return a task whose sizes are numbers of points. The command takes the side of their square."""
    of, _, command = paper(words, "points", sizes)
    return of, sizes, lambda folder, size: command(folder, math.isqrt(size))


LOWEST = 600  # rpm, of the range of locate
RESTITUTIONS = [0.9, 0.99, 0.999, 0.9999]
TASKS = [
    ("cam", rows(["cam"])),
    ("design --rpm 300:900", rows(["design", "--rpm", "300:900"])),
    ("simulate --rpm 800 --revolutions 1000", rows(["simulate", "--rpm", "800", "--revolutions", "1000"])),
    ("orbit --rpm 800", rows(["orbit", "--rpm", "800"])),
    ("speeds --rpm 800:820 --step 10", rows(["speeds", "--rpm", "800:820", "--step", "10", "--starts", "8"])),
    ("locate --rpm 800:820", rows(["locate", "--rpm", "800:820"])),
    ("simulate --rpm 670 --revolutions N", paper(["simulate", "--rpm", "670", "--revolutions", "N"], "revolutions", [10**k for k in range(3, 8)])),
    ("speeds --rpm 600:760 --speeds N", paper(["speeds", "--rpm", "600:760", "--speeds", "N"], "speeds", [5, 20, 80, 320])),
    ("speeds --rpm 676:680 --starts N", paper(["speeds", "--rpm", "676:680", "--step", "1", "--starts", "N"], "starts", [8, 64, 512, 4096])),
    ("diagram --rpm 600:760:N", paper(["diagram", "--rpm", "600:760:N", "--out", "-"], "speeds", [50, 200, 800, 3200])),
    ("design --rpm 300:700 --speeds N", paper(["design", "--rpm", "300:700", "--speeds", "N"], "speeds", [5, 20, 80, 320])),
    ("basins --rpm 678 --grid NxN", square(["basins", "--rpm", "678", "--grid", "NxN"], [400, 2500, 10_000, 40_000])),
    ("chart of N x N points", square(["chart", "--x", "rpm=600:760:N", "--y", "restitution=0.6:0.9:N", "--out", "-"], [100, 400, 2500, 10_000])),
    ("orbit --rpm 300 --impacts N", paper(["orbit", "--rpm", "300", "--impacts", "N"], "impacts", [1, 2, 3, 4, 5, 6])),
    ("continue --from-rpm 300 --impacts N", paper(["continue", "--from-rpm", "300", "--impacts", "N", "--parameter", "rpm=280:320"], "impacts", [3, 4])),
    ("locate --rpm 600:N", paper(["locate", "--rpm", f"{LOWEST}:N"], "highest speed, rpm", [610, 640, 760, 1200])),
    ("simulate --rpm 183 --restitution N", paper(["simulate", "--rpm", "183", "--revolutions", "1000", "--restitution", "N"], "restitution", RESTITUTIONS)),
    ("speeds --rpm 181:185 --restitution N", paper(["speeds", "--rpm", "181:185", "--step", "2", "--starts", "8", "--restitution", "N"], "restitution", RESTITUTIONS)),
]  # fmt: skip


def took(words, seconds):
    """Return (processor seconds of a command, None), or with the reason if there is no answer."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        done = subprocess.run([PROGRAM, *words], capture_output=True, text=True, timeout=4 * seconds, check=False)
    except subprocess.TimeoutExpired:
        return math.inf, "no end"
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return used, None if done.returncode == 0 else (done.stderr.strip().splitlines() or ["failed"])[0]


def scaled(of, size):
    """Return the number that the work should be proportional to: the size itself, except for a restitution and for the end of a range."""
    if of == "restitution":
        # The number of impacts until a rest grows as 1 / (1 - r).
        return 1.0 / (1.0 - size)
    # The range is searched at speeds in a fixed ratio.
    return math.log(size / LOWEST) if of.startswith("highest speed") else size


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--seconds", type=float, default=30.0)
    parser.add_argument("--only", default="")
    arguments = parser.parse_args()
    started = min(took(["--version"], 10.0)[0] for _ in range(5))
    print("| command | of | processor seconds, by size | largest power |\n|---|---|---|--:|")
    for name, (of, sizes, command) in TASKS:
        if arguments.only not in name:
            continue
        cells, powers, last = [], [], None
        for size in sizes:
            with tempfile.TemporaryDirectory() as folder:
                used, trouble = took(command(Path(folder), size), arguments.seconds)
            used = max(used - started, 0.0)
            cells.append(f"{size:,}: {trouble or f'{used:.2f}'}")
            scale = scaled(of, size)
            if trouble is None and last and last[1] > 0.05:
                powers.append(math.log(used / last[1]) / math.log(scale / last[0]))
            last = None if trouble else (scale, used)
            if used > arguments.seconds:
                break
        print(f"| `{name}` | {of} | {'; '.join(cells)} | {max(powers):.1f} |" if powers else f"| `{name}` | {of} | {'; '.join(cells)} | |", flush=True)


if __name__ == "__main__":
    main()
