# SPDX-License-Identifier: GPL-2.0-or-later
"""Where the command `epdem` begins, also as `python -m epdem`: the commands of the product and `epdem verify`."""

import signal


def main() -> None:
    """Ctrl-C while Python still loads modules ends the process without a traceback; then `cli.main` sees to it."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    from .cli.main import main as command
    from .verification.commands import app

    command(app)


if __name__ == "__main__":
    main()
