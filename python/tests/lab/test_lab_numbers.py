"""Each number of the lab beside its exact value.

Seeds are fixed, so that a run gives what it gave before. A right number that is measured anew (another seed, another
compiler) fails with a probability of 4e-8: below 1e-5 for all of them together, which a test adds up.
"""

from __future__ import annotations

import functools
import math
import os

import pytest

import montelux
from montelux.lab import Figure, Number, Outcome, all_figures

FIGURES = all_figures()
SLOW = os.environ.get("MONTELUX_SLOW") == "1"
_slow = pytest.mark.skipif(not SLOW, reason="slow: MONTELUX_SLOW=1 runs it")


@functools.cache
def computed(figure: Figure) -> Outcome:
    return figure.compute()


@pytest.mark.parametrize("figure", [pytest.param(f, marks=_slow if f.slow else (), id=f.key) for f in FIGURES])
def test_numbers_agree_with_the_exact_ones(figure: Figure) -> None:
    outcome = computed(figure)
    assert outcome.numbers, "a figure without a number proves nothing"
    for n in outcome.numbers:
        assert math.isfinite(n.measured) and math.isfinite(n.error), n.name
        assert n.agrees, f"{n.name}: {n.measured_text}, expected {n.exact_text} ({n.distance:.1f} errors apart)"
    names = [n.name for n in outcome.numbers]
    assert len(set(names)) == len(names), "two numbers of one name"


def test_there_are_statistical_numbers_and_their_errors_are_right() -> None:
    """Errors too large would let everything agree: distances over all figures spread as they should."""
    distances = []
    for figure in FIGURES:
        if figure.row in ("A2", "A4", "A7", "B2", "B3", "B4", "B5", "B7", "B8"):
            numbers = [n for n in computed(figure).numbers if not n.bound and math.isinf(n.degrees_of_freedom)]
            distances += [n.distance for n in numbers]
    assert len(distances) > 40
    mean_square = sum(d * d for d in distances) / len(distances)
    # Chi-squared; numbers that share their samples count as fewer: P below 1e-6 for 20 independent ones.
    assert 0.15 < mean_square < 3.5


@pytest.mark.parametrize(
    "wrong",
    [Number("n", 1.06, 0.01, 1.0), Number("n", 1.06, 0.05, 1.0, bound=True), Number("n", math.nan, 1.0, 1.0)],
)
def test_a_wrong_number_is_seen(wrong: Number) -> None:
    assert not wrong.agrees


def test_errors_from_few_replicates_have_wider_limits() -> None:
    assert Number("n", 1.06, 0.01, 1.0, degrees_of_freedom=7).agrees
    assert Number("n", 1.06, 0.01, 1.0, degrees_of_freedom=7).limit == pytest.approx(25.35, abs=0.01)
    assert Number("n", 0, 1, 0).limit == 5.5


def test_all_numbers_together_fail_seldom_when_they_are_right() -> None:
    chance = [n for figure in FIGURES if SLOW or not figure.slow for n in computed(figure).numbers if not n.bound]
    law = montelux.Distribution.normal()
    each = [
        2 * (montelux.Distribution.student_t(n.degrees_of_freedom) if n.degrees_of_freedom < 1e9 else law).cdf(-n.limit)
        for n in chance
    ]
    assert len(each) > 80 and sum(each) < 1e-5
