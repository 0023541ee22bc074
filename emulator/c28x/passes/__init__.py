"""Passes over a function's tree before code is generated; each leaves its results on the nodes."""
