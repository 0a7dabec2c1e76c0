"""Differences of psi2 between friction laws, and between normal laws of the same restitution."""
