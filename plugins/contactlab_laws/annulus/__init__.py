"""Partial slip by concentric annuli, the paper's eqs (1), (13)-(18), (22)."""
