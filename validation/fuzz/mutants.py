"""Mutated system files: where they come from, what is changed in them, and the command that each is given to.

A case is a function of a seed and an index, and of the sources: the built-in systems, the TOML blocks of the guide, and
systems put together from the pieces below.
"""
import json
import pathlib
import random
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
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
rim: shape = "path"; [[table.loop]]; center = [0.2, 0]; radius = 1; name = "rim"
wall_1: shape = "path"; [[table.loop]]; start = ["1/4", "1/4"]; pieces = [{line_to = ["1/4", "3/4"]}, {line_to = ["3/4", "1/4"]}, {line_to = ["1/4", "1/4"]}]; [lattice]; vectors = [[1, 0], ["1/2", "sqrt(3)/2"]]
"""
HOLES = """
center = 0.5; width = 0.2
center = 0.3; width = "1/10"; name = "hole_1"
"""
OBSTACLES = """
shape = "circle"; center = [0.6, "1/3"]; radius = 0.1
shape = "ellipse"; center = [0.5, 0.5]; a = 0.2; b = 0.05; angle = "pi/6"; name = "blade"
shape = "polygon"; points = [[0.4, 0.4], [0.6, 0.4], ["1/2", "3/5"]]
shape = "path"; start = [0.4, 0.4]; pieces = [{line_to = [0.4, 0.6]}, {bezier = [[0.5, 0.7], [0.6, 0.4]]}, {arc_via = [0.5, 0.35], arc_to = [0.4, 0.4]}]
shape = "polar"; center = [0.5, 0.4]; radius = "0.1 + 0.02*cos(3*phi)"
shape = "spline"; points = [[0.4, 0.4], [0.6, 0.4], [0.6, 0.5], [0.4, 0.6]]
shape = "circle"; center = [0.3, 0.3]; radius = 0.1; [[table.obstacle]]; shape = "circle"; center = [0.5, 0.3]; radius = 0.1
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
    if wall and "[lattice]" not in table and chance.random() < 0.2:
        parts.append(f"[[table.obstacle]]\n{chance.choice(pieces(OBSTACLES))}")
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
    listed = subprocess.run([program, "systems", "--json"], capture_output=True, text=True, check=True).stdout
    names = [system["name"] for system in json.loads(listed)["systems"]]
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


ALL_PIECES = "\n".join((TABLES, OBSTACLES, HOLES, FIELDS, POTENTIALS, INTERACTIONS, PARTICLES, STARTS, INTEGRATORS, INJECTIONS, RUNS, SECTIONS))


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


def deep(chance, sections):
    """Dotted keys, headers, lists and tables of many levels."""
    levels = chance.choice((3, 60, 70, 300, 20000))
    section = chance.choice(sections)
    section.insert(chance.randrange(len(section)) + 1, chance.choice((
        "a" + ".a" * levels + " = 1", "[a" + ".a" * levels + "]", "a = " + "[" * levels + "]" * levels,
        "a = " + "{a = " * levels + "1" + "}" * levels, "a = " + "[{a.b.c = " * levels)))


def hostile_text(chance, sections):
    """Titles and names that act on terminals, break XML or are formulas."""
    replace_one(chance, sections, STRING, lambda _: '"' + chance.choice((
        r"\u001b]0;a\u0007", r"\u009b31m", "\u202ea", "$$", r"$\\frac{$", r"\u0000", r"\n\nlost: 1", "<b>&amp;", r"\U0001F600")) + '"')


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


def section_of_another(chance, sections, donor, rough):
    given = chance.choice(split(donor))
    same = [i for i, s in enumerate(sections) if s[0] == given[0]]
    if same and (not rough or chance.random() < 0.5):
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
# leave four systems in ten acceptable, so that they fly; rough ones are for the reader of files.
GENTLE = ((plausible_extreme, 25), (scaled_number, 40), (other_word_of_its_kind, 10), (changed_expression, 6), (other_integrator, 8), (dropped_key, 4))
ROUGH = ((extreme_number, 30), (scaled_number, 10), (other_word, 8), (broken_string, 8), (dropped_key, 5), (doubled_key, 2),
         (moved_key, 4), (doubled_section, 3), (dropped_section, 2), (changed_list, 6), (number_to_list, 3), (deep, 2), (hostile_text, 2))


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
    flying = [text for text in systems if "[table]" in text or "[[potential]]" in text]  # the guide has parts of systems, too
    sections = split(chance.choice(flying) if chance.random() < 0.4 else composed(chance))
    rough = chance.random() < 0.3
    for _ in range(chance.choice((1, 1, 1, 1, 2, 2, 2, 3, 3, 4, 6))):
        if chance.random() < 0.1:
            section_of_another(chance, sections, chance.choice(systems) if chance.random() < 0.4 else composed(chance), rough)
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
        if chance.random() < (0.2 if b"step = " in data else 0.02):
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
