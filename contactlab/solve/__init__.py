"""Impacts solved: the decoupled and the coupled way, plans, errors."""
