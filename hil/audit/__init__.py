"""The audit: it demonstrates every entry of the catalogue, with the evidence of a detector or a measurement."""
