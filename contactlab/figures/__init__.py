"""Figures: each function takes Axes and data, and returns the Axes.

The functions choose no backend and open no window; the caller does.
"""
