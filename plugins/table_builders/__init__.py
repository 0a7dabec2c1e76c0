"""Builders of the tables of ``contactlab_laws.tables``: in the repository, not in the package."""
