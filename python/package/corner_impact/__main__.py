"""The command `corner-impact`, as `python -m corner_impact` and as pip installs it."""

import signal
import sys

from corner_impact import _native


def main() -> int:
    """Run the command with the words of the command line, and return its exit code."""
    # Ctrl-C ends the command by the default handler. The program itself leaves nothing half done.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _native.main(["corner-impact", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
