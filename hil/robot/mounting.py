"""Connects the robot's board with the world: its sensors measure the world, and its wheels move the robot there."""

from __future__ import annotations

from hil.robot.board import RobotBoard
from hil.robot.options.in_world import AccelerometerMotion, LidarView, sonar_mounts
from hil.world.maps import WorldMap
from hil.world.world import World


def mounted(board: RobotBoard, world_map: WorldMap, seed: int | None) -> World:
    """The world of a map with this robot in it; `seed` None is the ideal robot (see `World`)."""
    world = World(world_map, board.left_motor, board.right_motor, mounts=sonar_mounts(board.options), seed=seed)
    world.attach(board.clock)
    world.bumper_changed.connect(board.bumper.press)
    if world.bumper_pressed:
        board.bumper.press(True)
    board.gyro.set_rate_source(world.rate_source)
    board.sonars.set_range_source(world.range_source)
    if seed is not None:
        board.sonars.air.set_cross_source(world.cross_source)
    if board.accelerometer is not None:
        board.accelerometer.set_motion_source(AccelerometerMotion(world))
    if board.lidar is not None:
        board.lidar.set_distance_source(LidarView(world))
    return world
