"""Partial slip by a bundle of springs, the continuum limit of the paper's annuli."""
