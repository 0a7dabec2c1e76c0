"""The table of the rebound with a restitution, by rings, and the cautions of other laws."""
