"""Checked numbers, vectors, batches, and formulas of numerical analysis."""
