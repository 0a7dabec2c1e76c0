"""Many impacts at once: the phases and fronts of this package, for arrays of unlike impacts.

Every impact goes from event to event by steps of its own, as alone; what is shared is the call.
In each round the impacts are sorted by what they do next (stick; slip through a piece laid down,
or locked; slip all through), and each sort takes one collocation panel together.
"""
