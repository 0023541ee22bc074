"""The robot of the thesis: its schematic, and how it is mounted in the world.  See README.md."""
