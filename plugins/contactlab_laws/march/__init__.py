"""Integrators with even steps: the paper's scheme, a symplectic one, and error control of it."""
