"""The three-dimensional elastic half-space on rings and angles."""
