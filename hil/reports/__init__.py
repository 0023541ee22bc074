"""Reports: findings of a run, weighed and shown.  README.md is the map."""
