"""The robot's parts: specimens by seed, power before the CPU, what a schematic tells of them."""

from __future__ import annotations

from hil.robot.board import RobotBoard


def test_boards_of_one_seed_are_alike() -> None:
    first, second = RobotBoard(seed=5, ideal=False), RobotBoard(seed=5, ideal=False)
    assert first.left_motor.params == second.left_motor.params
    assert RobotBoard(seed=6, ideal=False).left_motor.params != first.left_motor.params


def test_sonars_switched_on_with_the_cpu_are_not_ready_for_the_start_pulse_at_10_ms() -> None:
    for powered_up, expected in ((True, True), (False, False)):
        board = RobotBoard(sonars_powered_up=powered_up)
        board.clock.advance_to(2_000_000)
        start = board.pins[69]
        start.drive("cpu", 1)
        board.clock.advance_to(board.clock.now + 5_000)
        start.drive("cpu", 0)
        board.clock.advance_to(board.clock.now + 2_000)
        start.drive("cpu", None)
        board.clock.advance_to(200_000_000)
        assert (board.sonars.sensors["LEFT"].readings > 0) is expected


def test_the_board_tells_its_parts_with_the_pins_that_they_have() -> None:
    board = RobotBoard()
    pins = [pin for part in board.parts.values() for pin in part.pins.values()]
    assert set(board.parts) == {"gyro", "sonars", "left motor", "right motor", "bumper", "link"}
    assert len(pins) == len(set(pins)), "two parts at one pin"
    board.part("gyro").put("yaw_rate_rad_s", -1.5)
    board.part("sonars").put("FRONT_range_m", 0.4)
    assert board.gyro.rate_source(0) == (0.0, 0.0, -1.5)
    seen = {name: sensor.range_source(name, 0) for name, sensor in board.sonars.sensors.items()}
    assert seen["FRONT"] is not None
    assert (seen["LEFT"], seen["FRONT"].range_m, seen["RIGHT"]) == (None, 0.4, None)
    # A level on the bumper's pin is what the part named for it makes.
    pin = board.pins[int(board.part("bumper").pins["S"].removeprefix("GPIO"))]
    before = pin.level
    board.part("bumper").put("pressed", 1)
    assert (before, pin.level) == (1, 0)
