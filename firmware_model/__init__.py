"""The firmware of the robot, one module a C file, in C-shaped Python that is translated before it runs."""
