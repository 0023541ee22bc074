"""Somebody's own driver files, checked: what their text, calls of their functions, and their tasks show."""
