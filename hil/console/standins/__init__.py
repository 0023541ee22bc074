"""Modules that a Windows console imports, for other systems.  Loaded by `hil.console.runner`, for the app alone."""
