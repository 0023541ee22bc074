"""Traces: a run is recorded in one trace file, which can be converted to files for other tools."""
