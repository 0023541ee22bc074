"""The port and somebody's C of the same functions: their trees, calls of what differs, and their runs, compared."""
