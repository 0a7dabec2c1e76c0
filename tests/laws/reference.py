"""Reference values: psi2 of the continuum limit, theory §5, by two methods that agree."""

PSI1 = (0.1, 0.5, 1.0, 1.2, 2.0, 3.0, 4.0)

#: psi2 at PSI1 for each chi.
PSI2 = {
    1.4411764706: (
        0.0205907061, 0.0478310787, -0.0596967039, -0.1805194095,
        -0.8372100068, -1.3796832924, -1.4365122247,
    ),
    1.0: (
        -0.0410991914, -0.2650325763, -0.6328520783, -0.81386742611,
        -1.2952883031, -1.0, 0.0,
    ),
    3.0: (
        -0.0474078686, -0.1287928816, 0.0633660877, 0.2353785026,
        0.8494911084, 1.1585220552, 0.6554364732,
    ),
}  # fmt: skip

#: (chi, psi1, psi2) one by one.
TABLE = [
    (chi, psi1, psi2)
    for chi, column in PSI2.items()
    for psi1, psi2 in zip(PSI1, column, strict=True)
]
