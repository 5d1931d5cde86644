"""The figures of the article. Each panel is a function that draws on axes what a run has measured."""

from __future__ import annotations

import functools

import numpy as np
from matplotlib import colors, ticker
from matplotlib.lines import Line2D

from . import queries, style
from .run_folder import NotMeasured, RunFolder
from .style import plt


class Panels:
    """Axes of one figure. A panel without data says so; a figure without any is not made."""

    def __init__(self, run: RunFolder, rows: int, columns: int, width: float, height: float, **options):
        self.run = run
        self.figure, axes = plt.subplots(rows, columns, figsize=(width, height), squeeze=False, **options)
        self.axes = axes.ravel()
        self.missing: list[str] = []
        self.drawn = 0

    def draw(self, index: int, panel) -> None:
        """Draws one panel, or says in it that the run has no data."""
        axes = self.axes[index]
        try:
            panel(axes, self.run)
            self.drawn += 1
        except NotMeasured as error:
            self.missing.append(str(error))
            axes.clear()
            axes.set_axis_off()
            axes.text(0.5, 0.5, "not measured\nin this run", ha="center", va="center", transform=axes.transAxes)

    def finish(self):
        """The figure and what it lacks."""
        if self.drawn == 0:
            plt.close(self.figure)
            raise NotMeasured("; ".join(sorted(set(self.missing))))
        return self.figure, self.missing


def panel_row(run: RunFolder, panels, width: float, height: float, **options):
    """A figure whose panels stand side by side, lettered if there are several."""
    sheet = Panels(run, 1, len(panels), width, height, **options)
    for i, panel in enumerate(panels):
        sheet.draw(i, panel)
        if len(panels) > 1:
            letter_axes(sheet.axes[i], i)
    return sheet.finish()


def with_legend_below(figure_and_missing, columns: int, one_label: bool = True):
    """The same figure with one legend for all its panels; only the first keeps its vertical label if all are alike."""
    figure, missing = figure_and_missing
    for axes in figure.axes[1:] if one_label else []:
        axes.set_ylabel("")
    legend_below(figure, columns)
    return figure, missing


def letter_axes(axes, index: int) -> None:
    """Puts (a), (b), ... before the title of a panel."""
    axes.set_title(f"({'abcdefgh'[index]}) {axes.get_title()}", loc="left")
    axes.set_title("")


def log_log(axes, x: str, y: str) -> None:
    """Logarithmic axes with these labels."""
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel(x)
    axes.set_ylabel(y)


LEGEND_ROW = 0.153  # inches: one entry of a legend
AXES_MARGIN = 0.62  # inches: title and labels above and below the axes


def make_room(axes, rows: int, above: bool = True) -> None:
    """Widens the vertical axis so that a legend with so many rows lies beside no data."""
    share = min(0.7, (rows * LEGEND_ROW + 0.12) / (axes.figure.get_size_inches()[1] - AXES_MARGIN))
    low, high = axes.get_ylim()
    if axes.get_yscale() == "log":
        low, high = np.log(low), np.log(high)
    extra = (high - low) * share / (1 - share)
    low, high = (low, high + extra) if above else (low - extra, high)
    axes.set_ylim(*(np.exp([low, high]) if axes.get_yscale() == "log" else (low, high)))


def legend_below(figure, columns: int) -> None:
    """One legend for all panels under them, each name once."""
    entries = {}
    for axes in figure.axes:
        for handle, name in zip(*axes.get_legend_handles_labels()):
            entries.setdefault(name, handle)
    if entries:
        rows = -(-len(entries) // columns)
        share = (rows * LEGEND_ROW + 0.05) / figure.get_size_inches()[1]
        figure.get_layout_engine().set(rect=(0, share, 1, 1 - share))
        figure.legend(entries.values(), entries.keys(), loc="lower center", ncol=columns)


# ---- Coulomb solvers


def error_against_time(axes, run: RunFolder) -> None:
    """Error of one force call against its time, a curve per fast solver, tolerances along it."""
    table = queries.solver_survey(run)
    charges = queries.nearest(table.values_of("charges"), queries.HEADLINE_CHARGES)
    table = table.where(charges=charges)
    for solver in queries.FAST_SOLVERS:
        rows = table.where(solver=solver).positive("seconds_s", "error_l2").sorted_by("tolerance")
        if len(rows):
            axes.plot(1e3 * rows["seconds_s"], rows["error_l2"], label=style.solver_name(solver),
                      linestyle="-" if solver == "fmm" else "--", **style.solver_style(solver))
    if not axes.lines:
        raise NotMeasured("coulomb.csv has no errors of a fast solver")
    direct = table.where(solver="direct")["seconds_s"]
    if len(direct):
        axes.axvline(1e3 * direct.min(), color=style.BLACK, linestyle=":", label="direct sum")
    log_log(axes, "time of one force call (ms)", "relative error of the force ($L_2$)")
    axes.set_title(f"$n$ = {charges:,.0f}")
    axes.legend(loc="lower left")
    make_room(axes, 3, above=False)


def time_against_charges(axes, run: RunFolder) -> None:
    """Time of one force call against the number of charges: colour tells the solver, line the tolerance."""
    table = queries.solver_survey(run)
    tolerances = queries.shown_tolerances(table.where(solver="fmm"))
    solvers = []
    for solver in ("direct", *queries.FAST_SOLVERS):
        for tolerance, line in zip(tolerances if solver != "direct" else [None], ("--", "-", "-.")):
            rows = queries.scaling_curve(table, solver, tolerance, "seconds_s")
            if len(rows):
                axes.plot(rows["charges"], 1e3 * rows["seconds_s"], markersize=3,
                          linestyle=":" if solver == "direct" else line, **style.solver_style(solver))
                solvers.append(solver)
    if not solvers:
        raise NotMeasured("coulomb.csv has no times over the number of charges")
    log_log(axes, "number of charges $n$", "time of one force call (ms)")
    looks = [Line2D([], [], linestyle=":" if solver == "direct" else "-", label=style.solver_name(solver),
                    **style.solver_style(solver)) for solver in dict.fromkeys(solvers)]
    looks += [Line2D([], [], color="#666666", linestyle=line, label=style.tolerance_name(t))
              for t, line in zip(tolerances, ("--", "-", "-."))]
    axes.legend(handles=looks, loc="upper left", ncol=2, columnspacing=0.8)
    make_room(axes, -(-len(looks) // 2))


LEAST_RATIO = 1e-4  # smaller errors over tolerance are drawn here: few charges, which the direct sum inside takes


def error_over_tolerance(axes, run: RunFolder) -> None:
    """Every case of the survey: its error in units of the tolerance asked for, by geometry."""
    table = queries.fast_cases(run).positive("error_over_tolerance")
    geometries = [g for g in ("jet", "real", "helix", "line", "ring", "cube") if g in table["geometry"]]
    geometries += sorted(set(table["geometry"]) - set(geometries))
    for offset, solver in ((-0.18, "treecode"), (0.18, "fmm")):
        for norm, filled in (("global", True), ("per-bead", False)):
            rows = table.where(solver=solver).keep(table.where(solver=solver)["norm"] == norm)
            if not len(rows):
                continue
            look = style.solver_style(solver)
            places = np.array([geometries.index(g) for g in rows["geometry"]]) + offset
            spread = np.random.default_rng(1).permutation(np.linspace(-0.13, 0.13, len(rows)))
            axes.plot(places + spread, np.maximum(rows["error_over_tolerance"], LEAST_RATIO), linestyle="none",
                      markersize=3, alpha=0.8, marker=look["marker"], color=look["color"],
                      markerfacecolor=look["color"] if filled else "white",
                      markeredgewidth=0.6, label=style.solver_name(solver) + ("" if filled else ", per bead"))
    axes.axhline(1, color=style.RED, linewidth=0.9)
    axes.set_yscale("log")
    axes.set_xticks(range(len(geometries)), geometries)
    axes.set_xlim(-0.5, len(geometries) - 0.5)
    axes.grid(False, axis="x")
    axes.set_ylabel("error over tolerance")
    axes.set_title("all cases")
    axes.set_ylim(top=max(axes.get_ylim()[1], 2))
    axes.legend(loc="lower left")
    make_room(axes, 4, above=False)


def coulomb(run: RunFolder):
    """Work and precision of the Coulomb solvers."""
    panels = (error_against_time, time_against_charges, error_over_tolerance)
    return panel_row(run, panels, style.PAGE_WIDTH, 2.55)


# ---- tolerance of the solver in trajectories


SCENE_NAMES = {
    "case_one": "case I", "table2_08": r"$\tilde l$ = 0.8 cm", "table2_04": r"$\tilde l$ = 0.4 cm",
    "table2_02": r"$\tilde l$ = 0.2 cm", "growth": "bending wave",
}


def deviation(columns: dict[str, str], label: str, axes, run: RunFolder) -> None:
    """A deviation at the last time compared against the solver's tolerance, by scene.

    `columns` names the column, with "" for the scenes that it does not name. Dotted: what the direct sum's run is off
    by at the same rtol, the error of the integrator.
    """
    table = queries.last_times(run["trajectory"])
    scenes = [s for s in SCENE_NAMES if s in table["scene"]]
    looks = style.curve_styles(SCENE_NAMES)
    for scene in scenes:
        column = columns.get(scene, columns[""])
        of_scene = table.where(scene=scene)
        look = {key: part for key, part in looks[scene].items() if key != "linestyle"}
        for solver, filled in (("fmm", True), ("treecode", False)):
            rows = of_scene.where(solver=solver).positive("tolerance", column).sorted_by("tolerance")
            if len(rows):
                axes.plot(rows["tolerance"], rows[column], label=SCENE_NAMES[scene] if filled else None,
                          linestyle="-" if filled else "--",
                          markerfacecolor=look["color"] if filled else "white", **look)
        own = of_scene.where(solver="direct").positive(column)
        if len(own):
            axes.axhline(own[column].max(), color=look["color"], linestyle=":", linewidth=0.9)
    if not axes.lines:
        raise NotMeasured("trajectory.csv has no deviations of a fast solver")
    log_log(axes, "tolerance of the solver", label)


def trajectory(run: RunFolder):
    """How a solver's tolerance carries into trajectories."""
    path = functools.partial(deviation, {"": "path_length_error", "growth": "growth_rate_error"},
                             "deviation of path length, growth rate")
    position = functools.partial(deviation, {"": "position_error_m"}, "largest deviation of a bead (m)")
    return with_legend_below(panel_row(run, (path, position), style.PAGE_WIDTH, 2.5), 5, one_label=False)


# ---- integrators

METHOD_NAMES = {
    "euler": "Euler", "heun": "Heun", "rk4": "RK4", "dormand-prince": "Dormand-Prince",
    "dop853": "DOP853", "ros34pw2": "ROS34PW2", "auto": "auto",
}
FIXED_STEP_METHODS = ("euler", "heun", "rk4")  # of which fixed steps are shown


def method_looks(methods) -> dict:
    """Colour and marker of each integrator, the same in every figure."""
    known = list(METHOD_NAMES)
    order = known + sorted(set(methods) - set(known))
    return {m: {k: v for k, v in look.items() if k != "linestyle"} for m, look in style.curve_styles(order).items()}


def shown_curve(method: str, events: str, control: str) -> bool:
    """Whether a curve is worth its ink: fixed steps of plain methods, adaptive pairs, one of them at step ends."""
    if control == "step":
        return method in FIXED_STEP_METHODS
    return events == "located" or method == "dormand-prince"


def work_precision(scene: str, title: str, axes, run: RunFolder) -> None:
    """Error of positions against evaluations of the right-hand side; broken lines: events at step ends."""
    table = run["integrators"].where(scene=scene).positive("evaluations", "position_error_m").required(scene)
    looks = method_looks(table["method"])
    curves = sorted(set(zip(table["control"], table["method"], table["events"], table["landings"])))
    both_landings = len(set(table["landings"])) > 1
    for control, method, events, landings in curves:
        if not shown_curve(method, events, control):
            continue
        rows = table.where(method=method, events=events, landings=landings, control=control).sorted_by("evaluations")
        each = both_landings and landings == "located"
        name = METHOD_NAMES.get(method, method) + ", fixed step" * (control == "step")
        name += ", each landing located" * each + ", step ends" * (events == "step-end")
        axes.plot(rows["evaluations"], rows["position_error_m"], label=name,
                  linestyle="--" if events == "step-end" else ":" if each else "-",
                  markerfacecolor="white" if control == "step" else looks[method]["color"], **looks[method])
    log_log(axes, "evaluations of all forces", "largest error of a bead's position (m)")
    axes.set_title(title)


def integrators(run: RunFolder):
    """Work and precision of the integrators, with and without location of events."""
    panels = (functools.partial(work_precision, "case_one", "case I"),
              functools.partial(work_precision, "table2_04", r"refined at $\tilde l$ = 0.4 cm"))
    return with_legend_below(panel_row(run, panels, style.PAGE_WIDTH, 3.3), 3)


def stability_map(method: str, column: str, scale, axes, run: RunFolder) -> None:
    """A column of one method over modulus and viscosity; crosses: refused; grey: nothing reached."""
    table = queries.base_case(run["stability"]).where(method=method)
    table = table.positive("modulus_pa", "viscosity_pa_s").required(method)
    moduli, viscosities = table.values_of("modulus_pa"), table.values_of("viscosity_pa_s")
    values = np.full((len(viscosities), len(moduli)), np.nan)
    for g, mu, value, refused in zip(table["modulus_pa"], table["viscosity_pa_s"], table[column],
                                     queries.refused(table)):
        i, j = viscosities.index(mu), moduli.index(g)
        values[i, j] = value
        if refused and column.startswith("evaluations"):
            axes.plot(j, i, "x", color=style.RED, markersize=5, markeredgewidth=1.2)
    image = axes.pcolormesh(np.arange(len(moduli)), np.arange(len(viscosities)), values, norm=scale, cmap="cividis",
                            shading="nearest")
    axes.set_facecolor("#E8E8E8")
    axes.grid(False)
    axes.set_xticks(range(len(moduli)), [style.tolerance_name(g) for g in moduli], fontsize=8)
    axes.set_yticks(range(len(viscosities)), [style.tolerance_name(mu) for mu in viscosities], fontsize=8)
    thin_out(axes.xaxis, 5)
    axes.set_title(METHOD_NAMES.get(method, method))
    axes.stability_image = image


def thin_out(axis, most: int) -> None:
    """Empties tick labels until at most so many are left."""
    labels = [label.get_text() for label in axis.get_ticklabels()]
    every = -(-len(labels) // most)
    axis.set_ticklabels([label if i % every == 0 else "" for i, label in enumerate(labels)])


STABILITY_ROWS = {"largest_step_s": "largest stable step (s)", "evaluations_1e4": "evaluations"}


def stability(run: RunFolder):
    """Largest stable step, and below it the cost of an accuracy, over modulus and viscosity for each method."""
    table = queries.base_case(run["stability"])
    known = list(METHOD_NAMES)
    methods = sorted(set(table["method"]), key=lambda m: (known.index(m) if m in known else len(known), m))
    sheet = Panels(run, len(STABILITY_ROWS), len(methods), style.PAGE_WIDTH, 3.9, sharex=True, sharey=True)
    grid = sheet.axes.reshape(len(STABILITY_ROWS), len(methods))
    letter = 0
    for row, (column, label) in enumerate(STABILITY_ROWS.items()):
        measured = table.positive(column)
        if not len(measured[column]):
            raise NotMeasured(f"stability.csv has no {column}")
        least, most = measured[column].min(), measured[column].max()
        scale = colors.LogNorm(least, max(most, 10 * least))
        for i, method in enumerate(methods):
            if method not in set(measured["method"]):  # a choice of method has no step of its own
                grid[row, i].set_axis_off()
                continue
            sheet.draw(row * len(methods) + i, functools.partial(stability_map, method, column, scale))
            letter_axes(grid[row, i], letter)
            letter += 1
        images = [axes.stability_image for axes in grid[row] if hasattr(axes, "stability_image")]
        sheet.figure.colorbar(images[0], ax=list(grid[row]), label=label, pad=0.01)
        grid[row, 0].set_ylabel(r"viscosity $\mu$ (Pa s)")
    for axes in grid[-1]:
        axes.set_xlabel("modulus $G$ (Pa)")
    return sheet.finish()


# ---- refinement


REMAP_LINES = {"conservative": "-", "paper": "--"}


def path_convergence(axes, run: RunFolder) -> None:
    """Deviation of the path length against the refinement length: colour tells the interval, line the remap."""
    table = run["refinement_convergence"].positive("length_m", "path_length_error").required("errors")
    intervals = sorted(table.values_of("interval_s"), reverse=True)
    looks = style.curve_styles(intervals)
    for interval in intervals:
        for remap in table.values_of("remap"):
            rows = table.where(remap=remap, interval_s=interval).sorted_by("length_m")
            look = looks[interval] | dict(linestyle=REMAP_LINES.get(remap, ":"))
            axes.plot(100 * rows["length_m"], rows["path_length_error"], **look)
    log_log(axes, r"refinement length $\tilde l$ (cm)", "deviation of the path length")
    lengths = [100 * length for length in table.values_of("length_m")]
    axes.set_xticks(lengths[:: -(-len(lengths) // 5)])
    axes.xaxis.set_major_formatter(ticker.FormatStrFormatter("%g"))
    axes.xaxis.set_minor_locator(ticker.NullLocator())
    entries = [Line2D([], [], label=f"{1e3 * interval:g} ms", **(looks[interval] | dict(linestyle="none")))
               for interval in intervals]
    entries += [Line2D([], [], color="#666666", linestyle=REMAP_LINES.get(remap, ":"), label=remap)
                for remap in table.values_of("remap")]
    axes.legend(handles=entries, loc="upper left", ncol=2, columnspacing=0.6)
    make_room(axes, -(-len(entries) // 2))


def resolving_power(axes, run: RunFolder) -> None:
    """l_step over the length of a link along the jet, time mean of the stationary regime."""
    table = run["resolving_power"].positive("resolving_power").required("powers")
    meshes = sorted(set(table["mesh"]), key=lambda mesh: (mesh != "unrefined", mesh))
    for mesh, look in style.curve_styles(meshes).items():
        rows = table.where(mesh=mesh).sorted_by("lambda")
        axes.plot(rows["lambda"], rows["resolving_power"], label=mesh, markevery=max(1, len(rows) // 8), **look)
    axes.set_yscale("log")
    axes.set_xlabel(r"arc length over path length $\lambda$")
    axes.set_ylabel(r"resolving power $l_\mathrm{step}/l$")
    axes.legend(loc="upper right")


def varicosity(axes, run: RunFolder) -> None:
    """Radius along the deposited fibre of a jet with a heavier bead in ten."""
    table = run["varicosity"].measured("arc_length_m", "radius_m").required("radii")
    meshes = sorted(set(table["mesh"]), reverse=True)
    for mesh, look in style.curve_styles(meshes).items():
        rows = table.where(mesh=mesh).sorted_by("arc_length_m")
        # One line is enough to tell two dense step functions apart: no markers.
        axes.plot(100 * (rows["arc_length_m"] - rows["arc_length_m"].min()), 1e6 * rows["radius_m"], label=mesh,
                  color=look["color"], linestyle=look["linestyle"], linewidth=0.9)
    axes.set_xlabel("arc length on the collector (cm)")
    axes.set_ylabel(r"radius of the fibre ($\mu$m)")
    axes.legend(loc="upper left", ncol=2)
    make_room(axes, 1)


def refinement(run: RunFolder):
    """What mesh refinement does."""
    return panel_row(run, (path_convergence, resolving_power, varicosity), style.PAGE_WIDTH, 2.4)


def path_against_links(axes, run: RunFolder) -> None:
    """Path length against that of the finest mesh: points, a near field, and a pumped jet with its links at the nozzle."""
    curves = {
        r"points, against $\tilde l$": (queries.convergence_in_length(run, "point"), "length_m"),
        r"near field, against $\tilde l$": (queries.convergence_in_length(run, "free-surface"), "length_m"),
        r"pumped, near field, against $l_\mathrm{step}$": (queries.convergence_at_nozzle(run), "link_length_m"),
    }
    for (label, (rows, column)), look in zip(curves.items(), style.curve_styles(curves).values()):
        axes.plot(1e3 * rows[column], 100 * (rows["path_length_m"] / rows["path_length_m"][0] - 1), label=label, **look)
    axes.set_xscale("log")
    axes.xaxis.set_major_formatter(ticker.FormatStrFormatter("%g"))
    axes.axhline(0, color="#999999", linewidth=0.6)
    axes.set_xlabel("length of the links (mm)")
    axes.set_ylabel("path length, change from the finest mesh (%)")
    axes.legend(loc="best")


def wear_of_remaps(axes, run: RunFolder) -> None:
    """Where the jet lands against the number of times that its mesh has changed in 20 ms."""
    table = run["wear"].positive("distance_m").required("distances")
    for mesh, look in style.curve_styles(("redistribute", "cut")).items():
        rows = table.where(mesh=mesh).sorted_by("changes_of_the_mesh")
        axes.plot(rows["changes_of_the_mesh"], 100 * rows["distance_m"], label=mesh, **look)
    axes.set_xscale("log")
    axes.set_xlabel("changes of the mesh in 20 ms")
    axes.set_ylabel("distance of impact from the axis (cm)")
    axes.legend(loc="upper left")


def mesh(run: RunFolder):
    """What converges, and what does not."""
    return panel_row(run, (path_against_links, wear_of_remaps), style.PAGE_WIDTH, 2.6)


def snapshots(run: RunFolder):
    """The jet at one instant for every refinement length: from the side and along its axis."""
    table = run["snapshots"].measured("x_m", "y_m", "z_m")
    lengths = table.values_of("length_m")
    sheet = Panels(run, 2, len(lengths), style.PAGE_WIDTH, 5.0, height_ratios=(2, 1), sharex=True, sharey="row")
    side = 105 * max(np.abs(table["y_m"]).max(), np.abs(table["z_m"]).max())
    for i, (length, look) in enumerate(style.curve_styles(lengths).items()):
        beads = table.where(length_m=length).sorted_by("bead") if length > 0 else table.keep(table["length_m"] == 0)
        sheet.draw(i, functools.partial(snapshot, beads, "x_m", look["color"]))
        sheet.draw(len(lengths) + i, functools.partial(snapshot, beads, "z_m", look["color"]))
        title = rf"$\tilde l$ = {style.length_name(length)}" if length > 0 else "not refined"
        sheet.axes[i].set_title(f"({'abcdefgh'[i]}) {title}, {len(beads)} beads")
        sheet.axes[len(lengths) + i].set_xlabel("$y$ (cm)")
    sheet.axes[0].invert_yaxis()
    sheet.axes[0].set_ylabel("$x$ (cm)")
    sheet.axes[len(lengths)].set_ylabel("$z$ (cm)")
    sheet.axes[0].set_xlim(-side, side)
    sheet.axes[len(lengths)].set_ylim(-side, side)
    return sheet.finish()


def snapshot(beads, vertical: str, color: str, axes, _run: RunFolder) -> None:
    """The beads of one jet and the links between them, y across."""
    axes.plot(100 * beads["y_m"], 100 * beads[vertical], color="#999999", linewidth=0.5)
    axes.plot(100 * beads["y_m"], 100 * beads[vertical], linestyle="none", marker="o", markersize=1.6, color=color)
    axes.set_aspect("equal")


# ---- scaling


def time_per_evaluation(axes, run: RunFolder) -> None:
    """Wall time of an evaluation against the number of beads, with the paper's Table 2."""
    table = run["scaling"].positive("beads", "seconds_per_evaluation_s").required("times")
    tolerances = np.nan_to_num(table["tolerance"])
    curves = sorted(set(zip(table["source"], table["solver"], tolerances)))
    for (source, solver, tolerance), line in zip(curves, style.LINE_STYLES * 2):
        rows = table.keep((table["source"] == source) & (table["solver"] == solver) & (tolerances == tolerance))
        rows = rows.sorted_by("beads")
        name = style.solver_name(solver) + (f", {style.tolerance_name(tolerance)}" if tolerance > 0 else "")
        axes.plot(rows["beads"], rows["seconds_per_evaluation_s"], label=name + ", finer mesh" * (source == "cut links"),
                  linestyle=line, **style.solver_style(solver))
    try:
        paper = run["table2"].positive("beads_paper", "seconds_paper").required().sorted_by("beads_paper")
        axes.plot(paper["beads_paper"], paper["seconds_paper"] / PAPER_EVALUATIONS, "X", color=style.RED,
                  label="Lauricella et al. 2016, 24 cores")
    except NotMeasured:
        pass
    log_log(axes, "number of beads", "wall time of an evaluation (s)")


PAPER_EVALUATIONS = 8e7  # of the original Table 2: 0.2 s in steps of 1e-8 s with RK4


def memory(axes, run: RunFolder) -> None:
    """Memory of a run against the number of beads."""
    table = run["scaling"].positive("beads", "memory_bytes").required("memory")
    for solver in sorted(set(table["solver"])):
        rows = table.where(solver=solver).sorted_by("beads")
        axes.plot(rows["beads"], rows["memory_bytes"] / 2**20, linestyle="none", **style.solver_style(solver))
    log_log(axes, "number of beads", "memory (MiB)")


def scaling(run: RunFolder):
    """Cost beyond Table 2."""
    return with_legend_below(panel_row(run, (time_per_evaluation, memory), style.PAGE_WIDTH, 2.6), 3, one_label=False)


# ---- two rates


def against_beads(axes, run: RunFolder, column: str, ylabel: str) -> None:
    """A quantity of the jets of all refinement lengths against the number of beads, with one rate and with two."""
    table = run["two_rates"].positive("beads", column).required(column)
    looks = {"dormand-prince": ("one rate", style.RED, "s"), "two-rate": ("two rates", style.BLUE, "o")}
    for method, (label, color, marker) in looks.items():
        rows = table.where(method=method).sorted_by("beads")
        axes.plot(rows["beads"], rows[column], label=label, color=color, marker=marker)
    log_log(axes, "number of beads", ylabel)


def sums_of_two_rates(axes, run: RunFolder) -> None:
    """Coulomb sums per millisecond."""
    against_beads(axes, run, "full_sums_per_ms", "Coulomb sums per ms")


def time_of_two_rates(axes, run: RunFolder) -> None:
    """Wall time per millisecond."""
    against_beads(axes, run, "seconds_per_ms_s", "wall time per ms (s)")


def error_of_two_rates(axes, run: RunFolder) -> None:
    """The worst bead."""
    against_beads(axes, run, "error_m", "error of the worst bead (m)")


def two_rates(run: RunFolder):
    """What steps with two rates save, at which error."""
    panels = (sums_of_two_rates, time_of_two_rates, error_of_two_rates)
    return with_legend_below(panel_row(run, panels, style.PAGE_WIDTH, 2.4), 2)


# ---- physics


def energy_residual(axes, run: RunFolder) -> None:
    """The largest residual of the energy budget against rtol, for the fast solvers against their tolerance."""
    table = run["energy"].measured("residual", "rtol")
    direct = table.where(solver="direct")
    methods = method_looks(table["method"])
    for method in direct.values_of("method"):
        x, y = largest_by(direct.where(method=method), "rtol", "residual")
        axes.plot(x, y, label=f"{METHOD_NAMES.get(method, method)}, against rtol", linestyle="-", **methods[method])
    for solver in queries.FAST_SOLVERS:
        rows = queries.strictest_rtol(table.where(solver=solver).measured("tolerance"))
        if len(rows):
            x, y = largest_by(rows, "tolerance", "residual")
            axes.plot(x, y, label=f"{style.solver_name(solver)}, against tolerance", linestyle="--",
                      **style.solver_style(solver))
    if not axes.lines:
        raise NotMeasured("energy.csv has no residuals")
    log_log(axes, "rtol, or tolerance of the solver", "residual over Coulomb energy")
    axes.legend(loc="upper left")
    make_room(axes, len(axes.lines))


def largest_by(table, group: str, column: str):
    """The values of one column and, for each, the largest of another."""
    groups = table.values_of(group)
    return groups, [table.where(**{group: value})[column].max() for value in groups]


def dispersion(axes, run: RunFolder) -> None:
    """Growth rates of bending waves on a straight chain against theory."""
    table = run["dispersion"].positive("wavelength_m").measured("growth_rate_per_s", "theory_per_s").required("rates")
    theory = table.sorted_by("wavelength_m")
    axes.plot(1e3 * theory["wavelength_m"], theory["theory_per_s"], color=style.BLACK, linewidth=0.9, label="theory")
    for solver in sorted(set(table["solver"])):
        rows = table.where(solver=solver).sorted_by("wavelength_m")
        axes.plot(1e3 * rows["wavelength_m"], rows["growth_rate_per_s"], linestyle="none", markerfacecolor="none",
                  markersize={"direct": 7, "treecode": 5}.get(solver, 3.5), label=style.solver_name(solver),
                  **style.solver_style(solver))
    log_log(axes, "wavelength (mm)", "growth rate (1/s)")
    axes.legend(loc="lower left")


def physics(run: RunFolder):
    """Energy budget and growth of bending waves."""
    return panel_row(run, (energy_residual, dispersion), style.PAGE_WIDTH, 2.5)


FIGURES = {
    "coulomb": coulomb,
    "trajectory": trajectory,
    "integrators": integrators,
    "stability": stability,
    "refinement": refinement,
    "mesh": mesh,
    "snapshots": snapshots,
    "scaling": scaling,
    "two_rates": two_rates,
    "physics": physics,
}
HEADLINES = {
    "error_against_time": error_against_time,
    "time_against_n": time_against_charges,
    "path_against_links": path_against_links,
}
