"""The real-time workbench: it computes response times, and measures them on the emulated kernel."""
