"""What comes back: motion, plan, energy books, results and the forms that they are read in."""
