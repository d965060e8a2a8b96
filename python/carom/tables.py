"""The picture of a table: walls with their names, holes, what is inside, fields and potentials."""

import numpy

from . import _carom
from .axes import COLOURS, legend, new_axes, picture, plain, style_of, title, with_error

WALL = "#222222"
_MATTER = "#e6e4df"  # obstacles
_SPACE = "#fafaf7"  # where particles move
_REGION = "#dfeaf4"  # where they move otherwise
_BESIDE = 7  # points between a wall and its name


@picture
def table(
    system, ax=None, names=True, cells=((0, 0),), levels=True, directions=True, field=True, starts=None, **style
):
    """Walls with the direction of their arc length, holes (dashed, with their names), the sense of
    the field, level lines of the potentials; of a lattice these cells. starts: this many
    trajectories' starts as dots with their directions; None: those that the system lists. style: keywords for
    the walls, such as color and label."""
    made = ax is None
    ax = new_axes(ax)
    loaded = system._loaded("table")
    walls = _carom.walls(loaded)
    style = style_of(style, color=WALL, linewidth=1.2 if len(cells) < 6 else 0.8)
    holes = _holes(walls)
    _walls(loaded, walls, holes, ax, list(cells), style)
    if "label" in style:
        legend(ax)
    if levels and not ax.has_data():  # the open plane
        reach = 1.3 * max(1.0, float(numpy.abs(_carom.starts(loaded, 20)[:, :2]).max(initial=1.0)))
        ax.update_datalim([(-reach, -reach), (reach, reach)])
    if starts is None:
        starts = min(_carom.listed(loaded), 100)
    if starts:
        _starts(_carom.starts(loaded, starts), ax)
    ax.set(aspect="equal", xlabel="$x$", ylabel="$y$")
    title(ax, system)
    make_room(ax, 0.06)
    if levels:
        draw_levels(loaded, ax)
    if field:
        _field(loaded, ax)
    if made:
        fit(ax)
    if directions and len(walls) <= 12:
        for _, pieces, *_ in walls:
            if pieces:
                arrow(ax, max(pieces, key=len), style["color"])
    if names:
        labels = [(name, *_middle(line), COLOURS[1]) for name, line in holes]
        if len(walls) <= 12:
            for name, pieces, *_ in walls:
                if pieces:
                    labels.append((name, *_middle(max(pieces, key=len)), "0.4"))
        texts = _labels(ax, labels)
        for _ in texts[:2]:  # twice: names are wider in a picture that shows more
            _include(ax, texts)
            if made:
                fit(ax)
    return ax


def _holes(walls):
    """Names and lines of the holes; one that runs on over several walls is one line."""
    pieces = {}
    for _, _, holes, _ in walls:
        for name, piece in holes:
            pieces.setdefault(name, []).append(piece)
    return [(name, line) for name, parts in pieces.items() for line in _joined(parts)]


def _joined(pieces):
    """Lines, put together of pieces that begin where others end."""
    closed, open_ = [], []
    for piece in pieces:
        line, apart = [piece], []
        for other in open_:
            if _same(other[-1][-1], line[0][0]):
                line = other + line
            elif _same(line[-1][-1], other[0][0]):
                line = line + other
            else:
                apart.append(other)
        done = _same(line[0][0], line[-1][-1])
        (closed if done else apart).append(line)
        open_ = apart
    return [numpy.concatenate(line) for line in closed + open_]


def _walls(loaded, walls, holes, ax, cells, style):
    """Walls and holes over what is inside. Of a lattice each cell, with what reaches into it from its neighbours."""
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    edges = _carom.cell(loaded)
    loops = _filled(_carom.parts(loaded))
    lines = [
        (line, entered)
        for entered in (False, True)
        for line in _joined([piece for _, pieces, _, passed in walls if passed == entered for piece in pieces])
    ]
    around = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)] if edges else [(0, 0)]
    near = {(a + i, b + j) for a, b in cells for i, j in around}
    shown = None
    if edges:
        (outline,) = _loops(edges)
        outlines = [outline + shift for shift in _carom.translations(loaded, cells)]
        shown = Path.make_compound_path(*(Path(line, closed=True) for line in outlines))
        shown = PathPatch(shown, facecolor=_SPACE, edgecolor="0.7", linewidth=0.6, linestyle=":", zorder=0.1)
        ax.add_patch(shown)
        ax.update_datalim(numpy.concatenate(outlines))
    reach = numpy.concatenate(outlines) if shown else None
    for shift in _carom.translations(loaded, sorted(near)):
        drawn = []
        for loop, colour in loops:
            if not shown or _touch(loop + shift, reach):
                path = Path(loop + shift, closed=True)
                drawn.append(ax.add_patch(PathPatch(path, linewidth=0, zorder=0.2, facecolor=colour)))
        for line, entered in lines:
            if shown and not _touch(line + shift, reach):
                continue
            usual = {"zorder": 3, "solid_capstyle": "round"} | style
            if entered:  # no wall: particles pass
                usual |= {"linewidth": 0.5 * style["linewidth"], "linestyle": (0, (6, 1.5))}
            drawn += ax.plot(*(line + shift).T, **usual)
            style = {key: one for key, one in style.items() if key != "label"}
        for _, line in holes:
            hole = {"color": COLOURS[1], "linewidth": 1.4, "linestyle": (0, (2, 1.5))}
            drawn += ax.plot(*(line + shift).T, zorder=3, **hole)
        if shown:
            for one in drawn:
                one.set_clip_path(shown)
    if shown:
        ax.relim()
        ax.dataLim.set_points(numpy.stack([f(numpy.concatenate(outlines), axis=0) for f in (numpy.min, numpy.max)]))
        ax.autoscale_view()


def _filled(parts):
    """Closed lines and the colour within: of the parts of a table, smaller ones later."""
    loops = []
    for number, part in enumerate(parts):
        for loop in _loops(part):
            inside = _area(loop) > 0  # walls run with the table on their left
            loops.append((loop, (_REGION if number else _SPACE) if inside else _MATTER))
    # An obstacle that is a region is both, and is shown as the region.
    return sorted(loops, key=lambda one: (-float(f"{abs(_area(one[0])):.9g}"), one[1] == _REGION))


def _touch(points, others):
    """Do the upright rectangles around points and others overlap?"""
    return (points.min(axis=0) <= others.max(axis=0)).all() and (points.max(axis=0) >= others.min(axis=0)).all()


def _loops(pieces):
    """Closed lines, put together of pieces that begin where others end; what does not close is left out."""
    left = list(pieces)
    loops = []
    while left:
        line = [left.pop(0)]
        while left and not _same(line[0][0], line[-1][-1]):
            gaps = [numpy.hypot(*(piece[0] - line[-1][-1])) for piece in left]
            line.append(left.pop(int(numpy.argmin(gaps))))
        points = numpy.concatenate(line)
        if _same(points[0], points[-1]):
            loops.append(points)
    return loops


def _same(a, b):
    return numpy.allclose(a, b, rtol=1e-9, atol=1e-9)


def _area(loop):
    x, y = loop.T
    return 0.5 * float(numpy.dot(x, numpy.roll(y, -1)) - numpy.dot(numpy.roll(x, -1), y))


def _at(points, share):
    """The point of a line after this share of its length."""
    steps = numpy.hypot(*numpy.diff(points, axis=0).T)
    along = numpy.concatenate([[0.0], numpy.cumsum(steps)])
    where = share * along[-1]
    return numpy.array([numpy.interp(where, along, points[:, i]) for i in (0, 1)])


def _middle(piece):
    """The middle of a piece of wall, and the direction away from the table there."""
    along = _at(piece, 0.51) - _at(piece, 0.49)
    return _at(piece, 0.5), numpy.array([along[1], -along[0]]) / numpy.hypot(*along)


def make_room(ax, share):
    """Room around what is drawn, equally wide on all sides."""
    if not numpy.isfinite(ax.dataLim.get_points()).all():
        return
    (left, low), (right, high) = ax.dataLim.get_points()
    room = share * max(right - left, high - low) or 0.5
    ax.set(xlim=(left - room, right + room), ylim=(low - room, high + room))


def fit(ax):
    """A figure as high as its table, with ticks at whole, half and fifth steps."""
    ax.locator_params(steps=[1, 2, 5, 10])
    width, height = numpy.diff(ax.get_xlim())[0], numpy.diff(ax.get_ylim())[0]
    lines = ax.get_title().count("\n")
    ax.figure.set_size_inches(5.0, float(numpy.clip(0.95 + 0.17 * lines + 4.2 * height / width, 1.4, 6.5)))


def arrow(ax, points, colour, share=0.75, size=11):
    """The direction of a line, at this share of its length."""
    tip, foot = _at(points, share + 0.01), _at(points, share - 0.01)
    style = {"arrowstyle": "-|>", "color": colour, "linewidth": 0, "mutation_scale": size, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", tip, foot, arrowprops=style, zorder=4)


def _field(loaded, ax):
    """The sense in which particles turn and how fast, with the circle of the first start if it has room."""
    omegas = sorted({omega for omega in _carom.omegas(loaded) if omega})
    if not omegas:
        return
    sense = "clockwise" if omegas[0] > 0 else "counter-clockwise"
    sense = sense if omegas[0] * omegas[-1] > 0 else "both ways"
    text = f"ω = {' … '.join(with_error(omega, None, 4) for omega in omegas[:: max(1, len(omegas) - 1)])}, {sense}"
    speed = float(numpy.hypot(*_carom.starts(loaded, 1)[0, 2:]))
    radius = speed / abs(omegas[0])
    low, high = ax.get_ylim()
    same = omegas[-1] in (omegas[0], -omegas[0])
    text += f", Larmor radius {with_error(radius, None)}" if same else ""
    if same and numpy.isfinite(radius) and 2 * radius < 0.5 * (high - low):
        from matplotlib.offsetbox import AnchoredOffsetbox, AuxTransformBox
        from matplotlib.patches import Circle

        box = AuxTransformBox(ax.transData)
        box.add_artist(Circle((0.0, 0.0), radius, fill=False, edgecolor="0.45", linewidth=0.8))
        beside = {"bbox_to_anchor": (1.0, 0.0), "bbox_transform": ax.transAxes, "pad": 0.4, "frameon": False}
        ax.add_artist(AnchoredOffsetbox("lower left", child=box, **beside))
    ax.set_title("\n".join(filter(None, (ax.get_title(), text))), fontsize=9)


def _starts(rows, ax):
    ax.quiver(
        *rows.T, color=COLOURS[0], angles="xy", pivot="tail", width=0.004, scale=28, zorder=4, alpha=0.8
    )
    ax.plot(rows[:, 0], rows[:, 1], "o", color=COLOURS[0], markersize=2.5, zorder=4)


def _labels(ax, labels):
    """Names beside their walls, outside; where that covers another name inside, and where that does too nothing."""
    figure = ax.get_figure()
    figure.draw_without_rendering()
    renderer = figure.canvas.get_renderer()
    kept, texts = [], []
    for name, at, away, colour in labels[:40]:
        for side in (1, -1):
            text = _label(ax, name, at, side * away, colour)
            box = text.get_window_extent(renderer).expanded(1.05, 1.1)
            if not any(box.overlaps(other) for other in kept):
                kept.append(box)
                texts.append(text)
                break
            text.remove()
    return texts


def _include(ax, texts):
    """No name lies on the axes: the picture becomes larger by what is outside, and a little, since it shrinks."""
    ax.figure.draw_without_rendering()
    corners = numpy.array([text.get_window_extent().padded(4).get_points() for text in texts])
    inside = ax.transData.inverted()
    (left, low), (right, high) = inside.transform([corners[:, 0].min(axis=0), corners[:, 1].max(axis=0)])
    (a, b), (c, d) = ax.get_xlim(), ax.get_ylim()
    ax.set(
        xlim=(a - 1.2 * max(0.0, a - left), b + 1.2 * max(0.0, right - b)),
        ylim=(c - 1.2 * max(0.0, c - low), d + 1.2 * max(0.0, high - d)),
    )


def _label(ax, name, at, away, colour):
    across = "center" if abs(away[0]) < 0.4 else "left" if away[0] > 0 else "right"
    up = "center" if abs(away[1]) < 0.4 else "bottom" if away[1] > 0 else "top"
    return ax.annotate(
        plain(name), at, xytext=tuple(0.6 * _BESIDE * away), textcoords="offset points", color=colour,
        fontsize="x-small", ha=across, va=up, zorder=5,
    )  # fmt: skip


def draw_levels(loaded, ax):
    """Level lines of the potential energy."""
    low_x, high_x = ax.get_xlim()
    low_y, high_y = ax.get_ylim()
    xs, ys = numpy.linspace(low_x, high_x, 201), numpy.linspace(low_y, high_y, 201)
    energies = _carom.potential(loaded, list(xs), list(ys))
    if energies is None or not numpy.isfinite(energies).any():
        return
    finite = energies[numpy.isfinite(energies)]
    levels = numpy.unique(numpy.quantile(finite, numpy.linspace(0.05, 0.95, 8)))
    if len(levels) > 1:
        ax.contour(xs, ys, energies, levels=levels, colors="0.75", linewidths=0.5, zorder=0.5)
        ax.set(xlim=(low_x, high_x), ylim=(low_y, high_y))
