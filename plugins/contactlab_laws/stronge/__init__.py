"""Stronge's lumped compliance: a contact of two springs, in closed form."""
