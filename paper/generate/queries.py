"""What figures, tables and numbers ask of a run in common: selections, fits, interpolations."""

from __future__ import annotations

import numpy as np

from .run_folder import NotMeasured, RunFolder, Table

FAST_SOLVERS = ("treecode", "fmm")
HEADLINE_TOLERANCES = (1e-3, 1e-6, 1e-9)
HEADLINE_CHARGES = 1e5
LEAST_TOLERANCE = 1e-10  # below it round-off of the forces that cancel is larger than the tolerance


def first_present(table: Table, column: str, preferred: tuple[str, ...]) -> str:
    """The first of the preferred values that the column has, else its most frequent one."""
    present = table[column].tolist()
    for value in preferred:
        if value in present:
            return value
    return max(sorted(set(present)), key=present.count)


def fewest_threads(table: Table) -> Table:
    """The rows of the runs with the fewest threads."""
    return table.where(threads=min(table.values_of("threads"))) if table.values_of("threads") else table


def solver_survey(run: RunFolder) -> Table:
    """Force calls on a jet with the global norm, one thread: what error and run time are compared on."""
    table = run["coulomb"].measured("seconds_s")
    table = fewest_threads(table.where(geometry=first_present(table, "geometry", ("jet", "real", "helix"))))
    table = table.keep(table["norm"] != "per-bead")
    table = table.required("a jet with the global norm")
    distribution = first_present(table, "distribution", ("modulated", "uniform"))
    return table.where(distribution=distribution).sorted_by("charges")


def convergence_in_length(run: RunFolder, near_field: str) -> Table:
    """The PVP jet on redistributed meshes, finest first, everything else as in the base case."""
    table = run["mesh"].where(jet="pvp", near_field=near_field, mesh="redistribute", solver="direct", interval_s=1e-3)
    table = table.where(rtol=1e-5).positive("length_m", "path_length_m")
    return table.required(f"the PVP jet, {near_field}").sorted_by("length_m")


def convergence_at_nozzle(run: RunFolder) -> Table:
    """The pumped jet, shortest links at the nozzle first."""
    table = run["mesh"].where(jet="pumped").positive("link_length_m", "path_length_m")
    return table.required("the pumped jet").sorted_by("link_length_m")


def nearest(values: list[float], wanted: float) -> float:
    """The value nearest to the wanted one on a logarithmic scale."""
    if not values:
        raise NotMeasured("no values to choose from")
    return min(values, key=lambda value: abs(np.log(value / wanted)))


def shown_tolerances(table: Table) -> list[float]:
    """The headline tolerances, or those nearest to them that were measured."""
    measured = table.values_of("tolerance")
    return sorted({nearest(measured, wanted) for wanted in HEADLINE_TOLERANCES} if measured else set(), reverse=True)


def fast_cases(run: RunFolder) -> Table:
    """All force calls in which a fast solver was asked for a tolerance above round-off."""
    table = run["coulomb"].measured("error_over_tolerance", "tolerance")
    table = table.keep(np.isin(table["solver"], FAST_SOLVERS) & (table["tolerance"] >= LEAST_TOLERANCE * (1 - 1e-9)))
    return table.required("a fast solver")


def scaling_curve(table: Table, solver: str, tolerance: float | None, y: str, x: str = "charges") -> Table:
    """The rows of one solver at one tolerance, sorted by size; the direct sum has no tolerance."""
    rows = table.where(solver=solver).positive(x, y)
    if tolerance is not None and solver != "direct":
        rows = rows.where(tolerance=tolerance)
    return rows.sorted_by(x)


def exponent(x: np.ndarray, y: np.ndarray, least_x: float = 0) -> float:
    """The least-squares slope of log y over log x, from least_x on."""
    far = x >= least_x * (1 - 1e-9)
    if len(set(x[far])) < 2:
        raise NotMeasured("fewer than two sizes to fit an exponent to")
    return float(np.polyfit(np.log(x[far]), np.log(y[far]), 1)[0])


def crossover(x: np.ndarray, first: np.ndarray, second: np.ndarray) -> float:
    """Where the second curve falls below the first for good, interpolated in logarithms."""
    gap = np.log(second / first)
    above = np.nonzero(gap > 0)[0]
    if len(above) == 0 or above[-1] == len(x) - 1:
        raise NotMeasured("the curves do not cross")
    i = above[-1]
    share = gap[i] / (gap[i] - gap[i + 1])
    return float(np.exp(np.log(x[i]) + share * np.log(x[i + 1] / x[i])))


def value_at(x: np.ndarray, y: np.ndarray, wanted: float) -> float:
    """y where x is nearest to the wanted value."""
    if len(x) == 0:
        raise NotMeasured("no rows")
    return float(y[np.argmin(np.abs(x - wanted))])


def cost_of_error(errors: np.ndarray, costs: np.ndarray, wanted: float) -> float:
    """The least cost at which an error is kept, interpolated in logarithms on a work-precision curve."""
    order = np.argsort(costs)
    errors, costs = np.log(errors[order]), np.log(costs[order])
    reached = np.nonzero(errors <= np.log(wanted))[0]
    if len(reached) == 0:
        raise NotMeasured("the error is not reached")
    i = reached[0]
    if i == 0 or errors[i] == errors[i - 1]:
        return float(np.exp(costs[i]))
    share = (np.log(wanted) - errors[i - 1]) / (errors[i] - errors[i - 1])
    return float(np.exp(costs[i - 1] + share * (costs[i] - costs[i - 1])))


def extrapolated_cost(errors: np.ndarray, costs: np.ndarray, wanted: float) -> float:
    """The cost of an error beyond the end of a work-precision curve, along its slope."""
    if len(set(costs)) < 2:
        raise NotMeasured("fewer than two costs to extrapolate from")
    slope, start = np.polyfit(np.log(errors), np.log(costs), 1)
    return float(np.exp(start + slope * np.log(wanted)))


def last_times(table: Table) -> Table:
    """The rows of the last time at which something was compared, scene by scene."""
    mask = np.zeros(len(table), dtype=bool)
    for scene in set(table["scene"]):
        of_scene = table["scene"] == scene
        mask |= of_scene & (table["time_s"] == table["time_s"][of_scene].max())
    return table.keep(mask)


def strictest_rtol(table: Table) -> Table:
    """The rows with the smallest rtol: what remains is the error of the solver."""
    rtols = table.values_of("rtol")
    return table.where(rtol=min(rtols)) if rtols else table


def base_case(table: Table) -> Table:
    """The stability runs of the commonest link length, charge and field: one plane over modulus and viscosity."""
    for column in ("link_length_m", "charge_factor", "field_v_per_m"):
        cells = table[column][np.isfinite(table[column])].tolist()
        if cells:
            table = table.where(**{column: max(sorted(set(cells)), key=cells.count)}) if len(set(cells)) > 1 else table
    return table.required("the commonest link length, charge and field")


def refused(table: Table) -> np.ndarray:
    """Which stability runs were refused or stopped; those that took too many evaluations were not."""
    return np.array([bool(reason) and not reason.startswith("more than") for reason in table["refusal"]], dtype=bool)
