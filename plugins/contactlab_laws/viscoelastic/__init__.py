"""One loss for pressure and shear: Kelvin–Voigt contact with one relaxation time (theory §15)."""
