"""psi2 with Coulomb's law at every point, by rings of an axisymmetric contact."""
