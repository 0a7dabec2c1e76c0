"""What a notebook shows of results and plans: their words."""

import html
import re

import numpy as np

from contactlab import Scene, Simulation


def words_of(thing):
    """Return the text of a notebook's view, which is one preformatted block."""
    (shown,) = re.fullmatch(r"<pre>([^<>]*)</pre>", thing._repr_html_(), flags=re.DOTALL).groups()
    return html.unescape(shown)


def test_a_notebook_shows_the_words_of_results_and_plans():
    result = Simulation().run(Scene.nondimensional(psi1=np.array([0.5, 2.0]), chi=49 / 34))
    for thing in (result, result[0], result.plan):
        assert words_of(thing) == str(thing)
