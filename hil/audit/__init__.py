"""The audit: every entry of the catalogue demonstrated, each with the evidence of a detector or a measurement."""
