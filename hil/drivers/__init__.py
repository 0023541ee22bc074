"""Somebody's own driver files checked: what their text shows, what calls of their functions show, what their tasks do."""
