"""The documentation as a site: `hil docs --site DIR`.

Sphinx lays out what the project has: the pages of `hil docs`, where they stand, with their links; the rules, the
catalogue and the commands as data says them; docstrings; the schemas of files.  Nothing is fetched while it is built or
read.  A warning is an error.
"""
