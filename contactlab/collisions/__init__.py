"""Collisions of bodies in space, rebounds from a table, velocities after them."""
