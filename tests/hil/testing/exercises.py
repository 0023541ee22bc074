"""How each driver of `specimens` is used, and what it then gives when it is right.

`drive(rig)` uses it and returns what it gave; the expected value beside it is worked out in the comment.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any


@dataclass
class Rig:
    """The plugin's fixtures that an exercise may use."""

    firmware: Any
    outside: Any
    uart: Any
    kernel: Any
    advance: Any
    later: Any


def adc_average(rig: Rig) -> Any:
    drv = rig.firmware.adc_average
    rig.outside.adc_codes([1000, 1001, 1002, 1003, 1004, 1005, 1006, 1007])
    drv.Init_ADC()
    mean = drv.Read_Mean()
    # A full scale window: the sum of eight is beyond 16 bits.
    rig.outside.adc_codes([4095])
    return mean, drv.Read_Mean(), drv.To_Millivolts(4095)


def adc_sequence(rig: Rig) -> Any:
    drv = rig.firmware.adc_sequence
    for channel, volts in ((2, 1.0), (3, 0.5), (4, 2.0)):
        rig.outside.adc_volts(channel, volts)
    drv.Init_Scan()
    return drv.Nearest(), drv.Nearest(), drv.Last.count


def gyro_fifo(rig: Rig) -> Any:
    drv = rig.firmware.gyro_fifo
    started = drv.Init_Gyro()
    rig.outside.gyro_raw(z=[-2, 300])
    rate = rig.firmware.new("int16", 0)
    taken = []
    for _ in range(30):
        if drv.Read_Z(rate):
            taken.append(rate.load())
        rig.advance(0.001)
    return started, taken[1:3], drv.Millidegrees(28571)


def wheel_speed(rig: Rig) -> Any:
    drv = rig.firmware.wheel_speed
    drv.Init_Speed()
    rig.outside.wheel_speed_rad_s("left", -20.0)
    updates = 0
    for _ in range(60):
        rig.advance(0.001)
        updates += drv.Update_Speed()
    return updates, abs(drv.Speed + 20.0) < 1.0, -21000 < drv.Millirad() < -19000


def motor_pwm(rig: Rig) -> Any:
    drv = rig.firmware.motor_pwm
    drv.Init_Motor()
    duties = []
    for speed in (2.0, -1.0, 0.5):
        drv.Set_Speed(speed, 1.0)
        rig.advance(0.0002)
        duties.append(round(rig.outside.pwm_duty(2), 3))
    period = rig.outside.pwm_period_s(2)
    rig.advance(0.01)
    drv.Set_Speed(0.5, 1.0)
    drv.Set_Speed(1.0, 0.0)
    return duties, period


def echo_poll(rig: Rig) -> Any:
    drv = rig.firmware.echo_poll
    line = rig.uart(84, 85, 38400)
    drv.Init_Echo()
    line.send(b"abc", gap_s=0.0005)
    drv.Echo(3)
    rig.advance(0.001)
    return line.received, drv.Errors


def line_fifo(rig: Rig) -> Any:
    drv = rig.firmware.line_fifo
    line = rig.uart(84, 85, 9600)
    drv.Init_Line()
    text = rig.firmware.array("char", [None] * 32)
    lengths = []
    for sent in (b"hello\n", b"a line that is rather too long\n"):
        line.send(sent)
        for _ in range(80):
            rig.advance(0.0005)
            if drv.Poll_Line():
                break
        lengths.append(drv.Take_Line(text))
        drv.Send_Line(text)
    rig.advance(0.03)
    return lengths, line.received


def ring(rig: Rig) -> Any:
    drv = rig.firmware.ring
    drv.Init()
    put = [drv.Put(10 + i) for i in range(9)]
    got = [drv.Get() for _ in range(8)]
    # Round the end of the buffer.
    again = [(drv.Put(i), drv.Get()) for i in range(20)]
    return put, got, again[-1]


def crc16(rig: Rig) -> Any:
    drv = rig.firmware.crc16
    drv.Init_Crc()
    return drv.Crc(rig.firmware.array("uint16", list(b"123456789")), 9)


def low_pass(rig: Rig) -> Any:
    drv = rig.firmware.low_pass
    drv.Reset_Filter(0)
    out = 0
    for _ in range(60):
        out = drv.Filter(20000)
    return abs(out - 20000) <= 2, drv.Filter(-32768) < 20000, drv.Scale(-32768, 20), drv.Scale(256, 4)


def bumper(rig: Rig) -> Any:
    drv = rig.firmware.bumper
    drv.Init_Contact()
    states = []
    for pressed in (False, True, False):
        rig.outside.bumper(pressed)
        for _ in range(6):
            rig.advance(0.005)
            drv.Step()
        states.append(drv.State)
    return states, drv.Presses


def stopwatch(rig: Rig) -> Any:
    drv = rig.firmware.stopwatch
    drv.Init_Stopwatch()
    start = drv.Now()
    first = drv.Per_Second(start, 10)
    rig.advance(0.001)
    return first, 1000 <= drv.Elapsed_us(start) <= 1010, 9800 <= drv.Per_Second(start, 10) <= 10000


def pipeline(rig: Rig) -> Any:
    drv = rig.firmware.pipeline
    rig.kernel.start(drv.main)
    rig.advance(0.1)
    return drv.Taken, drv.Total


def sorted_window(rig: Rig) -> Any:
    drv = rig.firmware.sorted_window
    for distance in (30.0, 31.0, 255.0, 29.0, 30.5):
        drv.Add(distance)
    return drv.Median()


def key_timer(rig: Rig) -> Any:
    drv = rig.firmware.key_timer
    drv.Key_Init()
    for at, pressed in ((0.010, True), (0.0115, False), (0.013, True), (0.03, False), (0.032, True), (0.033, False)):
        rig.later(at, partial(rig.outside.bumper, pressed))
    drv.Key_Wait()
    for _ in range(600):
        rig.advance(0.0001)
        drv.Key_Poll()
    return drv.Presses, 12 <= drv.Pressed_ms <= 16


def task_queue(rig: Rig) -> Any:
    drv = rig.firmware.task_queue
    rig.kernel.start(drv.main)
    rig.advance(0.3)
    n = drv.Totals.count
    return n, drv.Totals.sum, drv.Totals.largest, 0 < drv.Report.count <= n


def line_parser(rig: Rig) -> Any:
    drv = rig.firmware.line_parser
    line = rig.uart(84, 85, 9600)
    drv.Serial_Init()
    rig.advance(0.002)
    line.send(b"SET 1 -250\rSET 3 77\rSET 9 1\rQUERY that is too long for the line\r")
    handled = 0
    for _ in range(100):
        rig.advance(0.001)
        drv.Serial_Poll()
        handled += drv.Serial_Handle()
    return handled, list(drv.Values), line.received


def text_numbers(rig: Rig) -> Any:
    drv, array = rig.firmware.text_numbers, rig.firmware.array
    room, value = array("char", [None] * 12), rig.firmware.new("int16", 0)
    lengths = [drv.Decimal(number, room) for number in (0, -1, 32767, -32768)]
    drv.Hexadecimal(0xBEEF, room)
    parsed = []
    for text in ("-32767", "12a", "99999", ""):
        parsed.append((drv.Parse(array("char", [*map(ord, text), 0]), value), value.load()))
    fields = drv.Split(array("char", [*map(ord, "1.5,2,,4,5"), 0]), ord(","))
    return lengths, parsed, [drv.Field_Number(i, fields) for i in (0, 1, 9)], drv.Make_Report(-123, 32767)


def door(rig: Rig) -> Any:
    drv = rig.firmware.door
    event = drv.EVENT
    done = [drv.Dispatch(e) for e in (event.TICK, event.BUTTON, event.TICK, event.END, event.TICK, event.TICK)]
    for _ in range(3):
        for e in (event.TICK, event.END, event.BUTTON, event.END, event.TICK, event.TICK):
            drv.Dispatch(e)
    return done, drv.Name_Length(), drv.Logged, drv.Last_Change()


#: Driver -> its exercise and what it gives.
EXERCISES: dict[str, tuple[Callable[[Rig], Any], Any]] = {
    # The mean 1003.5 truncated; 8 * 4095 / 8; 4095 * 3000 / 4096 = 2999.27
    "adc_average": (adc_average, (1003, 4095, 2999)),
    # 0.5 V of 3.0 V: 4096 / 6 = 682.7
    "adc_sequence": (adc_sequence, (682, 682, 2)),
    # Two samples in order, behind the one that waits; 28571 * 8.75 = 249996.25 mdps
    "gyro_fifo": (gyro_fifo, (1, [-2, 300], 249996)),
    # A unit period is 10 ms, and 60 ms pass after the start
    "wheel_speed": (wheel_speed, (6, True, True)),
    # Limited to 0..0.9; 5000 TBCLK of 10 ns
    "motor_pwm": (motor_pwm, ([0.9, 0.0, 0.5], 50e-6)),
    "echo_poll": (echo_poll, (b"abc", 0)),
    # The line of 30 characters is cut to 23
    "line_fifo": (line_fifo, ([5, 23], b"helloa line that is rather t")),
    # Seven fit into eight places; an empty ring gives -1
    "ring": (ring, ([1, 1, 1, 1, 1, 1, 1, 0, 0], [10, 11, 12, 13, 14, 15, 16, -1], (1, 19))),
    # The check value of CRC-16/CCITT-FALSE
    "crc16": (crc16, 0x29B1),
    # -32768 >> 15 is -1; 256 >> 4
    "low_pass": (low_pass, (True, True, -1, 16)),
    "bumper": (bumper, ([0, 2, 0], 1)),
    "stopwatch": (stopwatch, (0, True, True)),
    # Every 5 ms from the fifth on, up to 100 ms: 19 or 20; n(n+1)/4
    "pipeline": (pipeline, (19, 95.0)),
    # Bounces of 1.5 ms and less do not count; 13 ms to 30 ms, less 4 ms to believe
    "key_timer": (key_timer, (1, True)),
    # Every 3 ms up to 300 ms, less the one that falls on the end; 1000 n(n+1)/2
    "task_queue": (task_queue, (99, 4950000, 99000, True)),
    # Two lines are right; slot 9 does not exist
    "line_parser": (line_parser, (2, [0, -250, 0, 77], b"OK\rOK\rERR\rERR\r")),
    # A value that does not parse stays as it was; "#ODO -123,32767\r" has 16 characters
    "text_numbers": (
        text_numbers,
        ([1, 2, 5, 6], [(0, -32767), (-3, -32767), (-2, -32767), (-1, -32767)], [1.5, 2.0, 0.0], 16),
    ),
    # TICK is refused while shut and opening; each round shuts, and opens at its first of three ticks: 4 + 1, 8, 11
    "door": (door, ([0, 1, 0, 1, 0, 0], 4, 14, 11)),
    # 29, 30, 30.5, 31, 255
    "sorted_window": (sorted_window, 30.5),
}
