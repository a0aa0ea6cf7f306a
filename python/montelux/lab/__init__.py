"""The lab: every figure by which Monte Carlo integration is taught, drawn from the library itself.

`python -m montelux.lab --out DIR` writes a report that a browser shows without a network. Each figure is made by a
function that samples and integrates by `montelux` (the report shows its source), and gives numbers with their
errors beside the exact ones. docs/lab.md is the guide.
"""

from __future__ import annotations

from ._figure import Figure, Outcome, Picture
from ._number import Number, concise
from .figures import all_figures, chosen_figures

__all__ = ["Figure", "Number", "Outcome", "Picture", "all_figures", "chosen_figures", "concise"]
