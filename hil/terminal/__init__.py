"""A console for the robot in a terminal: orders by key, frames, a small arena, findings of an emulated robot."""
