"""The bench: world, robot, serial port, command line."""

import emulator as emulator  # first: it decides whether modules of the world come compiled, too
