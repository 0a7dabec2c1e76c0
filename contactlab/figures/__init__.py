"""Figures: one function each, which takes data and Axes and returns the Axes.

Nothing here chooses a backend or opens a window; that is the caller's business.
"""
