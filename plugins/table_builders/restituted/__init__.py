"""The table of the rebound with a restitution, by springs that lose as the normal contact does."""
