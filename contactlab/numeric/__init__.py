"""Numbers: checked, in batches, at nodes."""
