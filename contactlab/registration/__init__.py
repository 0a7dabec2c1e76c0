"""Plug-ins of every kind: names, hooks, what is installed, and the one manager of the process."""
