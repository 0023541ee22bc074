"""The robot's schematic."""
