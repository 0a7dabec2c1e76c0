"""Animations of few frames, for tests of what stands around them."""


def shorten(monkeypatch):
    """Let animations have eight frames, and take their palette from two."""
    from contactlab.figures import animation, body_animation

    for module in (animation, body_animation):
        for name, count in (("ARRIVING", 2), ("IN_CONTACT", 4), ("LEAVING", 2)):
            monkeypatch.setattr(module, name, count)
    monkeypatch.setattr(animation, "SAMPLES", (0.0, 1.0))
