"""Every number in the text of the article, by key: \\val{key} in ehdjet.tex is what stands here.

A key is a path of words. A value that the run has not measured is shown as such.
"""

from __future__ import annotations

import numpy as np

from . import queries, tex
from .run_folder import NotMeasured, RunFolder, Table

VALUES = {}  # key: function of the run that returns LaTeX


def value(key: str):
    """Registers a function as the source of a number."""
    def register(function):
        VALUES[key] = function
        return function
    return register


def evaluate(run: RunFolder) -> tuple[dict[str, str], dict[str, str]]:
    """All values, and why some of them are missing."""
    values, missing = {}, {}
    for key, function in VALUES.items():
        try:
            values[key] = function(run)
        except NotMeasured as error:
            values[key] = tex.NOT_MEASURED
            missing[key] = str(error)
    return values, missing


def largest(cells: np.ndarray) -> float:
    """The largest magnitude among what was measured."""
    cells = np.abs(cells[np.isfinite(cells)])
    if not len(cells):
        raise NotMeasured("no values")
    return float(cells.max())


# ---- the run

@value("run/folder")
def _(run):
    return tex.text("/".join(run.path.resolve().parts[-2:]))


def comment(key: str, *names: str) -> None:
    """Registers what the comment lines say about one of these names."""
    @value(f"run/{key}")
    def _(run):
        for name in names:
            if answers := run.comments(name):
                return tex.text(", ".join(answers))
        raise NotMeasured(f"no comment line '{names[0]}'")


comment("version", "ehdjet version", "version", "ehdjet")
comment("commit", "commit")


@value("run/date")
def _(run):
    """The day, or the first and the last day of a longer run."""
    days = sorted({date[:10] for date in run.comments("date")})
    if not days:
        raise NotMeasured("no comment line 'date'")
    return days[0] if len(days) == 1 else f"{days[0]} to {days[-1]}"


comment("processor", "processor")
comment("simd", "simd")
comment("threads", "threads")


# ---- Coulomb solvers

# The text speaks of three tolerances and two sizes; which they are depends on what the run has.
TOLERANCES = ("loose", "middle", "strict")
SIZES = {"headline": queries.HEADLINE_CHARGES, "largest": 1e6}


def tolerance_of(run: RunFolder, rank: str) -> float:
    """One of the three tolerances that the text speaks of."""
    shown = queries.shown_tolerances(queries.solver_survey(run).where(solver="fmm"))
    if len(shown) < len(TOLERANCES):
        raise NotMeasured("coulomb.csv has fewer than three tolerances")
    return shown[TOLERANCES.index(rank)]


def size_of(run: RunFolder, size: str) -> float:
    """One of the two numbers of charges that the text speaks of."""
    return queries.nearest(queries.solver_survey(run).where(solver="fmm").values_of("charges"), SIZES[size])


def fast_row(run: RunFolder, size: str, rank: str) -> Table:
    """The one row of the fast multipole method at a size and a tolerance."""
    charges, tolerance = size_of(run, size), tolerance_of(run, rank)
    rows = queries.solver_survey(run).where(charges=charges, tolerance=tolerance, solver="fmm")
    return rows.required(f"fmm, {charges:g} charges at {tolerance:g}")


def register_coulomb(size: str, rank: str) -> None:
    """Time and error of the fast multipole method at one size and tolerance, and its gain on the direct sum."""
    @value(f"fmm/{size}/{rank}/time")
    def _(run):
        return tex.duration(fast_row(run, size, rank)["seconds_s"].min())

    @value(f"fmm/{size}/{rank}/error")
    def _(run):
        return tex.number(fast_row(run, size, rank)["error_l2"].min())

    @value(f"fmm/{size}/{rank}/gain")
    def _(run):
        direct = queries.solver_survey(run).where(charges=size_of(run, size), solver="direct")
        direct = direct.required("the direct sum")
        return tex.number(direct["seconds_s"].min() / fast_row(run, size, rank)["seconds_s"].min())


for _rank in TOLERANCES:
    for _size in SIZES:
        register_coulomb(_size, _rank)

    @value(f"tolerance/{_rank}")
    def _(run, rank=_rank):
        return tex.power(tolerance_of(run, rank))

for _size in SIZES:
    @value(f"charges/{_size}")
    def _(run, size=_size):
        return tex.power(size_of(run, size))


def least_of_fits(run: RunFolder) -> float:
    """From how many charges on exponents are fitted: 10^4, or 10^3 if a short run has too few sizes beyond."""
    sizes = np.array(queries.solver_survey(run).where(solver="direct").values_of("charges"))
    return 1e4 if (sizes >= 1e4).sum() > 1 else 1e3


@value("exponent/from")
def _(run):
    return tex.power(least_of_fits(run))


def register_solver_exponent(solver: str, rank: str) -> None:
    """The exponent of time over the number of charges."""
    @value(f"exponent/{solver}/{rank}" if rank else f"exponent/{solver}")
    def _(run):
        tolerance = tolerance_of(run, rank) if rank else None
        rows = queries.scaling_curve(queries.solver_survey(run), solver, tolerance, "seconds_s")
        return tex.number(queries.exponent(rows["charges"], rows["seconds_s"], least_of_fits(run)), 3)


register_solver_exponent("direct", "")
for _solver in queries.FAST_SOLVERS:
    for _rank in TOLERANCES:
        register_solver_exponent(_solver, _rank)


def register_crossover(rank: str) -> None:
    """The number of charges from which the fast multipole method beats the direct sum."""
    @value(f"crossover/{rank}")
    def _(run):
        table = queries.solver_survey(run)
        direct = queries.scaling_curve(table, "direct", None, "seconds_s")
        fast = queries.scaling_curve(table, "fmm", tolerance_of(run, rank), "seconds_s")
        common, i, j = np.intersect1d(direct["charges"], fast["charges"], return_indices=True)
        if not len(common):
            raise NotMeasured("no common sizes")
        return tex.number(queries.crossover(common, direct["seconds_s"][i], fast["seconds_s"][j]))


for _rank in TOLERANCES:
    register_crossover(_rank)


@value("coulomb/least-tolerance")
def _(_run):
    return tex.power(queries.LEAST_TOLERANCE)


@value("coulomb/cases")
def _(run):
    return tex.count(len(queries.fast_cases(run)))


@value("coulomb/worst")
def _(run):
    return tex.number(largest(queries.fast_cases(run)["error_over_tolerance"]))


@value("coulomb/kept")
def _(run):
    return tex.count(int((queries.fast_cases(run)["error_over_tolerance"] <= 1).sum()))


@value("coulomb/direct-error")
def _(run):
    return tex.number(largest(run["coulomb"].where(solver="direct")["error_per_bead"]))


def register_closed_form(case: str) -> None:
    """The worst deviation of the fast solvers from a closed form, over the tolerance, and the largest size."""
    @value(f"closed-form/{case}/error")
    def _(run):
        rows = run["coulomb_closed_forms"].where(case=case).positive("tolerance", "relative_error").required(case)
        return tex.number(largest(rows["relative_error"] / rows["tolerance"]))

    @value(f"closed-form/{case}/charges")
    def _(run):
        return tex.power(largest(run["coulomb_closed_forms"].where(case=case).required(case)["charges"]))


for _case in ("ring", "line", "helix"):
    register_closed_form(_case)


# ---- trajectories

def deviations(run: RunFolder, tolerance: str) -> Table:
    """The last times of all scenes with the fast multipole method at a tolerance, or the direct sum's own errors."""
    table = queries.last_times(run["trajectory"])
    if tolerance == "own":
        return table.where(solver="direct").required("the direct sum")
    return table.where(solver="fmm", tolerance=float(tolerance)).required(f"tolerance {tolerance}")


def register_trajectory(tolerance: str) -> None:
    """The worst deviation over all scenes at their last time, for one tolerance or for the integrator alone."""
    for key, column in (("path", "path_length_error"), ("tip", "tip_error"), ("deposit", "deposit_mass_error"),
                        ("growth", "growth_rate_error")):
        @value(f"trajectory/{tolerance}/{key}")
        def _(run, column=column):
            return tex.number(largest(deviations(run, tolerance)[column]))

    @value(f"trajectory/{tolerance}/position")
    def _(run):
        return tex.quantity(largest(deviations(run, tolerance).where(scene="case_one")["position_error_m"]), r"\metre")


for _tolerance in ("1e-2", "1e-4", "1e-6", "own"):
    register_trajectory(_tolerance)


@value("trajectory/rtol")
def _(run):
    return tex.power(deviations(run, "own")["rtol"].max())


@value("trajectory/time")
def _(run):
    return tex.quantity(1e3 * deviations(run, "own").where(scene="case_one").required("case I")["time_s"].max(),
                        r"\milli\second")


# ---- integrators

REFERENCE_ERROR = 1e-11  # metre, of the strict run that errors of positions are taken against
STEPS_OF_ORDER = 4


def register_order(method: str, events: str) -> None:
    """The order of a method in its fixed step, case I: the slope over the finest steps above the reference's error."""
    @value(f"order/{method}/{events}")
    def _(run):
        rows = run["integrators"].where(scene="case_one", method=method, events=events, control="step")
        rows = rows.keep(rows["position_error_m"] > REFERENCE_ERROR).sorted_by("value")
        finest = rows.keep(np.arange(len(rows)) < STEPS_OF_ORDER)
        return tex.number(queries.exponent(finest["value"], finest["position_error_m"]), 3)


for _method in ("euler", "heun", "rk4"):
    for _events in ("located", "step-end"):
        register_order(_method, _events)


def cost(run: RunFolder, error: float, **which) -> float:
    """Evaluations that keep an error of positions, interpolated on a work-precision curve."""
    rows = run["integrators"].where(**which).positive("evaluations", "position_error_m")
    return queries.cost_of_error(rows["position_error_m"], rows["evaluations"], error)


def register_cost(key: str, error: float, **which) -> None:
    """Evaluations for an error of positions of case I."""
    @value(f"cost/{key}")
    def _(run):
        return tex.number(cost(run, error, **which))


COST_ERROR = 1e-6  # metre: a two-hundredth of a link at the nozzle
register_cost("adaptive", COST_ERROR, scene="case_one", method="dormand-prince", events="located", control="rtol")
register_cost("rk4-located", COST_ERROR, scene="case_one", method="rk4", events="located", control="step")


@value("cost/rk4-step-end")
def _(run):
    """As far as such runs get at bearable cost, this is an extrapolation along the measured slope."""
    rows = run["integrators"].where(scene="case_one", method="rk4", events="step-end", control="step")
    rows = rows.positive("evaluations", "position_error_m")
    return tex.number(queries.extrapolated_cost(rows["position_error_m"], rows["evaluations"], COST_ERROR))



@value("cost/error")
def _(_run):
    return tex.quantity(1e6 * COST_ERROR, r"\micro\metre")


@value("landings/saved")
def _(run):
    """Evaluations with each landing located over evaluations with frequent landings in the right-hand side."""
    table = run["integrators"].where(scene="table2_04", events="located", control="rtol")
    pairs = [(a, b) for value in table.values_of("value")
             for a in table.where(value=value, landings="located")["evaluations"]
             for b in table.where(value=value, landings="auto")["evaluations"]]
    if not pairs:
        raise NotMeasured("integrators.csv has no pair of landings to compare")
    return tex.number(np.median([a / b for a, b in pairs]), 3)


@value("stability/theory")
def _(run):
    """How far measured limits of explicit methods are from theory, median of the ratio less one."""
    table = run["stability"].positive("largest_step_s", "theory_step_s").required("limits with theory")
    return tex.number(float(np.median(np.abs(table["largest_step_s"] / table["theory_step_s"] - 1))))


@value("stability/points")
def _(run):
    return tex.count(len(run["stability"]))


@value("stability/refused")
def _(run):
    return tex.count(int(queries.refused(run["stability"]).sum()))


def register_least_step(method: str) -> None:
    """The smallest of the largest stable steps of a method over modulus and viscosity."""
    @value(f"stability/{method}/least")
    def _(run):
        rows = queries.base_case(run["stability"]).where(method=method).positive("largest_step_s").required(method)
        return tex.quantity(rows["largest_step_s"].min(), r"\second")


for _method in ("rk4", "dormand-prince", "ros34pw2", "auto"):
    register_least_step(_method)


# ---- refinement

def register_remap(remap: str) -> None:
    """What a remap conserves, and how fast the path length converges with it."""
    @value(f"conservation/{remap}/error")
    def _(run):
        rows = run["refinement_conservation"].where(remap=remap).required(remap)
        return tex.number(max(largest(rows[c]) for c in ("mass_error", "charge_error", "volume_error")))

    @value(f"conservation/{remap}/refinements")
    def _(run):
        return tex.count(largest(run["refinement_conservation"].where(remap=remap).required(remap)["refinements"]))

    @value(f"convergence/{remap}/order")
    def _(run):
        rows = run["refinement_convergence"].where(remap=remap).positive("length_m", "path_length_error")
        return tex.number(queries.exponent(rows["length_m"], rows["path_length_error"]))


for _remap in ("conservative", "paper"):
    register_remap(_remap)


def finest_compared(run: RunFolder) -> Table:
    """The finest mesh that is compared with a finer one."""
    table = run["refinement_convergence"].positive("length_m", "path_length_error").required("errors")
    return table.where(length_m=min(table.values_of("length_m")))


def register_spread(near_field: str) -> None:
    """How much quantities change from the coarsest to the finest mesh, in per cent."""
    for name, column in (("path", "path_length_m"), ("distance", "distance_m"), ("speed", "speed_m_s")):
        @value(f"mesh/{near_field}/{name}")
        def _(run, column=column):
            values = queries.convergence_in_length(run, near_field)[column]
            return tex.number(100 * abs(values[0] / values[-1] - 1))


for _near_field in ("point", "free-surface"):
    register_spread(_near_field)


@value("mesh/finest/length")
def _(run):
    return tex.quantity(100 * queries.convergence_in_length(run, "free-surface")["length_m"][0], r"\centi\metre")


def register_pumped(name: str, column: str, factor: float, digits: int) -> None:
    """The pumped jet on its finest mesh, and how far the mesh with links twice as long is from it in per cent."""
    @value(f"mesh/pumped/{name}")
    def _(run):
        return tex.number(factor * queries.convergence_at_nozzle(run)[column][0], digits)

    @value(f"mesh/pumped/{name}/change")
    def _(run):
        values = queries.convergence_at_nozzle(run)[column]
        return tex.number(100 * abs(values[1] / values[0] - 1))


register_pumped("path", "path_length_m", 100, 4)
register_pumped("distance", "distance_m", 100, 5)
register_pumped("speed", "speed_m_s", 1, 5)
register_pumped("radius", "radius_m", 1e6, 4)


def register_wear(mesh: str) -> None:
    """Against the mesh that is redistributed least often."""
    @value(f"wear/{mesh}/changes")
    def _(run):
        return tex.count(largest(run["wear"].where(mesh=mesh)["changes_of_the_mesh"]))

    @value(f"wear/{mesh}/distance")
    def _(run):
        table = run["wear"]
        base = table.where(mesh="redistribute").sorted_by("changes_of_the_mesh")["distance_m"][0]
        worn = table.where(mesh=mesh).sorted_by("changes_of_the_mesh")["distance_m"][-1]
        return tex.number(100 * abs(worn / base - 1))


for _mesh in ("redistribute", "cut"):
    register_wear(_mesh)


@value("convergence/finest/error")
def _(run):
    return tex.number(100 * largest(finest_compared(run)["path_length_error"]))


@value("convergence/finest/length")
def _(run):
    return tex.quantity(100 * finest_compared(run)["length_m"].min(), r"\centi\metre")


@value("convergence/reference/length")
def _(run):
    return tex.quantity(100 * min(run["refinement_convergence"].values_of("length_m")), r"\centi\metre")


def register_resolving_power(place: str) -> None:
    """One over the resolving power of the unrefined jet at a place along it."""
    @value(f"resolving/unrefined/{place}")
    def _(run):
        rows = run["resolving_power"].where(mesh="unrefined").positive("resolving_power")
        return tex.number(1 / queries.value_at(rows["lambda"], rows["resolving_power"], float(place)), 3)


register_resolving_power("0.1")
register_resolving_power("1")


@value("resolving/refined/least")
def _(run):
    rows = run["resolving_power"].where(mesh="0.2 cm").positive("resolving_power").required("the mesh of 0.2 cm")
    return tex.number(rows["resolving_power"].min())


def register_varicosity(mesh: str) -> None:
    """How many links describe a metre of the deposited fibre."""
    @value(f"varicose/{mesh}/density")
    def _(run):
        rows = run["varicosity"].where(mesh=mesh).measured("arc_length_m", "radius_m").required(mesh)
        places = np.unique(rows["arc_length_m"])
        if len(places) < 2:
            raise NotMeasured("fewer than two places along the fibre")
        return tex.number(100 * np.ptp(places) / (len(places) - 1))


register_varicosity("unrefined")
register_varicosity("refined")


# ---- Table 2 and beyond

def headline_rows(run: RunFolder) -> Table:
    """The rows of Table 2 that are compared with the paper: most threads, cheapest solver, each length once."""
    table = run["table2"].positive("seconds_s", "seconds_paper").required("times")
    table = table.where(threads=max(table.values_of("threads")))
    best = [np.nonzero(table["length_m"] == length)[0] for length in table.values_of("length_m")]
    keep = np.zeros(len(table), dtype=bool)
    keep[[rows[np.argmin(table["seconds_s"][rows])] for rows in best]] = True
    return table.keep(keep)


@value("table2/seconds")
def _(run):
    return tex.quantity(headline_rows(run)["seconds_s"].sum(), r"\second", 3)


@value("table2/paper-seconds")
def _(run):
    return tex.quantity(headline_rows(run)["seconds_paper"].sum(), r"\second", 6)


@value("table2/gain")
def _(run):
    rows = headline_rows(run)
    return tex.number(rows["seconds_paper"].sum() / rows["seconds_s"].sum())


@value("table2/threads")
def _(run):
    return tex.count(headline_rows(run)["threads"].max())


def register_table2_error(key: str, column: str) -> None:
    """The worst error of the headline rows against the strict run, per cent."""
    @value(f"table2/{key}-error")
    def _(run):
        return tex.number(largest(headline_rows(run)[column]))


for _key, _column in (("tip", "tip_error"), ("path", "path_length_error"), ("deposit", "deposit_mass_error")):
    register_table2_error(_key, _column)


# ---- two rates

def of_method(run: RunFolder, method: str) -> Table:
    """The rows of one method, from the coarsest mesh to the finest."""
    table = run["two_rates"].where(method=method).positive("seconds_per_ms_s").required("two rates")
    return table.sorted_by("beads")


@value("two-rates/one-sums")
def _(run):
    sums = of_method(run, "dormand-prince")["full_sums_per_ms"]
    return tex.number(sums.min()) + " to " + tex.number(sums.max())


@value("two-rates/two-sums")
def _(run):
    rows = of_method(run, "two-rate")
    return tex.number(rows.keep(rows["length_m"] > 0)["full_sums_per_ms"][0])


@value("two-rates/least-sums")
def _(run):
    return tex.number(of_method(run, "two-rate")["full_sums_per_ms"].min())


@value("two-rates/error-ratio")
def _(run):
    one, two = (of_method(run, method) for method in ("dormand-prince", "two-rate"))
    known = np.isfinite(one["error_m"]) & np.isfinite(two["error_m"])
    return tex.number((two["error_m"][known] / one["error_m"][known]).max())


@value("two-rates/gain")
def _(run):
    one, two = (of_method(run, method).where(length_m=0.002) for method in ("dormand-prince", "two-rate"))
    return tex.number((one["seconds_per_ms_s"] / two["seconds_per_ms_s"])[0])


def register_two_rate_exponent(key: str, method: str) -> None:
    """Growth of the time of a millisecond with the beads, for meshes of 0.2 cm and finer."""
    @value(f"two-rates/exponent-{key}")
    def _(run):
        rows = of_method(run, method)
        rows = rows.keep((rows["length_m"] > 0) & (rows["length_m"] <= 0.002))
        return tex.number(queries.exponent(rows["beads"], rows["seconds_per_ms_s"]), 3)


register_two_rate_exponent("one", "dormand-prince")
register_two_rate_exponent("two", "two-rate")


@value("two-rates/stiff-gain")
def _(run):
    table = run["two_rates_stiff"].where(elastic_modulus_Pa=5e5)
    one, two = (table.where(method=method)["full_sums_per_ms"][0] for method in ("dormand-prince", "two-rate"))
    return tex.number(one / two)


def register_scaling(solver: str) -> None:
    """Cost and memory of the largest run with a solver, and the exponent of its cost."""
    def rows(run: RunFolder) -> Table:
        table = run["scaling"].where(solver=solver).positive("beads", "seconds_per_evaluation_s").required(solver)
        tolerances = table.values_of("tolerance")
        table = table.where(tolerance=max(tolerances)) if tolerances else table
        return table.where(source=queries.first_present(table, "source", ("collector distance",))).sorted_by("beads")

    @value(f"scaling/{solver}/exponent")
    def _(run):
        return tex.number(queries.exponent(rows(run)["beads"], rows(run)["seconds_per_evaluation_s"]), 3)

    @value(f"scaling/{solver}/beads")
    def _(run):
        return tex.power(float(f"{rows(run)['beads'][-1]:.1e}"))

    @value(f"scaling/{solver}/time")
    def _(run):
        return tex.quantity(rows(run)["seconds_per_evaluation_s"][-1], r"\second")

    @value(f"scaling/{solver}/memory")
    def _(run):
        return tex.quantity(rows(run)["memory_bytes"][-1] / 2**20, r"\mebi\byte")

    @value(f"scaling/{solver}/tolerance")
    def _(run):
        return tex.power(rows(run)["tolerance"][-1])


for _solver in ("direct", *queries.FAST_SOLVERS):
    register_scaling(_solver)


# ---- physics

def energy_rows(run: RunFolder, direct: bool) -> Table:
    """Residuals with the direct sum, or with the fast solvers."""
    table = run["energy"].measured("residual")
    table = table.keep((table["solver"] == "direct") == direct)
    return table.required("the direct sum" if direct else "a fast solver")


@value("energy/least")
def _(run):
    table = energy_rows(run, direct=True)
    strict = queries.strictest_rtol(table)
    return tex.number(largest(strict["residual"]))


@value("energy/least-rtol")
def _(run):
    return tex.power(min(energy_rows(run, direct=True).values_of("rtol")))


@value("energy/fast")
def _(run):
    """The worst ratio of residual and tolerance."""
    table = queries.strictest_rtol(energy_rows(run, direct=False).positive("tolerance"))
    return tex.number(largest(table["residual"] / table["tolerance"]))


@value("dispersion/error")
def _(run):
    """Over the direct sum and the fast solvers where they are to be exact to 1e-6."""
    table = run["dispersion"]
    return tex.number(largest(table.keep(~(table["tolerance"] > 1.01e-6))["relative_error"]))


@value("dispersion/waves")
def _(run):
    return tex.count(len(run["dispersion"].values_of("wavelength_m")))


@value("checks/passed")
def _(run):
    return tex.count(int(np.nansum(run["checks"]["passed"])))


@value("checks/all")
def _(run):
    return tex.count(len(run["checks"]))
