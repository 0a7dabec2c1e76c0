"""Thornton and Yin's partial slip, increment by increment, with two turning points."""
