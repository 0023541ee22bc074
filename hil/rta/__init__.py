"""The real-time workbench: response times computed, and seen on the emulated kernel."""
