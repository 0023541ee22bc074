"""Children that begin as copies: what comes back, and what is left behind (nothing).

Each case runs in a process of its own, because a process with other threads, as a test may have, is not copied.
"""

from __future__ import annotations

import json
import os
import select
import signal
import subprocess
import sys
from contextlib import suppress

import pytest

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="no os.fork here")

PRELUDE = """
import json, os, signal, sys, threading
from hil.audit.forked import ChildDied, in_child, in_children, possible

def died(function):
    try:
        in_child(function)
    except ChildDied as error:
        return str(error)

def children():
    try:
        os.waitpid(-1, os.WNOHANG)
    except ChildProcessError:
        return 0
    return 1

def open_files():
    found = 0
    for number in range(256):
        try:
            os.fstat(number)
        except OSError:
            continue
        found += 1
    return found

def show(*values):
    print(json.dumps(values))
"""


def run(code: str) -> list[object]:
    """What `show` is given in `code`."""
    command = [sys.executable, "-c", PRELUDE + code]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    shown: list[object] = json.loads(done.stdout)
    return shown


def test_a_process_with_another_thread_is_not_copied() -> None:
    code = """
before = possible()
end = threading.Event()
other = threading.Thread(target=end.wait)
other.start()
with_another = possible()
end.set()
other.join()
show(before, with_another)
"""
    assert run(code) == [True, False]


def test_a_child_finds_what_was_made_and_changes_only_its_copy() -> None:
    code = """
made = ["here"]
show(in_child(lambda: made.append("there") or made), made)
"""
    assert run(code) == [["here", "there"], ["here"]]


def test_a_result_longer_than_a_pipe_holds_comes_whole() -> None:
    # A pipe holds 64 KiB on Linux.
    assert run("show(len(in_child(lambda: 'x' * 3_000_000)))") == [3_000_000]


def test_a_child_without_a_result_says_why_in_one_line() -> None:
    code = """
def wrong():
    raise ValueError("no such thing")

show(
    died(wrong), died(lambda: os.kill(os.getpid(), signal.SIGKILL)), died(lambda: os._exit(3)),
    died(lambda: sys.exit("text")), died(lambda: threading.Lock()),
)
"""
    said = run(code)
    assert said[:4] == [
        "ValueError: no such thing", "its process was killed by SIGKILL",
        "its process ended with status 3 and gave no result", "its process ended with status 1 and gave no result",
    ]  # fmt: skip
    assert "cannot pickle" in str(said[4])


def test_children_run_side_by_side_and_each_answers_for_its_key() -> None:
    # Each waits until the other has begun: one after the other they would wait for ever.
    code = """
ends = [os.pipe(), os.pipe()]

def meet(me):
    os.write(ends[1 - me][1], b"!")
    os.read(ends[me][0], 1)
    return me * 10

calls = ((me, lambda me=me: meet(me)) for me in (0, 1))
show(sorted(in_children(calls, at_once=2)))
"""
    assert run(code) == [[[0, 0], [1, 10]]]


def test_a_call_is_taken_when_a_child_is_free_for_it() -> None:
    code = """
made = []

def calls():
    for key in range(3):
        yield key, lambda: list(made)

seen = []
for key, result in in_children(calls(), at_once=1):
    made.append(key)
    seen.append(result)
show(*seen)
"""
    assert run(code) == [[], [0], [0, 1]]


def test_nothing_is_left_behind_by_children_that_answer_die_or_are_given_up() -> None:
    code = """
before = open_files()
for _ in range(20):
    in_child(lambda: 1)
    died(lambda: os._exit(1))
running = in_children(((n, lambda n=n: signal.pause() if n else None) for n in range(4)), at_once=3)
first = next(running)
running.close()
show(first, children(), open_files() - before)
"""
    assert run(code) == [[0, None], 0, 0]


def test_ctrl_c_ends_the_children_too() -> None:
    code = """
def wait():
    os.write(1, b"%d\\n" % os.getpid())
    signal.pause()

signal.signal(signal.SIGINT, signal.default_int_handler)  # it is ignored in what a shell starts in the background
try:
    list(in_children(((n, wait) for n in range(2)), at_once=2))
except KeyboardInterrupt:
    print("interrupted", children(), flush=True)
"""
    with subprocess.Popen([sys.executable, "-c", PRELUDE + code], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        pids = [int(process.stdout.readline()) for _ in range(2)]
        process.send_signal(signal.SIGINT)
        assert process.stdout.readline() == "interrupted 0\n"
        assert process.wait(30) == 0
    for pid in pids:
        with pytest.raises(ProcessLookupError):
            os.kill(pid, 0)


@pytest.mark.skipif(not hasattr(os, "pidfd_open"), reason="no os.pidfd_open here")
def test_children_end_soon_when_their_parent_is_killed() -> None:
    code = """
alive, held = os.pipe()

def wait():
    os.write(1, b"%d\\n" % os.getpid())
    os.close(held)
    os.read(alive, 1)  # ends when the parent has, who alone holds the other side
    return "x" * 1_000_000

list(in_children([(0, wait)], at_once=1))
"""
    with subprocess.Popen([sys.executable, "-c", PRELUDE + code], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        pid = int(process.stdout.readline())
        process.kill()
    with suppress(ProcessLookupError):  # gone already
        child = os.pidfd_open(pid)
        try:
            assert select.select([child], [], [], 30)[0]
        finally:
            os.close(child)
