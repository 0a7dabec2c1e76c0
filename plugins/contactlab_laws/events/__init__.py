"""Paths from event to event, in scaled units, of laws that know theirs."""
