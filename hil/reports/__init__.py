"""Reports: findings of a run, weighed and shown.

model.py     one `Report`: findings with rule, severity, fingerprint, what they reach, and what ran
policy.py    severities, baseline and threshold of a project (`pyproject.toml`)
baseline.py  fingerprints, and the file of known findings
terminal.py  json_report.py  sarif.py  junit.py  html.py      one writer each
two_fill.py  the same scenario under two fills: what never-written memory reaches
"""
