#!/usr/bin/env python3
"""Feeds mutated system files to the program and judges how it ends.

    validation/fuzz/fuzz.py --count 1000
    validation/fuzz/fuzz.py --from 712 --count 1          # case 712 alone, again
    validation/fuzz/fuzz.py --count 100 --silence 20      # also: a line of progress within 20 s

A case is a function of --seed and its index (and of the built-in systems and the guide, which are its sources): a
system file that was good is changed in one to six places and given to one command with a small load. After --seconds
the program gets SIGTERM and must end. Cases that are not fine are kept in --keep: INDEX.toml is the file, INDEX.txt
the verdict, the command and what the program said. Exit status 1 if there is one.

Verdicts
  fine      status 0; 1 with a message that names a place; 2; 3 with a reason; 130 or SIGTERM after the signal
  crash     another signal or status, "terminate called", a report of a sanitizer
  internal  "internal error": a promise inside the program was broken
  lost      a trajectory was lost: an error of the engine
  null      status 0 and no number for x, y, vx, vy or t of a run that is completed, or in a point of a section
  deaf      it goes on for more than PATIENCE seconds after SIGTERM
  silent    with --silence: no line of progress for so long
  memory    it holds more than 2 GB, or asks for more than 4 GB
  place     status 1, and the message names neither a file, a line, a key nor an option
  output    no valid JSON with status 0 or 3, something on standard output with status 1, or 3 without a reason

Busy machines: a program that waits for a processor is not deaf. The kernel counts that time (/proc/PID/schedstat), and
it is taken off. Builds with sanitizers (--sanitized) reserve addresses without end and are slow: there is no
limit of memory, and patience is ten times as long.
"""
import argparse
import collections
import json
import multiprocessing
import os
import pathlib
import pty
import random
import re
import resource
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
PATIENCE = 2.0                 # seconds between SIGTERM and the end
MOST_MEMORY = 2 << 30          # bytes that a program may hold
MOST_ADDRESSES = 4 << 30       # bytes that it may ask for
COMMANDS = ("run", "escape", "diffusion", "section", "table")

# ---- sources ----------------------------------------------------------------------------------------------------

# Pieces that are put together to systems: one of each list, some of them left out. A table is preceded by the name of
# one of its walls, which holes and starts then use.
TABLES = """
bottom: shape = "rectangle"; width = 2; height = 1
side_1: shape = "polygon"; points = [[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]]
side_1: shape = "triangle"; points = [[0, 0], [1, 0], ["1/3", "sqrt(3)/2"]]
side_2: shape = "regular"; sides = 7; radius = 1; angle = "pi/7"
circle: shape = "circle"; radius = 1
ellipse: shape = "ellipse"; a = 1; b = "3/4"
outer: shape = "annulus"; outer = 1; inner = 0.4; offset = 0.3
right: shape = "stadium"; half_length = 1; radius = 1
stem_bottom: shape = "mushroom"; cap_radius = 1; stem_width = 0.6; stem_height = 1
right: shape = "lemon"; radius = 1; separation = 1
disc: shape = "sinai"; side = 1; radius = 0.3; torus = false
disc: shape = "sinai"; side = 1; radius = 0.3
disc_1: shape = "lorentz"; lattice = "triangular"; spacing = 2.2; radius = 1
disc_2: shape = "discs"; centers = [[0, 0], [6, 0], [3, "3*sqrt(3)"]]; radii = [1, 1, 2]
disc_1: shape = "discs"; centers = [[0, 0], [0.5, 0.3]]; radius = 0.2; [lattice]; vectors = [[1, 0], [0, 1.5]]
disc_3: shape = "discs"; path = "scatterers.csv"; [lattice]; vectors = [[100, 0], [0, 100]]
disc_5: shape = "random-discs"; side = 30; radius = 1; count = 60; seed = 3
left: shape = "random-discs"; side = 30; radius = 0.5; count = 40; torus = false
floor: shape = "path"; [[table.loop]]; start = [-1, 0]; pieces = [{line_to = [1, 0], name = "floor"}, {arc_via = [0, 1], arc_to = [-1, 0]}]
wall_3: shape = "path"; [[table.loop]]; start = [-2, -2]; pieces = [{line_to = [2, -2]}, {line_to = [2, 2]}, {ellipse_via = [0, 3], ellipse_to = [-2, 2], ellipse_ratio = "1/2", ellipse_angle = 0}, {line_to = [-2, -2]}]; [[table.loop]]; start = [0.5, 0]; pieces = [{arc_via = [0, -0.5], arc_to = [-0.5, 0]}, {arc_via = [0, 0.5], arc_to = [0.5, 0]}]
wall_1: shape = "path"; [[table.loop]]; start = ["1/4", "1/4"]; pieces = [{line_to = ["1/4", "3/4"]}, {line_to = ["3/4", "1/4"]}, {line_to = ["1/4", "1/4"]}]; [lattice]; vectors = [[1, 0], ["1/2", "sqrt(3)/2"]]
"""
HOLES = """
center = 0.5; width = 0.2
center = 0.3; width = "1/10"; name = "hole_1"
"""
FIELDS = """
B = 0.5
B = "-3/2"
larmor_radius = 0.7
"""
POTENTIALS = """
kind = "fermi"; height = 2; radius = 0.15; softness = 0.1; center = [0.3, 0.4]
kind = "fermi"; radius = 0.25; softness = 0.03; lattice = true; [lattice]; vectors = [[1, 0], ["1/2", "sqrt(3)/2"]]
kind = "gaussian"; height = -1; width = 0.1; centers = [[0.2, 0.2], [0.6, 0.3]]
kind = "gaussian"; height = 0.3; width = 0.2; lattice = true; [lattice]; vectors = [[1, 0], [0, 1]]
kind = "harmonic"; omega = "sqrt(2)"
kind = "harmonic"; omega_x = 1; omega_y = 0.7
kind = "quartic"; strength = 2
kind = "power"; strength = 1; exponent = 3
kind = "coulomb"; charge = 0.1; center = [0.5, 0.5]
kind = "henon-heiles"
kind = "linear"; force = [0, -1]
kind = "soft-circle"; height = 5; radius = 1; softness = 0.05
kind = "soft-stadium"; height = 5; radius = 1; half_length = 1; softness = 0.05
kind = "expression"; expression = "k*(x^2 + y^2)/2 + a*x^4"; parameters = {k = 2, a = "1/10"}
kind = "expression"; expression = "50*exp(-((x-1)^2+(y-1)^2)/(2*0.03^2))"
kind = "expression"; expression = "sin(3*x)*cos(y) + log(1 + x^2) - 1/(1 + y^2)"
kind = "expression"; expression = "tanh(x/w) + sqrt(x^2 + y^2 + 1) + abs(y)"; parameters = {w = 0.2}
"""
INTERACTIONS = """
kind = "coulomb"; strength = 1
kind = "yukawa"; strength = 1; range = 0.5
kind = "lennard-jones"; depth = 1; diameter = 0.1
kind = "soft-sphere"; strength = 1; diameter = 0.1; exponent = 12
kind = "hard-discs"; radius = 0.05
kind = "hard-discs"; radii = [0.05, 0.02, 0.1]
kind = "expression"; expression = "q*exp(-r)/r"; parameters = {q = 0.3}
kind = "expression"; expression = "1/r^12 - 1/r^6"
"""
PARTICLES = """
speed = 1
speed = [1, 2, 0.5]
energy = 0.5
energy = 2; mass = 2; charge = -1
count = 3; speed = 1
count = 3; energy = 12
count = 3; speed = 1; mass = [1, 2, 3]; charge = [1, 0, 2]
"""
STARTS = """
kind = "uniform"
kind = "boundary"
kind = "point"; position = [0.05, "1/30"]; velocity = [1, 0.3]
kind = "point"; position = [0.7, 0.2]; angle = "pi/5"
kind = "rectangle"; min = [0, 0]; max = [1, 1]
kind = "line"; from = [0.1, 0.1]; to = [0.9, 0.2]; angle = 0.3
kind = "list"; starts = [[0.1, 0.1, 1, 0], [0.5, 0.2, 0, 1], [0.7, 0.1, 0.6, "4/5"]]
kind = "file"; path = "starts.txt"
kind = "boundary"; wall = "WALL"
kind = "birkhoff"; wall = "WALL"; s = [0.1, 0.2]; v_parallel = [0, 0.5]
kind = "birkhoff"; wall = "WALL"; s = {from = 0, to = 0.3, count = 3}; v_parallel = {from = "-1/2", to = "1/2", count = 2}
kind = "hole"; hole = "hole_1"
"""
INTEGRATORS = """
step = 0.02
step = 0.5; unresolved = "count"
scheme = "arkode"
scheme = "cvode"; tolerance = 1e-9
scheme = "velocity-verlet"; step = 0.01
scheme = "velocity-verlet"; step = 0.01; walls = "split"
step = 0.01; energy_tolerance = 1e-6
"""
INJECTIONS = """
hole = "hole_1"; rate = 0.5; speed = 2
hole = "hole_1"; times = [0, 0.5, 1]
"""
RUNS = """
t_max = 10
t_max = 100; trajectories = 10; sample = 0.5
t_max = 5; collisions = 20; seed = 7
t_max = 10; times = {from = 0.1, to = 10, count = 5}
t_max = 10; times = [0, 1, 2.5, 10]; window = [1, 10]
t_max = 10; times = {from = 0, to = 10, count = 4, spacing = "linear"}; trust_tolerance = 1e-6
"""
SECTIONS = """
on = "boundary"; points = 20
on = "line:0,0:1,1/3"; direction = "positive"
on = "circle:0,0,1/2"; orbits = 2
on = "vx=sqrt(2)/2"
on = "x=0.25"; direction = "negative"
"""
FILES = {"scatterers.csv": "0, 0, 1\n5 5 2\n# a comment\n-20, 30, 0.5\n", "starts.txt": "0.1 0.2 1 0\n0.3, 0.4, 0, 1\n"}


def pieces(text):
    """The lines of a list of pieces, each as lines of TOML."""
    return [line.replace("; ", "\n") for line in text.strip().split("\n")]


def composed(chance):
    """A system put together from the pieces above."""
    wall, table = chance.choice(pieces(TABLES)).split(": ", 1)
    potential, interaction = chance.choices((("", ""), ("p", ""), ("", "i"), ("p", "i")), (45, 30, 15, 10))[0]
    potential = potential and chance.choice(pieces(POTENTIALS))
    interaction = interaction and chance.choice(pieces(INTERACTIONS))
    if "[lattice]" in potential or (potential and chance.random() < 0.4):
        wall = table = ""
    parts = [f"[table]\n{table}"] if table else []
    hole = wall and "[lattice]" not in table and chance.random() < 0.4
    if hole:
        parts.append(f'[[table.hole]]\nwall = "{wall}"\n{chance.choice(pieces(HOLES))}')
    if chance.random() < 0.25:
        parts.append(f"[field]\n{chance.choice(pieces(FIELDS))}")
    if potential:
        parts.append(f"[[potential]]\n{potential}")
    if interaction:
        parts.append(f"[interaction]\n{interaction}")
        parts.append(f"[particles]\n{chance.choice(pieces(PARTICLES)[4:])}")
    elif chance.random() < 0.4:
        parts.append(f"[particles]\n{chance.choice(pieces(PARTICLES))}")
    starts = pieces(STARTS)[0 if wall else 2:12 if hole else 11 if wall else 8]
    parts.append(f"[initial]\n{chance.choice(starts + starts[:2] * 3)}".replace("WALL", wall))
    if potential or interaction:
        if chance.random() < 0.8:
            parts.append(f"[integrator]\n{chance.choice(pieces(INTEGRATORS))}")
    elif hole and chance.random() < 0.3:
        parts.append(f"[[injection]]\n{chance.choice(pieces(INJECTIONS))}")
    parts.append(f"[run]\n{chance.choice(pieces(RUNS))}")
    if chance.random() < 0.1:
        parts.append(f"[section]\n{chance.choice(pieces(SECTIONS))}")
    return "\n".join(parts) + "\n"


def whole_systems(program):
    """The built-in systems and the TOML blocks of the guide."""
    listed = subprocess.run([program, "systems"], capture_output=True, text=True, check=True).stdout
    names = [line.split()[0] for line in listed.splitlines()[1:]]
    texts = [subprocess.run([program, "systems", name], capture_output=True, text=True, check=True).stdout for name in names]
    for page in sorted((ROOT / "docs" / "guide").glob("*.md")):
        texts += re.findall(r"```toml\n(.*?)```", page.read_text(), re.DOTALL)
    return texts


# ---- mutations --------------------------------------------------------------------------------------------------

EXTREMES = """0 -1 -0.0 1 2 1e-300 1e300 1e29 1e30 1e-21 1e-30 1e-9 1e-6 1e6 1e9 1e12 1e59 5e-324 5e-101 1.2e11 0.9999999999999999
9007199254740993 18446744073709551616 -9223372036854775809 2147483648 0x10 nan inf -inf true [] {} "" "nan" "1/3" "-1/3"
"1/0" "sqrt(3)/2" "sqrt(-1)" "pi" "1e400" "1/1000000000000000000000001" "sqrt(2)-sqrt(2)" "10^100" "2^0.5" "45_deg" """.split()  # _: a blank
WORDS = """top caps cap brim_left stem_bottom inner outer side_3 disc_2 hole_2 square log linear stop split reflect positive boundary
fermi gaussian harmonic coulomb expression power yukawa soft-sphere hard-discs uniform point birkhoff list file rectangle discs circle
path velocity-verlet x=0 starts.txt r^2 x*y""".split()
FUNCTIONS = "sin cos tan exp log sqrt abs tanh sinh cosh atan2 min max pow erf".split()
NUMBER = r'(?<![\w."+-])[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?![\w."])'
STRING = r'"[^"\n]*"'


def split(text):
    """Sections as lists of lines: the header (none above all sections), then a key and its whole value a line."""
    sections, open_brackets = [[""]], 0
    for line in text.splitlines():
        line = re.match(r'(?:"[^"]*"|[^#"])*', line).group().strip()
        if not line:
            continue
        if open_brackets:
            sections[-1][-1] += " " + line
        elif re.fullmatch(r"\[\[?[\w.]+\]?\]", line):
            sections.append([line])
        else:
            sections[-1].append(line)
        bare = re.sub(STRING, "", sections[-1][-1])
        open_brackets = bare.count("[") + bare.count("{") - bare.count("]") - bare.count("}") if "=" in bare else 0
    return sections


def joined(sections):
    return "\n".join(line for section in sections for line in section if line) + "\n"


ALL_PIECES = "\n".join((TABLES, HOLES, FIELDS, POTENTIALS, INTERACTIONS, PARTICLES, STARTS, INTEGRATORS, INJECTIONS, RUNS, SECTIONS))


def replace_one(chance, sections, pattern, new):
    """Replaces one match of `pattern`, in a value, by what `new` makes of it."""
    matches = [(section, row, m) for section in sections for row in range(1, len(section))
               for m in re.finditer(pattern, section[row]) if m.start() > section[row].find("=")]
    if not matches:
        return
    section, row, m = chance.choice(matches)
    section[row] = section[row][:m.start()] + new(m.group()) + section[row][m.end():]


def any_line(chance, sections):
    """A section and the number of a line in it that is no header."""
    filled = [s for s in sections if len(s) > 1]
    section = chance.choice(filled) if filled else sections[0]
    return section, chance.randrange(1, len(section)) if len(section) > 1 else 0


def extreme_number(chance, sections):
    replace_one(chance, sections, f"{NUMBER}|{STRING}" if chance.random() < 0.3 else NUMBER, lambda _: chance.choice(EXTREMES))


def scaled_number(chance, sections):
    def scaled(number):
        factor = chance.choice((0.5, 2, -1, 1 + 1e-15, 10.0 ** chance.randint(-14, 14), chance.random() * 3))
        value = float(number) * factor
        whole = re.fullmatch(r"[-+]?\d+", number) and abs(value) < 1e15
        return str(int(value)) if whole and value == int(value) else repr(value)
    replace_one(chance, sections, NUMBER, scaled)


def other_word(chance, sections):
    replace_one(chance, sections, STRING, lambda _: '"' + chance.choice(WORDS) + '"')


def broken_string(chance, sections):
    def broken(string):
        inside, at = string[1:-1], chance.randrange(len(string) - 1)
        way = chance.randrange(7)
        if way == 0:
            return string[:-1]                                                     # no closing quote
        if way == 1:
            return '"' + inside[:at] + inside[at + 1:] + '"'                       # a character less
        if way == 2:
            return '"' + inside[:at] + chance.choice("+-*/^().,eExyr \\é0π\u202e") + inside[at:] + '"'
        if way == 3:
            return '"' + inside * chance.choice((2, 50, 5000)) + '"'
        if way == 4:
            return '"' + "(" * chance.choice((1, 100, 100000)) + inside + '"'
        if way == 5:
            return '"' + chance.choice(FUNCTIONS) + "(" + inside + ")" + chance.choice(("", "/x", "^0.5", "^1e9", "-r")) + '"'
        return '"' + inside + chance.choice(("/0", "*1e300", "^-1", "^50", "+1e-300", "/(x-x)")) + '"'
    replace_one(chance, sections, STRING, broken)


def dropped_key(chance, sections):
    section, row = any_line(chance, sections)
    if row:
        del section[row]


def doubled_key(chance, sections):
    section, row = any_line(chance, sections)
    if row:
        section.append(section[row])


def moved_key(chance, sections):
    section, row = any_line(chance, sections)
    other = chance.choice(sections)
    if row:
        other.append(section[row] if chance.random() < 0.3 else section.pop(row))


def section_of_another(chance, sections, donor):
    given = chance.choice(split(donor))
    same = [i for i, s in enumerate(sections) if s[0] == given[0]]
    if same and chance.random() < 0.7:
        sections[same[0]] = list(given)
    else:
        sections.append(list(given))


def doubled_section(chance, sections):
    copied = list(chance.choice(sections))
    if chance.random() < 0.5:
        copied[0] = f"[{copied[0]}]" if not copied[0].startswith("[[") else copied[0][1:-1]
    sections.append(copied)


def dropped_section(chance, sections):
    if len(sections) > 1:
        del sections[chance.randrange(1, len(sections))]


def changed_list(chance, sections):
    def changed(items):
        inside = items[1:-1]
        way = chance.randrange(5)
        if way == 0:
            return "[]"
        if way == 1:
            return "[" + ", ".join([inside] * chance.choice((2, 3, 1000))) + "]"
        if way == 2:
            return "[" + ", ".join(inside.split(", ")[:-1]) + "]"
        if way == 3:
            return inside
        return f"[{items}]"
    replace_one(chance, sections, r"\[[^\[\]]*\]" if chance.random() < 0.6 else r"\[.*\]", changed)


def number_to_list(chance, sections):
    replace_one(chance, sections, NUMBER, lambda n: chance.choice((f"[{n}]", f"[{n}, {n}]", f"{{from = 0, to = {n}, count = 3}}", f'"{n}"', f'"{n}/3"')))


def other_integrator(chance, sections):
    kept = [s for s in sections if s[0] != "[integrator]"]
    sections[:] = kept + [["[integrator]"] + chance.choice(pieces(INTEGRATORS)).split("\n")] if chance.random() < 0.8 else kept


def plausible_extreme(chance, sections):
    """An extreme that a system may well accept."""
    replace_one(chance, sections, NUMBER, lambda n: chance.choice(
        "0 1 -1 2 3 1e-3 1e-6 1e-9 1e-12 1e-21 1e-29 1e3 1e6 1e9 1e12 1e21 1e29 1e50 0.9999999999999999 1.0000000000000002".split()
        if "." in n else ("0", "1", "2", "3", "7", "100", "1000", "100000", "1e6", "1e9", "-1")))


def other_word_of_its_kind(chance, sections):
    """A kind, shape, scheme, wall or text that the same key has in another piece."""
    section, row = any_line(chance, sections)
    key = section[row].split(" =")[0].strip() if row else ""
    known = re.findall(rf'\b{re.escape(key)} = ("[^"]*")', ALL_PIECES) if key else []
    if known and '"' in section[row]:
        section[row] = f"{key} = {chance.choice(known)}"


def changed_expression(chance, sections):
    for section in sections:
        for row, line in enumerate(section):
            if line.startswith("expression"):
                inside = re.findall(STRING, line)[0][1:-1] if re.search(STRING, line) else "x"
                section[row] = 'expression = "' + chance.choice((
                    f"{chance.choice(FUNCTIONS)}({inside})", f"({inside})^{chance.choice(('2', '-1', '0.5', '50', '1e9'))}",
                    f"({inside})*{chance.choice(('1e300', '1e-300', '0', '-1', '1e6', '1e20'))}", f"({inside})/(x-x)", f"1/({inside})",
                    inside.replace("2", chance.choice(("3", "20", "0", "-2", "1e-9"))), inside.replace("x", "y"), inside.replace("r", "(r-0.3)"),
                    f"({inside}) + sin(1e6*x)", f"({inside}) + abs(x)/x", f"exp(exp({inside}))", " + ".join([inside] * 60))) + '"'
                return
    plausible_extreme(chance, sections)


# What is tried more often has more weight; section_of_another is apart, for it needs a second source. Gentle mutations
# leave many systems acceptable, so that they fly; the rough ones are for the reader of files.
GENTLE = ((plausible_extreme, 25), (scaled_number, 40), (other_word_of_its_kind, 10), (changed_expression, 6), (other_integrator, 8), (dropped_key, 4))
ROUGH = ((extreme_number, 30), (scaled_number, 10), (other_word, 8), (broken_string, 8), (dropped_key, 5), (doubled_key, 2),
         (moved_key, 4), (doubled_section, 3), (dropped_section, 2), (changed_list, 6), (number_to_list, 3))


def flipped(chance, data):
    """Some bytes of the finished file, changed."""
    data = bytearray(data)
    for _ in range(chance.choice((1, 1, 3, 20))):
        at = chance.randrange(len(data))
        way = chance.randrange(4)
        if way == 0:
            data[at] ^= 1 << chance.randrange(8)
        elif way == 1:
            data[at] = chance.randrange(256)
        elif way == 2:
            data[at:at + chance.choice((1, 40))] = b""
        else:
            data[at:at] = data[at:at + 30]
        if not data:
            return b""
    return bytes(data)


def make_case(seed, index, systems):
    """The system file as bytes, and the command's arguments before and after its name."""
    chance = random.Random(f"carom fuzz {seed} {index}")
    source = lambda: chance.choice(systems) if chance.random() < 0.45 else composed(chance)
    sections = split(source())
    rough = chance.random() < 0.3
    for _ in range(chance.choice((1, 1, 1, 1, 2, 2, 2, 3, 3, 4, 6))):
        if chance.random() < 0.1:
            section_of_another(chance, sections, source())
        else:
            kinds = ROUGH if rough else GENTLE
            mutate, = chance.choices([m for m, _ in kinds], [weight for _, weight in kinds])
            mutate(chance, sections)
    data = joined(sections).replace("45_deg", "45 deg").encode()
    if rough and chance.random() < 0.2 and data:
        data = flipped(chance, data)

    command, = chance.choices(COMMANDS, (40, 22, 15, 15, 8))
    options = ["--json"]
    if command != "table":
        options += ["--threads", chance.choice("1112")]
        if chance.random() < 0.3:
            options += ["--t-max", "1"]
        if chance.random() < 0.15:
            options += ["--engine", "steps"]
        if chance.random() < 0.1:
            options += ["--collisions", chance.choice(("1", "30"))]
        if chance.random() < 0.1:
            options += ["-o", "out.h5"]
    elif chance.random() < 0.5:
        options += ["-o", "out.svg", "--force"]
    if command in ("escape", "diffusion"):
        options += ["--trajectories", "3"]
        if chance.random() < 0.15:
            options += ["--isa", "baseline"]
        if command == "escape" and "-o" in options and chance.random() < 0.3:
            options += ["--per-trajectory"]
    if command == "section":
        options += ["--orbits", "3", "--points", "50"]
        if chance.random() < 0.4:
            options += ["--on", chance.choice(("x=0", "y=1/3", "vx=0", "line:0,0:1,1", "circle:0,0,1/2", "segment:0,0:1,1/7", "wall:bottom"))]
    if command == "run" and chance.random() < 0.08:
        options += ["--precision", chance.choice(("certified", "certified", "200")), "--collisions", "30"]
        if options[-3] == "certified":
            options += ["--digits", "10"]
    return data, command, options


# ---- running ----------------------------------------------------------------------------------------------------

def waited(pid):
    """Seconds that the threads of a process have waited for a processor: the longest of them, by thread."""
    times = {}
    try:
        for thread in os.listdir(f"/proc/{pid}/task"):
            with open(f"/proc/{pid}/task/{thread}/schedstat") as file:
                times[thread] = int(file.read().split()[1]) * 1e-9
    except (OSError, IndexError):
        pass
    return times


class Ended:
    """How a program ended: code as of subprocess (negative: a signal), memory in bytes, and the texts."""
    code = memory = None
    out = said = ""
    stopped = deaf = silent = False
    seconds = 0.0


def run(arguments, folder, limits):
    ended = Ended()
    terminal, far_end = pty.openpty() if limits.silence else (None, None)
    with open(folder / "stdout", "w+b") as out, open(folder / "stderr", "w+b") as said:
        environment = dict(os.environ, ASAN_OPTIONS="detect_leaks=0:allocator_may_return_null=0:max_allocation_size_mb=4096",
                           UBSAN_OPTIONS="print_stacktrace=1")

        def restrict():
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 30, 1 << 30))
            if not limits.sanitized:
                resource.setrlimit(resource.RLIMIT_AS, (MOST_ADDRESSES, MOST_ADDRESSES))

        begin = time.monotonic()
        process = subprocess.Popen(arguments, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=out,
                                   stderr=far_end if terminal else said, preexec_fn=restrict)
        if terminal:
            os.close(far_end)
        watch = select.poll()
        handle = os.pidfd_open(process.pid)
        watch.register(handle, select.POLLIN)
        if terminal:
            watch.register(terminal, select.POLLIN)
        heard, signalled, waits, written = begin, None, {}, b""
        while True:
            ready = {descriptor for descriptor, _ in watch.poll(100)}
            if terminal in ready:
                try:
                    written += os.read(terminal, 65536)
                    heard = time.monotonic()
                except OSError:  # the program closed its end
                    watch.unregister(terminal)
            if handle in ready:
                break
            now = time.monotonic()
            if terminal and signalled is None and now - heard > limits.silence:
                ended.silent = True
            patient = terminal and heard == begin and not ended.silent  # it may still say its first line
            if signalled is None and now - begin > limits.seconds and not patient:
                waits, signalled = waited(process.pid), now
                os.kill(process.pid, signal.SIGTERM)
                ended.stopped = True
            elif signalled is not None:
                queue = max([seconds - waits.get(thread, 0.0) for thread, seconds in waited(process.pid).items()], default=0.0)
                if now - signalled - queue > limits.patience:
                    ended.deaf = True
                    process.kill()
                    break
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = ended.code = os.waitstatus_to_exitcode(status)
        ended.seconds, ended.memory = time.monotonic() - begin, usage.ru_maxrss * 1024
        os.close(handle)
        out.seek(0)
        said.seek(0)
        ended.out = out.read(50_000_000).decode(errors="replace")
        ended.said = (said.read(1_000_000) + written).decode(errors="replace")
    if terminal:
        os.close(terminal)
    return ended


# ---- judging ----------------------------------------------------------------------------------------------------

PLACE = re.compile(r"carom: [\w.\[\]]+: |fuzz\.toml|line \d+|command line|--[a-z]|\b[a-z_]+(\[\d+\])?\.[a-z_]+|scatterers\.csv|starts\.txt|out\.h5|out\.svg")
SANITIZER = re.compile(r"AddressSanitizer|runtime error:|UndefinedBehaviorSanitizer|LeakSanitizer")


def values_of(node, keys):
    """What JSON has under these keys, at any depth."""
    if isinstance(node, dict):
        for key, value in node.items():
            if key in keys:
                yield value
            yield from values_of(value, keys)
    elif isinstance(node, list):
        for value in node:
            yield from values_of(value, keys)


def holds_null(node):
    if isinstance(node, list):
        return any(holds_null(value) for value in node)
    if isinstance(node, dict):
        return any(holds_null(value) for value in node.values())
    return node is None or node in ("nan", "inf", "-inf")


def judge(ended, command, limits):
    """The verdict and a word on it."""
    last = ended.said.strip().splitlines()[-1] if ended.said.strip() else ""
    if "allocation-size-too-big" in ended.said or "out of memory" in ended.said:
        return "memory", last
    if SANITIZER.search(ended.said) or "terminate called" in ended.said:
        return "crash", SANITIZER.search(ended.said + "\n") and next(s for s in ended.said.splitlines() if SANITIZER.search(s)) or last
    if ended.deaf:
        return "deaf", f"after {ended.seconds:.1f} s"
    if ended.silent:
        return "silent", f"after {ended.seconds:.1f} s"
    if ended.memory > MOST_MEMORY and not limits.sanitized:
        return "memory", f"{ended.memory / 2**30:.1f} GB"
    if "internal error" in ended.said:
        return "internal", last
    if ended.code == -signal.SIGTERM and ended.stopped or ended.code == 2:
        return "fine", ""
    if ended.code not in (0, 1, 3, 130) or ended.code == 130 and not ended.stopped:
        return "crash", f"status {ended.code} {last}"
    if ended.code == 1:
        if ended.out:
            return "output", "something on standard output with status 1"
        return ("fine", "") if PLACE.search(ended.said) else ("place", last)
    if ended.code == 130 and not ended.out:
        return "fine", ""
    try:
        report = json.loads(ended.out)
    except ValueError as error:
        return "output", f"no JSON: {error}"
    if any(isinstance(n, int) and n > 0 for n in values_of(report, {"lost"})) or "lost" in values_of(report, {"status"}):
        return "lost", last
    if ended.code == 0:
        if command == "run" and report.get("status") == "completed" and holds_null(list(values_of(report, {"x", "y", "vx", "vy", "t"}))):
            return "null", "completed"
        if command == "section" and holds_null(report.get("points")):
            return "null", "in a point"
    if ended.code == 3 and not ended.said.strip() and "reason" not in ended.out:
        told = [n for n in values_of(report, {"unresolved", "unresolved_steps"}) if n]
        if not told and "unresolved" not in values_of(report, {"status"}) and not list(values_of(report, {"energy_error", "energy_tolerance"})):
            return "output", "status 3 without a reason"
    return "fine", ""


# ---- the whole --------------------------------------------------------------------------------------------------

def one_case(index):
    data, command, options = make_case(SETTINGS.seed, index, SYSTEMS)
    arguments = [SETTINGS.program, command, "fuzz.toml"] + options + ([] if SETTINGS.silence else ["--quiet"])
    folder = pathlib.Path(tempfile.mkdtemp(prefix="carom-fuzz-"))
    try:
        for name, text in FILES.items():
            (folder / name).write_text(text)
        (folder / "fuzz.toml").write_bytes(data)
        ended = run(arguments, folder, SETTINGS)
        verdict, why = judge(ended, command, SETTINGS)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    if verdict != "fine":
        kept = pathlib.Path(SETTINGS.keep)
        (kept / f"{index}.toml").write_bytes(data)
        (kept / f"{index}.txt").write_text(
            f"verdict: {verdict} ({why})\ncommand: {' '.join(arguments).replace('fuzz.toml', f'./{index}.toml')}\n"
            f"status {ended.code} after {ended.seconds:.1f} s, {ended.memory / 2**20:.0f} MB\n"
            f"--- standard error\n{ended.said[:20000]}\n--- standard output\n{ended.out[:20000]}\n")
    return index, command, verdict, why, "stopped" if ended.stopped else str(ended.code)


def main():
    global SETTINGS, SYSTEMS
    parser = argparse.ArgumentParser(description="Mutated system files for the program.")
    parser.add_argument("--program", default=str(ROOT / "build/release/carom"))
    parser.add_argument("--count", type=int, default=1000, help="number of cases")
    parser.add_argument("--from", type=int, default=0, dest="first", help="index of the first")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1, help="cases at a time")
    parser.add_argument("--seconds", type=float, default=1.5, help="when SIGTERM is sent")
    parser.add_argument("--silence", type=float, default=0.0, help="standard error is a terminal, and the program must not say nothing for so many seconds")
    parser.add_argument("--sanitized", action="store_true", help="a build with sanitizers")
    parser.add_argument("--keep", default="fuzz-findings", help="folder for what is not fine")
    parser.add_argument("--show", action="store_true", help="print the files and commands instead of running them")
    SETTINGS = parser.parse_args()
    SETTINGS.program = str(pathlib.Path(SETTINGS.program).resolve())
    SETTINGS.patience = PATIENCE * (10 if SETTINGS.sanitized else 1)
    SYSTEMS = whole_systems(SETTINGS.program)
    indices = range(SETTINGS.first, SETTINGS.first + SETTINGS.count)
    if SETTINGS.show:
        for index in indices:
            data, command, options = make_case(SETTINGS.seed, index, SYSTEMS)
            print(f"# case {index}: carom {command} fuzz.toml {' '.join(options)}\n{data.decode(errors='replace')}")
        return 0
    os.makedirs(SETTINGS.keep, exist_ok=True)
    verdicts, ends = collections.Counter(), collections.Counter()
    with multiprocessing.get_context("fork").Pool(SETTINGS.jobs) as pool:
        for index, command, verdict, why, end in pool.imap_unordered(one_case, indices):
            verdicts[verdict] += 1
            ends[end] += 1
            if verdict != "fine":
                print(f"{index:7} {command:9} {verdict:8} {why[:160]}", flush=True)
            if sum(ends.values()) % 500 == 0:
                print(f"# {sum(ends.values())} cases: {dict(verdicts.most_common())}", file=sys.stderr, flush=True)
    print(f"{sum(ends.values())} cases, seed {SETTINGS.seed}: " + ", ".join(f"{n} {v}" for v, n in verdicts.most_common()))
    print("ends: " + ", ".join(f"{n} with {'SIGTERM' if e == 'stopped' else 'status ' + e}" for e, n in ends.most_common()))
    return 0 if set(verdicts) <= {"fine"} else 1


if __name__ == "__main__":
    sys.exit(main())
