"""Tables by their shapes."""

from . import toml
from .errors import path_of
from .system import System, of_keywords


def _shape(shape, **keys):
    return System(toml.section("table", {"shape": shape, **keys}), shape)._checked()


@of_keywords
def rectangle(width=1, height=1) -> System:
    """[0, width] × [0, height] (lengths), with walls bottom, right, top, left."""
    return _shape("rectangle", width=width, height=height)


@of_keywords
def polygon(points) -> System:
    """A polygon through the points, (corners, 2), lengths; walls side_1, side_2, …"""
    return _shape("polygon", points=points)


@of_keywords
def triangle(points) -> System:
    """A triangle with these three points (lengths); walls side_1, side_2, side_3."""
    return _shape("triangle", points=points)


@of_keywords
def regular(sides, radius=1, angle=None) -> System:
    """A regular polygon about the origin; `radius` (length) is that of its corners, `angle` (radians)
    the direction of the first."""
    return _shape("regular", sides=sides, radius=radius, angle=angle)


@of_keywords
def circle(radius=1) -> System:
    """A disc of this radius (length) about the origin, with the wall circle."""
    return _shape("circle", radius=radius)


@of_keywords
def ellipse(a, b) -> System:
    """An ellipse about the origin with semi-axes a along x and b along y (lengths), with the wall
    ellipse."""
    return _shape("ellipse", a=a, b=b)


@of_keywords
def annulus(outer, inner, offset=None) -> System:
    """Between two circles of these radii, the inner one shifted by `offset` along x (lengths); walls
    outer, inner."""
    return _shape("annulus", outer=outer, inner=inner, offset=offset)


@of_keywords
def stadium(half_length=1, radius=1) -> System:
    """Bunimovich's stadium about the origin, straight walls of 2·half_length (lengths); walls
    bottom, right, top, left."""
    return _shape("stadium", half_length=half_length, radius=radius)


@of_keywords
def mushroom(cap_radius, stem_width, stem_height) -> System:
    """Bunimovich's mushroom: cap above y = 0, stem below (lengths)."""
    return _shape("mushroom", cap_radius=cap_radius, stem_width=stem_width, stem_height=stem_height)


@of_keywords
def lemon(radius, separation) -> System:
    """The lens between two circles of one radius whose centres are `separation` apart (lengths)."""
    return _shape("lemon", radius=radius, separation=separation)


@of_keywords
def sinai(side=1, radius=0.25, torus=None) -> System:
    """A disc at the centre of a square [0, side]² (lengths), which is a torus; torus=False: with walls."""
    return _shape("sinai", side=side, radius=radius, torus=torus)


@of_keywords
def lorentz(lattice="triangular", spacing=2.2, radius=1) -> System:
    """The periodic Lorentz gas: one disc per cell of a triangular or square lattice; `spacing` is the
    distance of the centres (lengths)."""
    return _shape("lorentz", lattice=lattice, spacing=spacing, radius=radius)


@of_keywords
def discs(centers, radius=None, radii=None) -> System:
    """Hard discs in the open plane about these centers, (discs, 2), lengths; walls disc_1, disc_2,
    … Starts are on the first disc by the
    cosine law, unless `initial` is given."""
    text = toml.section("table", {"shape": "discs", "centers": centers, "radius": radius, "radii": radii})
    text += toml.section("initial", {"kind": "boundary", "wall": "disc_1"})
    return System(text, "discs")._checked()


@of_keywords
def cardioid(radius=1) -> System:
    """The cardioid r = radius·(1 + cos φ) (length); its cusp is at the origin."""
    return _shape("cardioid", radius=radius)


@of_keywords
def limacon(radius=1, epsilon=0.5) -> System:
    """Pascal's limaçon r = radius·(1 + epsilon·cos φ) (length)."""
    return _shape("limacon", radius=radius, epsilon=epsilon)


@of_keywords
def flower(radius=1, epsilon=0.2, petals=5) -> System:
    """A wavy circle r = radius·(1 + epsilon·cos(petals·φ)) (length)."""
    return _shape("flower", radius=radius, epsilon=epsilon, petals=petals)


@of_keywords
def superellipse(a=1, b=1, exponent=4) -> System:
    """The curve (x/a)ⁿ + (y/b)ⁿ = 1 (lengths), n even."""
    return _shape("superellipse", a=a, b=b, exponent=exponent)


@of_keywords
def robnik(radius=1, lambda_=0.3) -> System:
    """Robnik's billiard: the unit circle mapped by z + λ z², times the radius (length)."""
    return _shape("robnik", radius=radius, **{"lambda": lambda_})


@of_keywords
def egg(a=1.2, b=1, epsilon=0.2) -> System:
    """x = a·cos t, y = b·sin t·(1 + epsilon·cos t) (lengths)."""
    return _shape("egg", a=a, b=b, epsilon=epsilon)


@of_keywords
def polar(radius) -> System:
    """A wall r = radius(φ) about the origin (length), a formula of `phi`: "1 + 0.3*cos(3*phi)"; walls curve_1,
    curve_2, … from the angle 0."""
    return _shape("polar", radius=radius)


@of_keywords
def parametric(x, y, start=None, end=None) -> System:
    """A wall x(t), y(t) (lengths), formulas of `t` from start (0) to end (2π): "2*cos(t)", "sin(t)"."""
    return _shape("parametric", x=x, y=y, **{"from": start, "to": end})


@of_keywords
def implicit(equation, inside=(0, 0)) -> System:
    """The closed curve on which a formula of x and y vanishes (lengths), "x^4 + y^4 - 1": of its curves
    the first to the right of the point `inside`, (2,)."""
    return _shape("implicit", equation=equation, inside=inside)


@of_keywords
def spline(points) -> System:
    """The smooth wall through the points, (points, 2), lengths: a periodic cubic spline."""
    return _shape("spline", points=points)


@of_keywords
def svg(path, scale=None) -> System:
    """A drawing (SVG): its outermost curve is the table, all others are obstacles, with the ids of the drawing as
    names. `scale`: length of the drawing's unit."""
    return _shape("svg", path=path_of(path), scale=scale)


def plane() -> System:
    """The open plane without walls, for obstacles and potentials. Particles start at the origin, unless
    `initial` is given."""
    text = toml.section("table", {"shape": "plane"})
    text += toml.section("initial", {"kind": "point", "position": [0, 0], "velocity": [1, 0]})
    return System(text, "plane")._checked()


def path(*loops) -> System:
    """Own loops of pieces, as [[table.loop]] of a system file describes them."""
    text = toml.section("table", {"shape": "path"})
    for loop in loops:
        text += toml.section("table.loop", loop, True)
    return System(text, "path")._checked()
