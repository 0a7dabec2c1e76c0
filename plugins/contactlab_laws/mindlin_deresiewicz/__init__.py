"""Mindlin and Deresiewicz's partial slip with its whole history: a stack of components."""
