"""The command `twintac`: the program of the Rust workspace, run in this process."""

import signal
import sys

from twintac._twintac import command


def main() -> None:
    """Runs the command with the arguments of the command line, and exits with its exit code."""
    # Ctrl-C ends the program at once; `record` handles it itself.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(command())
