"""The integrator of laws that know their path from event to event, in scaled units."""
