"""Results: motion, plan, energy books, and their columns, files and tables."""
