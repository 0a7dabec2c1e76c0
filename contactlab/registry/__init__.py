"""Laws: found by name, fitted together, made from options."""
