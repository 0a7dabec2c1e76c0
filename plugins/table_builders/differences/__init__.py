"""The sizes in cautions: of separately limited springs, and of the choice of a normal law."""
