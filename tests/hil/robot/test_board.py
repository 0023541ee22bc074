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


def test_what_is_put_to_a_face_is_read_there() -> None:
    board = RobotBoard()
    faces = {(part.name, face.name) for part in board.parts.values() for face in part.faces}
    told = {(name, face): board.part(name).value(face) for name, face in faces}
    # Nobody has said yet what turns the robot, or where walls are; it has 25 degrees, and no hand at its bumper.
    assert {each: value for each, value in told.items() if value is not None} == {
        ("gyro", "temperature_c"): 25.0, ("bumper", "pressed"): 0.0,
    }  # fmt: skip
    for name, face in faces:
        board.part(name).put(face, 1.0)
        assert board.part(name).value(face) == 1.0


def test_what_a_world_does_is_not_asked_for() -> None:
    board = RobotBoard()
    board.part("gyro").put("yaw_rate_rad_s", 0.5)
    asked: list[int] = []

    def turning(cycles: int) -> tuple[float, float, float]:
        asked.append(cycles)
        return 0.0, 0.0, 1.0

    board.gyro.set_rate_source(turning)
    assert board.part("gyro").value("yaw_rate_rad_s") is None
    assert not asked
