"""Shared parts of the laws of independent springs along the contact radius; no law is registered.

By the theorem of Ciavarella and Jaeger the axisymmetric contact with friction is a function
w(s) of one coordinate, 0 <= s < b, whose values do not depend on each other, like the deflections
of independent springs: w grows with the slip displacement while abs(w) is below the limit l(s), and
is otherwise held at +-l(s); it begins from zero where the contact grows; the force is 2 G* times
its integral. ``Bundle`` has the positions of the springs and the rule of integration.

Scaled by the largest contact, as everywhere in this package: s, b by a; w and displacement by
mu a²/(kappa R), so that l = p (b² - s²) with p the pressure over Hertz's at the same radius;
force by mu P_max, so that F = 1.5 times the integral of w.

References
----------
Jaeger, Arch. Appl. Mech. 65 (1995) 478-487; Ciavarella, J. Appl. Mech. 65 (1998) 998-1003;
Popov & Hess, Method of Dimensionality Reduction in Contact Mechanics and Friction (2015), ch. 5.
"""
