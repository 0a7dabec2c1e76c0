"""How far psi2 differs between friction laws, and between normal laws of the same restitution."""
