"""The bench: world, robot, serial port, command line."""
