"""What a run did, in one trace file, and as files for other tools."""
