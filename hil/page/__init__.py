"""A run as one page that plays it again, for any browser, from a file.  Map: README.md."""
