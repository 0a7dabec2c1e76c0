"""Simulations: runs, and sweeps here or by workers, into memory or folders."""
