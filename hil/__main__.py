"""``python -m hil`` and the installed command ``hil``: first what signals mean, then all that takes long to import."""

from __future__ import annotations

import sys

from hil import ending


def main() -> None:
    """Entry point of ``hil`` and ``python -m hil``."""
    ending.leaves()
    from hil.collector import collect_no_more, collect_rarely

    collect_rarely()
    from hil.cli import invoke
    from hil.cli.commands import import_chosen

    import_chosen(sys.argv[1:])
    try:
        ending.interrupts()
        status = invoke()
        ending.ignored()
    except KeyboardInterrupt:  # while the last line was written
        ending.ignored()  # or the time of an interrupted command runs out while Python tidies up
        status = ending.EXIT_INTERRUPTED
    collect_no_more()
    sys.exit(status)


if __name__ == "__main__":
    main()
