"""``python -m hil`` and the installed command ``hil``: first what signals mean, then all that takes long to import."""

from __future__ import annotations

import sys

from hil import ending
from hil.bytecode import incomplete_file, remedy


def main() -> None:
    """Entry point of ``hil`` and ``python -m hil``."""
    ending.leaves()
    try:
        from hil.collector import collect_no_more, collect_rarely

        collect_rarely()
        from hil.cli import invoke
        from hil.cli.commands import import_chosen

        import_chosen(sys.argv[1:])
    except EOFError as error:
        if not (path := incomplete_file(error)):
            raise
        sys.exit(_refused(remedy(path)))
    try:
        ending.interrupts()
        status = invoke()
        ending.ignored()
    except KeyboardInterrupt:  # while the last line was written
        ending.ignored()  # or the time of an interrupted command runs out while Python tidies up
        status = ending.EXIT_INTERRUPTED
    collect_no_more()
    sys.exit(status)


def _refused(why: str) -> int:
    """One line and its exit status, without what `hil.cli` would need."""
    print(f"hil: error: {why}", file=sys.stderr)
    return 2


if __name__ == "__main__":
    main()
