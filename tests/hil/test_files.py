"""Files that a user names: read within bounds, written whole or not at all."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path

import pytest

from hil.files import NotWritten, check_target, growing, parse_json, parse_toml, read_bytes, read_text, replacing


def test_what_is_no_plain_file_is_refused_at_once(tmp_path: Path) -> None:
    fifo = tmp_path / "fifo"
    os.mkfifo(fifo)
    # Nobody writes to the FIFO, /dev/zero never ends: an answer is the proof.
    for path in (fifo, Path("/dev/zero"), tmp_path):
        with pytest.raises(ValueError, match=f"{path}: not a plain file"):
            read_bytes(path)


def test_the_bound_is_the_last_size_that_is_read(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_bytes(b"12345")
    assert read_bytes(file, most=5) == b"12345"
    with pytest.raises(ValueError, match="larger than 4 bytes"):
        read_bytes(file, most=4)


def test_text_is_utf_8_with_or_without_its_mark(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_bytes(b"\xef\xbb\xbf\xc3\xa1")
    assert read_text(file) == "á"
    file.write_bytes(b"ab\xff")
    with pytest.raises(ValueError, match="byte 2 is not UTF-8"):
        read_text(file)


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        ("a = " + "[" * 100_000, "brackets are nested too deeply"),
        ("\n\na = = 1\n", "file.toml:3: not TOML"),
        ("a = [", "file.toml:1: not TOML"),
        ("a = " + "9" * 5000, "file.toml: a number has thousands of digits"),
    ],
)
def test_what_is_no_toml_is_a_value_error_with_its_file(content: str, reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        parse_toml(content, "file.toml")


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        ("[" * 100_000, "brackets are nested too deeply"),
        ('{\n"a": }', "file.json:2: not JSON"),
        ("9" * 5000, "a number has thousands of digits"),
    ],
)
def test_what_is_no_json_is_a_value_error_with_its_file(content: str, reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        parse_json(content, "file.json")


def test_a_file_is_replaced_when_all_of_it_is_written(tmp_path: Path) -> None:
    file = tmp_path / "file.txt"
    file.write_text("before")
    file.chmod(0o640)
    with replacing(file) as new:
        new.write_text("after")
        assert file.read_text() == "before"
        assert new.suffix == ".txt"
    assert file.read_text() == "after"
    assert stat.S_IMODE(file.stat().st_mode) == 0o640
    assert os.listdir(tmp_path) == ["file.txt"]


def test_what_fails_leaves_the_old_file_and_nothing_else(tmp_path: Path) -> None:
    file = tmp_path / "file.txt"
    file.write_text("before")

    def interrupted() -> None:
        with replacing(file) as new:
            new.write_text("half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert file.read_text() == "before"
    assert os.listdir(tmp_path) == ["file.txt"]


def test_an_error_names_the_file_that_was_given(tmp_path: Path) -> None:
    file = tmp_path / "none" / "file.txt"
    with pytest.raises(NotWritten) as caught, replacing(file) as new:
        new.write_text("x")
    assert caught.value.filename == str(file)


def test_a_full_disk_names_the_file(tmp_path: Path) -> None:
    if not os.path.exists("/dev/full"):
        pytest.skip("this system has no /dev/full")
    with pytest.raises(OSError, match="No space left") as caught, replacing("/dev/full") as new:
        new.write_text("x")
    assert caught.value.filename == "/dev/full"


def test_a_link_stays_a_link_and_a_device_is_written_to(tmp_path: Path) -> None:
    (tmp_path / "real.txt").write_text("before")
    link = tmp_path / "link.txt"
    link.symlink_to("real.txt")
    with replacing(link) as new:
        new.write_text("after")
    assert link.is_symlink()
    assert (tmp_path / "real.txt").read_text() == "after"
    with replacing(os.devnull) as new:
        assert new == Path(os.devnull)


def test_where_a_file_cannot_be_is_told_before_anything_runs(tmp_path: Path) -> None:
    loop = tmp_path / "loop"
    loop.symlink_to(loop)
    for path, reason in (
        (loop, "the links form a loop"), (tmp_path, "it is a folder"), (tmp_path / "no" / "file", "no folder"),
    ):  # fmt: skip
        with pytest.raises(ValueError, match=f"{path}: .*{reason}"):
            check_target(path)
    check_target(tmp_path / "file")


def test_a_pipe_is_written_to_if_somebody_reads_it(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    # Nobody reads it: an answer is the proof that nobody waits.
    for writing in (lambda: replacing(pipe), lambda: growing(pipe, "utf-8")):
        with pytest.raises(OSError, match="nobody reads this pipe"), writing():
            pass
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    try:
        with growing(pipe, "utf-8") as file:
            file.write("one\n")
        with replacing(pipe) as path:
            path.write_text("two\n")
        assert os.read(reader, 100) == b"one\ntwo\n"
        assert pipe.is_fifo()
    finally:
        os.close(reader)


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="wants a device that is full")
def test_a_log_takes_what_it_can_and_its_end_names_it() -> None:
    told = OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), "/dev/full")
    log = growing("/dev/full", "ascii")
    file = log.__enter__()
    for _ in range(2):
        file.write("a line\n")
        file.flush()
    assert str(file.failure()) == str(told)
    with pytest.raises(OSError, match="/dev/full") as raised:
        log.__exit__(None, None, None)
    assert str(raised.value) == str(told)
