"""Films of particles, by matplotlib: .gif by pillow, .mp4 by ffmpeg."""

import os

import numpy

from . import _carom, results
from .axes import colour_of, pyplot
from .commands import _as_system, run
from .errors import InputError
from .tables import draw_levels, fit, make_room, table

ENDINGS = (".gif", ".mp4")


def animate(
    thing, output=None, *, t_max=None, frames=100, fps=20, trail=10, dpi=100, progress=None, **keywords
):
    """A film of the particles of a `carom.Run` or of a system, which is run: a
    matplotlib.animation.FuncAnimation.

    output: the file, a name ending in .gif or .mp4. t_max (time): end of the film; default: the end
    of a run or its hundredth hit, twenty mean flights of a system. frames: their number; fps: frames
    per second; trail: frames for which a particle's path stays visible. progress: called with the
    number of saved frames. Keywords: keys of a system file.
    """
    if output is not None:
        output = os.fspath(output)
        check(output)
    plt = pyplot()
    from matplotlib import animation

    if not isinstance(thing, results.Run):
        system = _as_system(thing)
        t_max = t_max or _until(system)
        sample = {} if system._loaded("run").engine == "events" else {"sample": t_max / (4 * frames)}
        thing = run(system, t_max=t_max, state_error=False, **sample, **keywords)
    particles = sorted(set(thing.starts["particle"].tolist()))
    last = min(t_max or numpy.inf, *(thing._states(p)[-1, 0] for p in particles), _hundredth(thing))
    times = numpy.linspace(0.0, last, frames)
    where = _carom.frames(
        thing._outcome.system, particles, thing.engine == "events",
        [thing._states(p) for p in particles], list(times),
    )  # fmt: skip
    ax = _stage(thing, where)
    clock = ax.annotate("", (0, 0), xycoords="axes fraction", xytext=(0, -22), va="top",
                        textcoords="offset points", fontsize="x-small", color="0.35")  # fmt: skip
    colours = [colour_of(i, len(particles)) for i in range(len(particles))]
    ways = [ax.plot([], [], color=c, linewidth=1.2, alpha=0.7, zorder=2)[0] for c in colours]
    dots = [ax.plot([], [], "o", color=c, markersize=5, zorder=4)[0] for c in colours]
    paths = [thing.path(p) for p in particles]
    # Hard discs are drawn as large as they are.
    discs = [
        ax.add_patch(plt.Circle((0, 0), radius, color=c, alpha=0.5, linewidth=0, zorder=3))
        for radius, c in zip(_carom.disc_radii(thing._outcome.system), colours)
    ]

    def show(k):
        begin = times[max(0, k - trail)]
        for i, (way, dot, path) in enumerate(zip(ways, dots, paths)):
            x, y = where[k, i]
            seen = (path["t"] >= begin) & (path["t"] <= times[k])
            way.set_data(numpy.append(path["x"][seen], x), numpy.append(path["y"][seen], y))
            dot.set_data([x], [y])
            if discs:
                discs[i].set_center((x, y))
        clock.set_text(f"t = {times[k]:.3g}")
        return [*ways, *dots, *discs, clock]

    film = animation.FuncAnimation(ax.figure, show, frames=frames, interval=1000 / fps)
    if output is not None:
        told = None if progress is None else lambda frame, _: progress(frame + 1)
        film.save(output, writer=_writer(output, fps), dpi=dpi, progress_callback=told)
    return film


def _stage(run, where):
    """The table, with room for all places of the particles: of a lattice the cells that they visit."""
    cells = {(0, 0), *zip(run._samples["cell_first"].tolist(), run._samples["cell_second"].tolist())}
    cells |= set(zip(run.hits["cell_first"][:2000].tolist(), run.hits["cell_second"][:2000].tolist()))
    cells = cells if len(cells) <= 400 else [(0, 0)]
    ax = table(run.system, names=False, cells=cells, levels=False, directions=False, starts=0)
    ax.update_datalim(where[numpy.isfinite(where).all(axis=2)])
    make_room(ax, 0.04)
    draw_levels(run.system._loaded("table"), ax)
    fit(ax)
    ax.figure.draw_without_rendering()
    ax.figure.set_layout_engine("none")  # what it has laid out is kept: once is enough for all frames
    return ax


def check(output):
    """Throws InputError where nothing here writes such films."""
    if not output.endswith(ENDINGS):
        raise InputError(
            f"{output}: not the name of a film", ("", 0, 0, "output"), "a name ending in .gif or .mp4"
        )
    _writer(output, 25)


def _writer(output, fps):
    from matplotlib import animation

    name, package = ("ffmpeg", "ffmpeg") if output.endswith(".mp4") else ("pillow", "python3-pil")
    if not animation.writers.is_available(name):
        raise InputError(
            f"{output}: nothing here writes such films", ("", 0, 0, "output"),
            f"{name} (Debian: {package}), or a name ending in " + (".gif" if name == "ffmpeg" else ".mp4"),
        )  # fmt: skip
    return animation.writers[name](fps=fps)


def _until(system):
    """Twenty mean flights, or what the system says where there are none."""
    flight = system.mean_flight
    return 20 * flight if numpy.isfinite(flight) and flight > 0 else 20.0


def _hundredth(run):
    """The time of the hundredth hit of the first particle that has so many."""
    times = run.hits["t"]
    many = 100 * len(run.starts)
    return float(times[many]) if len(times) > many else numpy.inf
