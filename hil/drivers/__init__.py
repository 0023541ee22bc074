"""Checks a user's own driver files: their source, calls of their functions, and runs of their program or tasks."""
