"""Materials, bodies, scenes and encounters, and the closed forms of the paper."""
