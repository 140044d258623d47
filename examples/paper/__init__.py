"""The experiments of D. S.-M. Liu and C.-W. Hsu, "Ray-Tracing Based Interactive Camera Simulation" (MVA 2013), again.

Each module has one experiment; page.py puts them on a page, with the paper's numbers beside those measured here.
"""

from .experiment import Experiment, Figure, Row
from .page import EXPERIMENTS, save_page

__all__ = ["EXPERIMENTS", "Experiment", "Figure", "Row", "save_page"]
