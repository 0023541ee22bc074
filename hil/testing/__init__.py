"""Tests of firmware with pytest: the plugin `c2000_hil`, its fixtures, triggers, strategies and machines.

README.md is the page for users; every paragraph of it is run by a test.
"""
