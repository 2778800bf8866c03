"""The command `twintac`: the same program as that of Rust, in this process."""

import signal
import sys

from twintac._twintac import command


def main() -> None:
    """Does what the command line asks for."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C ends the program at once; `record` listens to it by itself
    sys.exit(command())
