#!/usr/bin/env python3
"""Draws the three figures of docs/physics/exactness.md: sides of joints, the walk in a convex table, the line of kappa.

    docs/figures/exactness.py docs/physics/figures
"""
import math
import pathlib
import sys

BLUE, RED, WALL, GREY = "#2a6fbb", "#d1495b", "#1b2a41", "#8d99ae"
SCALE, MARGIN = 150.0, 30.0


class Drawing:
    """A picture with y upwards, in units of the table."""

    def __init__(self, title, width, height, origin):
        self.width, self.height, self.origin = width, height, origin
        self.lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" width="{width:.0f}">',
                      f"<title>{title}</title>", '<rect width="100%" height="100%" fill="white"/>',
                      '<g font-family="sans-serif" font-size="14" fill="none" stroke-linecap="round" stroke-linejoin="round">']

    def at(self, point):
        return (MARGIN + SCALE * (point[0] - self.origin[0]), self.height - MARGIN - SCALE * (point[1] - self.origin[1]))

    def path(self, points, colour, width=1.5, extra=""):
        words = " L ".join("%.1f,%.1f" % self.at(p) for p in points)
        self.lines.append(f'<path d="M {words}" stroke="{colour}" stroke-width="{width}" {extra}/>')

    def dot(self, point, colour, radius=4.5):
        self.lines.append('<circle cx="%.1f" cy="%.1f" r="%.1f" fill="%s"/>' % (*self.at(point), radius, colour))

    def text(self, point, words, colour=WALL, dx=0.0, dy=0.0, anchor="middle"):
        x, y = self.at(point)
        self.lines.append(f'<text x="{x + dx:.1f}" y="{y + dy:.1f}" text-anchor="{anchor}" fill="{colour}">{words}</text>')

    def arrow(self, tip, direction, colour):
        length = math.hypot(*direction)
        d = (direction[0] / length * 0.07, direction[1] / length * 0.07)
        left = (tip[0] - d[0] - 0.5 * d[1], tip[1] - d[1] + 0.5 * d[0])
        right = (tip[0] - d[0] + 0.5 * d[1], tip[1] - d[1] - 0.5 * d[0])
        self.path([left, tip, right], colour, 2)

    def save(self, file):
        file.write_text("\n".join(self.lines + ["</g>", "</svg>"]) + "\n", encoding="utf-8")


def joints(file):
    corners = [(0.3, 0.0), (1.9, 0.0), (2.3, 0.9), (1.5, 1.6), (0.5, 1.5), (0.0, 0.8)]
    start, way = (0.105, 0.52), (1.0, 0.02)
    picture = Drawing("Joints on the left and on the right of a flight", 2 * MARGIN + 3.3 * SCALE, 2 * MARGIN + 1.75 * SCALE, (-0.2, -0.1))
    picture.path(corners + [corners[0]], WALL, 2.5)
    picture.path([(start[0] + t * way[0], start[1] + t * way[1]) for t in (0.0, 2.5)], GREY, 1, 'stroke-dasharray="5 4"')
    hit = start
    for k, a in enumerate(corners):
        b = corners[(k + 1) % len(corners)]
        side = way[0] * (a[1] - start[1]) - way[1] * (a[0] - start[0])
        middle = ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)
        picture.arrow(middle, (b[0] - a[0], b[1] - a[1]), WALL)
        colour = BLUE if side > 0 else RED
        picture.dot(a, colour)
        picture.text(a, "+" if side > 0 else "−", colour, 10 if a[0] > 1 else -10, 16 if a[1] < 0.5 else -8)
        cross = (b[0] - a[0]) * way[1] - (b[1] - a[1]) * way[0]
        t = ((b[0] - a[0]) * (a[1] - start[1]) - (b[1] - a[1]) * (a[0] - start[0])) / cross if cross else -1
        other = way[0] * (b[1] - start[1]) - way[1] * (b[0] - start[0])
        if side < 0 < other and t > 0:
            hit = (start[0] + t * way[0], start[1] + t * way[1])
    picture.path([start, hit], BLUE, 2)
    picture.arrow(hit, way, BLUE)
    picture.dot(start, WALL)
    picture.text(start, "P", WALL, 8, -8)
    picture.text(hit, "− to +: exit", WALL, 14, 22, "start")
    picture.save(file)


def convex(file):
    corners = [(0.2, 0.0), (1.7, 0.0), (2.3, 0.7), (1.9, 1.5), (0.8, 1.7), (0.0, 0.9)]
    count = len(corners)
    start, angle, radius = (1.1, 0.0), 2.35, 0.95
    way = (math.cos(angle), math.sin(angle))
    centre = (start[0] + radius * way[1], start[1] - radius * way[0])           # on the right: clockwise
    first = math.atan2(start[1] - centre[1], start[0] - centre[0])

    def inside(p):
        return all((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > -1e-9
                   for a, b in zip(corners, corners[1:] + corners[:1]))

    arc = []
    for k in range(1, 4000):
        turn = first - k * 0.0015
        p = (centre[0] + radius * math.cos(turn), centre[1] + radius * math.sin(turn))
        if not inside(p):
            break
        arc.append(p)
    hit = arc[-1]
    picture = Drawing("Walk along the walls of a convex table to the exit of a Larmor circle", 2 * MARGIN + 2.9 * SCALE,
                      2 * MARGIN + 2.25 * SCALE, (-0.2, -0.35))
    circle = [(centre[0] + radius * math.cos(0.05 * k), centre[1] + radius * math.sin(0.05 * k)) for k in range(127)]
    picture.path(circle, GREY, 1, 'stroke-dasharray="5 4"')
    picture.path(corners + [corners[0]], WALL, 2.5)
    walk, wall = [start], 0
    while True:                                                                  # backwards, to the exit's wall
        a, b = corners[wall], corners[(wall + 1) % count]
        off = abs((b[0] - a[0]) * (hit[1] - a[1]) - (b[1] - a[1]) * (hit[0] - a[0])) / math.hypot(b[0] - a[0], b[1] - a[1])
        if off < 0.004:
            break
        walk.append(a)
        wall = (wall - 1) % count
    picture.path(walk + [hit], RED, 4, 'opacity="0.75"')
    picture.path([start] + arc[::20] + [hit], BLUE, 2)
    picture.arrow(hit, (hit[0] - arc[-20][0], hit[1] - arc[-20][1]), BLUE)
    picture.arrow(((walk[0][0] + 2 * walk[1][0]) / 3, (walk[0][1] + 2 * walk[1][1]) / 3),
                  (walk[1][0] - walk[0][0], walk[1][1] - walk[0][1]), RED)
    picture.dot(start, WALL)
    picture.dot(hit, BLUE)
    picture.text(start, "P", WALL, 0, 20)
    picture.text(centre, "D", GREY)
    picture.text(hit, "exit", BLUE, 0, -10)
    picture.text(corners[0], "outside D: walk on", RED, -6, 20)
    picture.save(file)


def kappa(file):
    picture = Drawing("The line of kappa: from the start to a full turn", 2 * MARGIN + 4.2 * SCALE, 2 * MARGIN + 0.7 * SCALE, (-2.1, -0.4))
    picture.path([(-2.0, 0.0), (2.0, 0.0)], WALL, 2)
    picture.arrow((-2.0, 0.0), (-1.0, 0.0), WALL)
    for x, above, below in ((1.95, "κ = +∞", "start"), (0.0, "0", "half a turn"), (-1.95, "−∞", "full turn")):
        picture.dot((x, 0.0), WALL, 3)
        picture.text((x, 0.0), above, WALL, 0, -12)
        picture.text((x, 0.0), below, WALL, 0, 24)
    for x, words, colour in ((1.1, "first hit", BLUE), (0.45, "later crossing", GREY), (-1.0, "later crossing", GREY)):
        picture.dot((x, 0.0), colour, 5)
        picture.text((x, 0.0), words, colour, 0, -12)
    picture.text((0.0, -0.3), "time", GREY, 0, 18)
    picture.path([(0.25, -0.3), (-0.25, -0.3)], GREY, 1)
    picture.arrow((-0.25, -0.3), (-1.0, 0.0), GREY)
    picture.save(file)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    joints(folder / "joints.svg")
    convex(folder / "convex.svg")
    kappa(folder / "kappa.svg")
