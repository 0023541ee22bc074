"""A small client of the Debug Adapter Protocol, which editors speak: debugpy's adapter in a process of its own.

    with Debugged(configuration, folder) as program:
        program.start({file: [line]})
        stop = program.stopped()
"""

from __future__ import annotations

import itertools
import json
import os
import subprocess
import sys
from collections import deque
from pathlib import Path
from typing import Any, NamedTuple, Self

from tests.hil.waiting import TIMEOUT_S

REPOSITORY = Path(__file__).parents[3]


class Frame(NamedTuple):
    """A line of the call stack."""

    function: str
    file: str
    line: int
    number: int


class Debugged:
    """A program under the debugger, as a `launch` configuration of VS Code starts it."""

    def __init__(self, configuration: dict[str, Any], folder: Path) -> None:
        self._adapter = subprocess.Popen(
            [sys.executable, "-m", "debugpy.adapter"], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )  # fmt: skip
        self._numbers = itertools.count(1)
        self._events: deque[dict[str, Any]] = deque()
        #: What the program wrote to stdout.
        self.output = ""
        path = os.pathsep.join(filter(None, (str(REPOSITORY), os.environ.get("PYTHONPATH"))))
        self._launch = {
            **configuration, "cwd": str(folder), "python": [sys.executable], "console": "internalConsole",
            "env": {**os.environ, "PYTHONPATH": path, "PYDEVD_DISABLE_FILE_VALIDATION": "1"},
        }  # fmt: skip
        self._thread = 0

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        # The adapter ends the program with itself.
        for pipe in (self._adapter.stdin, self._adapter.stdout):
            assert pipe is not None
            pipe.close()
        try:
            self._adapter.wait(TIMEOUT_S)
        except subprocess.TimeoutExpired:
            self._adapter.kill()
            raise

    def start(self, breakpoints: dict[Path, list[int]]) -> None:
        """Set breakpoints and let it run.  A breakpoint that the debugger does not take fails."""
        self.ask("initialize", adapterID="debugpy", linesStartAt1=True, columnsStartAt1=True, pathFormat="path")
        launching = self._send("launch", self._launch)
        self._event("initialized")
        for file, lines in breakpoints.items():
            self.breakpoints(file, lines)
        self.ask("configurationDone")
        self._answer(launching)

    def breakpoints(self, file: Path, lines: list[int]) -> None:
        """The breakpoints of a file from now on."""
        told = self.ask("setBreakpoints", source={"path": str(file)}, breakpoints=[{"line": line} for line in lines])
        assert [each["verified"] for each in told["breakpoints"]] == [True] * len(lines), told

    def stopped(self) -> list[Frame]:
        """Wait until it stops; the call stack, innermost first."""
        body = self._event("stopped", "terminated")["body"]
        assert "threadId" in body, f"it ended: {self.output}"
        self._thread = body["threadId"]
        frames = self.ask("stackTrace", threadId=self._thread)["stackFrames"]
        return [Frame(each["name"], each["source"]["path"], each["line"], each["id"]) for each in frames]

    def local(self, frame: Frame) -> dict[str, str]:
        """The local variables of a frame."""
        scopes = self.ask("scopes", frameId=frame.number)["scopes"]
        (reference,) = (each["variablesReference"] for each in scopes if each["name"] == "Locals")
        return {v["name"]: v["value"] for v in self.ask("variables", variablesReference=reference)["variables"]}

    def value(self, expression: str, frame: Frame) -> str:
        """What an expression is in a frame."""
        return str(self.ask("evaluate", expression=expression, frameId=frame.number, context="repl")["result"])

    def go_on(self, how: str = "continue") -> None:
        """`continue`, or `next`: to the next line."""
        self.ask(how, threadId=self._thread)

    def ended(self) -> int:
        """Wait until it ends; its exit status."""
        return int(self._event("exited")["body"]["exitCode"])

    def ask(self, command: str, **arguments: Any) -> Any:
        """A request, and the body of its answer."""
        return self._answer(self._send(command, arguments))

    def _send(self, command: str, arguments: dict[str, Any]) -> int:
        number = next(self._numbers)
        message = {"seq": number, "type": "request", "command": command, "arguments": arguments}
        body = json.dumps(message).encode()
        assert self._adapter.stdin is not None
        self._adapter.stdin.write(b"Content-Length: %d\r\n\r\n%b" % (len(body), body))
        self._adapter.stdin.flush()
        return number

    def _answer(self, number: int) -> Any:
        while True:
            message = self._read()
            if message["type"] == "response" and message["request_seq"] == number:
                assert message["success"], message
                return message.get("body")

    def _event(self, *names: str) -> dict[str, Any]:
        while True:
            while self._events:
                event = self._events.popleft()
                if event["event"] in names:
                    return event
            self._read()

    def _read(self) -> dict[str, Any]:
        """The next message; events are kept."""
        assert self._adapter.stdout is not None
        length = 0
        while (line := self._adapter.stdout.readline()) != b"\r\n":
            assert line, f"the debugger has gone: {self.output}"
            name, _, value = line.partition(b":")
            length = int(value) if name.lower() == b"content-length" else length
        message: dict[str, Any] = json.loads(self._adapter.stdout.read(length))
        if message["type"] == "event":
            if message["event"] == "output" and message["body"].get("category") == "stdout":
                self.output += message["body"]["output"]
            self._events.append(message)
        return message
