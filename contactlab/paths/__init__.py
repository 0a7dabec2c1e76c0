"""Laws along given paths."""
