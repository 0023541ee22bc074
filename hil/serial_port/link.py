"""A stable name for a pseudo-terminal: a symbolic link whose name the user chose (``COM3``).

Files of other programs are never touched.  A record and a lock in a private directory, below the system's directory for
temporary files, say which links are ours.  While the lock is held, the robot of that link runs.  If the lock is free
and the record matches the link, the robot was killed; then the link is replaced.
"""

from __future__ import annotations

import fcntl
import hashlib
import os
import tempfile
from pathlib import Path

from hil.serial_url import PortError


class PortLink:
    """The symbolic link `name` -> `target`.  It exists while this object is open."""

    def __init__(self, name: str | Path, target: str, *, records: Path | None = None) -> None:
        """Create the link.  Raises PortError if another file or a running robot has this name."""
        self.path = Path(os.path.abspath(name))
        self.target = target
        folder = records or Path(tempfile.gettempdir()) / f"hil-links-{os.getuid()}"
        try:
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            if folder.stat().st_uid != os.getuid():
                raise PortError(f"{folder}: belongs to another user, so the link {name} cannot be recorded there")
            record = folder / hashlib.sha256(os.fsencode(self.path)).hexdigest()[:32]
            self._record = os.open(record, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
        except OSError as error:
            raise PortError(f"cannot record the link {name}: {error.strerror} ({error.filename})") from None
        try:
            self._take()
        except BaseException:
            os.close(self._record)
            raise
        self._closed = False

    def _take(self) -> None:
        try:
            fcntl.flock(self._record, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise PortError(f"{self.path}: is the port of a robot that is running; choose another name") from None
        recorded = os.fsdecode(os.pread(self._record, 4096, 0))
        if self.path.is_symlink():
            existing = os.readlink(self.path)
            if existing != recorded:
                raise PortError(f"{self.path}: exists and is not a link of ours (it points to {existing})")
            self.path.unlink()
        try:
            os.symlink(self.target, self.path)  # atomic, and never replaces anything
        except FileExistsError:
            raise PortError(f"{self.path}: exists and is not a link of ours; choose another name") from None
        except OSError as error:
            raise PortError(f"{self.path}: cannot create the link ({error.strerror})") from None
        os.ftruncate(self._record, 0)
        os.pwrite(self._record, os.fsencode(self.target), 0)

    def close(self) -> None:
        """Remove the link, unless it has been replaced by something else."""
        if self._closed:
            return
        self._closed = True
        try:
            if os.readlink(self.path) == self.target:
                self.path.unlink()
        except OSError:
            pass  # gone already, or no longer a link: not ours any more
        os.ftruncate(self._record, 0)
        os.close(self._record)
