"""Scenarios: situations that can be repeated, as TOML files (README.md of this package)."""
