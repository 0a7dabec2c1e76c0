"""Laws found, fitted together and run."""
