"""Mindlin and Deresiewicz's partial slip, increment by increment, with turning points."""
