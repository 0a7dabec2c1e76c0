"""The table of the size of elastic coupling between unlike bodies."""
