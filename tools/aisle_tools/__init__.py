"""Console tools of the Aisle motion planner."""

__version__ = "0.1.0"
