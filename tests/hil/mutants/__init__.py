"""Firmware that somebody has broken: each mutant is told its faults, and nothing else comes out."""
