# SPDX-License-Identifier: GPL-2.0-or-later
"""Where the command `epdem` begins, also as `python -m epdem.cli`."""

import signal


def main() -> None:
    """Ctrl-C while Python still loads modules ends the process without a traceback; then `main` sees to it."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    from .main import main as command

    command()


if __name__ == "__main__":
    main()
