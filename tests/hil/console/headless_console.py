"""A console program without windows: run by the tests, never imported.  Its argument file says what to do."""

import os
import signal
import sys
from msvcrt import kbhit

import helper
import serial

PATH = "D:/año/configuracion.txt"
with open(PATH, encoding="utf-8") as configuration:
    name = configuration.read()[:4]
with serial.Serial(name, 9600, timeout=0.25) as port:
    print("kbhit", callable(kbhit), helper.KBHIT is kbhit)
    print("msvcrt hidden", "msvcrt" not in sys.modules)
    print(
        "as python runs it",
        __name__,
        os.path.basename(__file__),
        sys.argv == [__file__],
        sys.path[0] == os.path.dirname(__file__),
    )
    deed = os.environ["DEED"]
    port.write(b"#TELE\r#SETR0.1,0.0\r")
    answer = b""
    while answer.count(b"\r") < 3:
        answer += port.read(max(1, port.in_waiting))
    with open("received.bin", "wb") as file:
        file.write(answer)
    print("ready")
    if deed == "fail":
        raise RuntimeError("no battery")
    if deed == "stay":
        signal.pause()
    if deed == "stubborn":
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        print("stubborn")
        while True:
            signal.pause()
