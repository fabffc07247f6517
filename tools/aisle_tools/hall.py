"""A hall as text, for the host programs of the build that run single modules of the core (tools/hall/hall.h)."""

from __future__ import annotations

from aisle_tools.scenario import Scenario


def text(scenario: Scenario, margin: float, leg: int = 0) -> str:
    """The way from stop `leg` of the scenario to the next one; margin in m, 0 or less: none."""
    stops = [scenario.start, *scenario.goals]
    footprint = scenario.footprint or []
    polygons = scenario.world.obstacles()
    rows = [
        scenario.world.bounds,
        (0.0 if footprint else scenario.radius, margin if margin > 0.0 else -1.0),
        (len(footprint), *(v for vertex in footprint for v in vertex)),
        stops[leg][:2],
        stops[leg + 1][:2],
        (len(polygons),),
    ]
    rows += [(len(p.vertices), *p.vertices.ravel()) for p in polygons]
    return "\n".join(" ".join(f"{float(v):.17g}" for v in row) for row in rows)
