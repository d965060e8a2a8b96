#!/usr/bin/env python3
"""Checks that the sources keep the rules of the tables below: dependencies, packages, lengths, format, one version.

    structure.py includes | umbrella | names | libm | imports | length | format | headers | version | paragraphs  [ROOT]

Prints one line for each fault; the exit status is then 1.
"""
import ast
import graphlib
import os
import pathlib
import platform
import re
import shutil
import subprocess
import sys

# Modules that a module may include besides itself and base/; dependencies of dependencies do not count. Certified orbits test
# the engine, so certify/ includes nothing of events/. `analyses` is what an analysis of analyses/ may see, besides itself and
# those of OTHER_ANALYSES; its command and its report belong to the program, cli.
ENGINE = ["events", "forces", "geometry", "integrators", "lanes", "motion", "table"]
DEPENDENCIES = {
    "base": [],
    "geometry": [],
    "table": ["forces", "geometry"],
    "motion": ["geometry"],
    "forces": ["geometry", "motion"],
    "integrators": ["geometry"],
    "events": ["forces", "geometry", "integrators", "motion", "table"],
    "certify": ["geometry", "motion", "table"],
    "orbits": ["events", "geometry", "motion", "table"],
    "lanes": ["events", "forces", "geometry", "integrators", "motion", "table"],
    "system": ["events", "geometry", "motion", "table"],
    "results": ["events", "lanes", "motion", "system"],
    "starts": ["events", "forces", "geometry", "motion", "results", "system", "table"],
    "engines": [*ENGINE, "results", "starts", "system"],
    "trust": ["certify", "events", "geometry", "motion", "system", "table"],
    "files": [*ENGINE, "certify", "engines", "results", "starts", "system", "trust"],
    "analyses": [*ENGINE, "certify", "engines", "files", "orbits", "results", "starts", "system", "trust"],
    "validation": ["analyses", "engines", "events", "files", "integrators", "orbits", "results", "starts", "system"],
    "cli": ["analyses", "certify", "engines", "events", "files", "geometry", "integrators", "lanes", "orbits", "results", "starts", "system",
            "table", "validation"],
    "python": ["analyses", "certify", "cli", "engines", "events", "files", "forces", "geometry", "motion", "orbits", "results", "starts",
               "system", "table", "trust", "validation"],
}
# Analyses that an analysis may see, with the reason.
OTHER_ANALYSES = {
    "splitting": ["escape"],                 # it counts survivors, and fits their decay by the same laws
    "lyapunov": ["splitting"],               # the repeller of an open table is what splitting keeps alive
    "orbits": ["run"],                       # close returns are looked for along a run
}
# Files for all analyses: the list of kinds, the functions of the program, which all of them may see.
ALL_ANALYSES = {"kinds", "all", "checks"}
# The list of kinds, for templates that are made once for each: their files name no single one.
KINDS = ("files", "include/carom/analyses/kinds.hpp")
# The closed-form maps of the tests check the engine, so they share nothing with it.
CLOSED_MAPS = "tests/maps/closed"
MAPS_MAY_INCLUDE = {"maps/closed/maps.hpp", "carom/base/error.hpp"}
# Generated into the build folder: header and its module.
GENERATED = {"carom_version.hpp": "base"}
UMBRELLA = "include/carom/carom.hpp"

# Where a package may be included: pattern of the header, pattern of the file.
PACKAGES = {
    r"CGAL/": r"geometry/src/cgal/",
    r"boost/": r"geometry/src/|src/base/|src/forces/quad\.hpp",
    r"gmp|mpfr": r"geometry/src/|src/base/|src/table/|src/certify/|src/files/svg/",
    r"(arb|acb|arf|mag)(_\w+)?\.h|flint": r"src/certify/",
    r"gsl/": r"src/analyses/relax/|src/orbits/",
    r"Random123/": r"src/base/random\.cpp",
    r"fast_float/": r"src/base/decimal\.cpp",
    r"toml\+\+/|hdf5": r"src/files/",
    r"zlib|isa-l/": r"src/files/hdf5/(deflate|sums)\.cpp",
    r"CLI/": r"src/cli/(options\.cpp|option_faults\.cpp|command_list\.cpp|command_options\.hpp)",
    r"hwy/": r"src/lanes/simd/",
    r"pybind11|Python\.h": r"python/src/",
    r"omp\.h": r"src/engines/|src/analyses/|validation/cases/",
    r"mpi\.h": r"src/cli/mpi_ranks\.cpp",
    r"sundials|arkode/|cvode/|nvector/|sunlinsol/|sunnonlinsol/": r"src/integrators/",
}
# C++ files in which states, times and random numbers are made, and what is stored in archives of ensembles, which
# are compared bit by bit; base/elementary.cpp is the door.
LIBM_FREE = (
    r"include/carom/|geometry/|src/(base|certify|table|motion|forces|integrators|events|lanes|orbits|system|results|starts|engines)/"
    r"|src/analyses/\w+/(?!report|command)"
)
# What makes these functions the same everywhere: right rounding behind the first ones, Boost behind the last.
DOORS = ("src/base/elementary.cpp", "src/base/elementary_exact.cpp", "src/base/elementary_exact.hpp", "src/base/elementary_fast.hpp",
         "src/base/elementary_spans.cpp", "src/base/kernel/elementary_kernel.cpp", "include/carom/base/elementary.hpp",
         "src/forces/quad.hpp")
LIBM = (
    "sin cos tan asin acos atan atan2 sinh cosh tanh asinh acosh atanh exp exp2 expm1 log log2 log10 log1p "
    "pow hypot cbrt erf erfc tgamma lgamma sincos ellint_1 ellint_2 ellint_3 comp_ellint_1 comp_ellint_2 "
    "comp_ellint_3 polar"
).split()
LONG, TOO_LONG = 400, 500

INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]', re.M)


def without_comments(text, strings=True):
    """Blanks comments, and strings too unless asked otherwise; line numbers stay."""
    token = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', re.S)

    def blank(match):
        found = match.group()
        return re.sub(r"[^\n]", " ", found) if strings or found.startswith("/") else found

    # An apostrophe between digits groups them and opens nothing.
    return token.sub(blank, re.sub(r"(?<=[0-9a-fA-F])'(?=[0-9a-fA-F])", "0", text))


def sources(root):
    """(path relative to root, text) of every C++ file of the library and the program."""
    for folder in ("include", "geometry", "src", "validation/cases", "python/src"):
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in (".cpp", ".hpp"):
                yield path.relative_to(root).as_posix(), path.read_text(encoding="utf-8")


def analysis_of(path):
    """The analysis that a file belongs to, or None."""
    match = re.match(r"(?:src|include/carom)/analyses/(\w+)", path)
    return match.group(1) if match and match.group(1) not in ALL_ANALYSES else None


def module_of(path):
    if path.startswith("geometry/"):
        return "geometry"
    if re.match(r"src/analyses/\w+/(command|report)", path):
        return "cli"
    match = re.match(r"(?:src/|include/carom/|(?=validation/|python/))(\w+)/", path)
    return match.group(1) if match else None


def included_file(root, path, header):
    """The path of a quoted header relative to root, or None."""
    here = (root / path).parent
    for folder in (here, root / "include", root / "geometry/include", root / "src", root / "geometry/src", root):
        found = (folder / header).resolve()
        if found.is_file() and found.is_relative_to(root.resolve()):
            return found.relative_to(root.resolve()).as_posix()
    return None


def included_module(root, path, header):
    """The module of a quoted header, or None."""
    if header in GENERATED:
        return GENERATED[header]
    found = included_file(root, path, header)
    return module_of(found) if found else None


def check_cycles(module, seen=()):
    """The declared dependencies have no cycle."""
    if module in seen:
        raise SystemExit(f"the declared dependencies have a cycle: {' -> '.join([*seen, module])}")
    for other in DEPENDENCIES[module] + ["base"] * (module != "base"):
        check_cycles(other, (*seen, module))


def check_includes(root):
    for module in DEPENDENCIES:
        check_cycles(module)
    for path, text in sources(root):
        module = module_of(path)
        public = "include/" in path
        code = without_comments(text, strings=False)
        for match in INCLUDE.finditer(code):
            quoted, header = match.group(1) == '"', match.group(2)
            place = f"{path}:{code.count(chr(10), 0, match.start(2)) + 1}"
            for package, home in PACKAGES.items():
                if re.match(package, header) and not re.match(home, path):
                    yield f"{place}: <{header}> belongs in {home}"
            if public and re.search(r"[./]", header) and not header.startswith("carom/"):
                yield f"{place}: a public header includes only the standard library and carom/, not {header}"
            if not quoted:
                if header.startswith("carom/"):
                    yield f'{place}: write "{header}" inside the project'
                continue
            if path == UMBRELLA:
                continue
            target = included_module(root, path, header)
            if module not in DEPENDENCIES:
                yield f"{place}: no module is declared as '{module}'"
            elif target is None:
                yield f"{place}: no such header in the project: {header}"
            elif target not in (module, "base", *DEPENDENCIES[module]) and (module, included_file(root, path, header)) != KINDS:
                yield f"{place}: {module}/ must not include {target}/ ({header})"
            elif analysis := analysis_of(path):
                other = analysis_of(included_file(root, path, header) or "")
                if other not in (None, analysis, *OTHER_ANALYSES.get(analysis, [])):
                    yield f"{place}: analyses/{analysis} must not include analyses/{other} ({header})"
    for path in sorted((root / CLOSED_MAPS).glob("*.?pp")):
        for quote, header in INCLUDE.findall(without_comments(path.read_text(encoding="utf-8"), strings=False)):
            if quote == '"' and header not in MAPS_MAY_INCLUDE:
                yield f"{CLOSED_MAPS}/{path.name}: the maps include nothing of the project but base/error.hpp, not {header}"
    # Examples see what users see: an installed library.
    for path in sorted((root / "examples").glob("*.cpp")):
        for match in INCLUDE.finditer(without_comments(path.read_text(encoding="utf-8"), strings=False)):
            if match.group(1) == '"' or (re.search("[./]", match.group(2)) and not match.group(2).startswith("carom/")):
                yield f"examples/{path.name}: only <carom/…> and the standard library, not {match.group(2)}"


def check_umbrella(root):
    """Every public header comes with UMBRELLA."""
    reached, ahead = set(), [UMBRELLA]
    while ahead:
        path = ahead.pop()
        if path in reached or not (root / path).is_file():
            continue
        reached.add(path)
        code = without_comments((root / path).read_text(encoding="utf-8"), strings=False)
        ahead += [f"include/{header}" for _, header in INCLUDE.findall(code) if header.startswith("carom/")]
    for path, _ in sources(root):
        if path.startswith("include/") and path not in reached:
            yield f"{path} is not part of {UMBRELLA}"


# Names of internal headers in another namespace than their module's, with the reason.
FOREIGN_NAMES = {
    ("src/trust/exact_hit.hpp", "sin_cos"): "certify/ finds it by its argument, carom::Twofold",
}


def check_names(root):
    """Headers of src/MODULE declare their names in carom::MODULE; public names stay in carom."""
    # What may stand elsewhere: forward declarations, nested classes and specialisations of public classes.
    allowed = re.compile(r"(?:template|class|struct|enum class) ?(?:<.*>|[\w:]+ : [\w:]+;|\w+;|\w+::\w+ (?:: .*)?\{|\w+<.*> \{)$")
    for path, text in sources(root):
        module = module_of(path)
        if not path.startswith(("src/", "geometry/src/")) or not path.endswith(".hpp"):
            continue
        inside = None
        for number, line in enumerate(without_comments(text).splitlines(), 1):
            line = line.rstrip()
            opened = re.match(r"namespace (carom[\w:]*) \{$", line)
            if opened:
                inside = opened.group(1)
            elif re.match(r"using namespace\b", line):
                yield f"{path}:{number}: no using-directive in a header"
            elif inside and re.match(r"\w", line) and inside.split("::")[1:2] != [module]:
                name = re.search(r"(\w+) ?(?:[({=;]|$)", line)
                if not allowed.match(line) and (path, name and name.group(1)) not in FOREIGN_NAMES:
                    yield f"{path}:{number}: internal names of {module}/ belong in namespace carom::{module}, not {inside}"


def check_libm(root):
    call = re.compile(r"(?<![\w.>])(?<!elementary::)(?:std::|::)?\b(" + "|".join(LIBM) + r")[fl]?\s*\(")
    for path, text in sources(root):
        if not re.match(LIBM_FREE, path) or path in DOORS:
            continue
        code = without_comments(text)
        for match in call.finditer(code):
            if path.startswith("src/certify/") and match.group(1) in ("exp2", "log2"):
                continue  # numbers of bits, which balls make right or more
            line = code.count("\n", 0, match.start(1)) + 1
            yield f"{path}:{line}: {match.group(1)} of libm; base/elementary.hpp is the door"


def check_length(root):
    paths = [path for folder in ("include", "geometry", "src", "python", "tests", "examples", "validation", "docs")
             for path in (root / folder).rglob("*") if path.suffix in (".cpp", ".hpp", ".py")]
    for path in sorted(paths):
        lines = len(path.read_text(encoding="utf-8").splitlines())
        name = path.relative_to(root).as_posix()
        if lines > TOO_LONG:
            yield f"{name}: {lines} lines; more than {TOO_LONG} are two files"
        elif lines > LONG:
            print(f"{name}: {lines} lines (long)")


def check_format(root):
    """Every file as clang-format writes it: the version that Debian has, since versions differ."""
    program = shutil.which("clang-format-14")
    if not program:
        print("clang-format-14 is not installed; ./dev test installs it")
        raise SystemExit(SKIPPED)
    files = [path for folder in ("include", "geometry", "src", "python", "tests", "examples", "validation")
             for path in sorted((root / folder).rglob("*.?pp"))]
    found = subprocess.run([program, "--dry-run", "--ferror-limit=1", *map(str, files)], capture_output=True, text=True,
                           check=True).stderr
    for path, line in re.findall(r"^(\S+?):(\d+):\d+: warning", found, re.M):
        yield f"{pathlib.Path(path).relative_to(root).as_posix()}:{line}: clang-format-14 -i FILE writes it otherwise"


def check_headers(root):
    """Every header of lanes compiles alone: kernels are read, and checked by tools, one header at a time."""
    narrowest = ["-mssse3"] if platform.machine() in ("x86_64", "AMD64") else []  # as carom_kernels(baseline)
    flags = ["-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", *narrowest, "-x", "c++", "-"]
    folders = [f"-I{root / folder}" for folder in ("src", "include", "geometry/include")]
    for path in sorted((root / "src/lanes").rglob("*.hpp")):
        name = path.relative_to(root / "src").as_posix()
        done = subprocess.run([os.environ.get("CXX", "c++"), *folders, *flags], input=f'#include "{name}"\n',
                              capture_output=True, text=True)
        if done.returncode or done.stderr:
            yield f"src/{name} does not compile alone: {(done.stderr.splitlines() or [''])[-1]}"


# Files that name the version of Carom, and how. CMakeLists.txt is the one that the program and the packages take it from.
VERSIONS = {
    "CMakeLists.txt": r"^project\(carom VERSION (\S+)",
    "CITATION.cff": r"^version: (\S+)",
    "pyproject.toml": r'^version = "(\S+)"',
    "CHANGELOG.md": r"^## \[(\S+)\]",  # the first heading is the newest version
}


def check_version(root):
    """All files name the same version."""
    found = {}
    for name, pattern in VERSIONS.items():
        match = re.search(pattern, (root / name).read_text(encoding="utf-8"), re.M)
        found[name] = match.group(1) if match else None
    for name, version in found.items():
        if version is None or version != found["CMakeLists.txt"]:
            yield f"{name} names version {version}, CMakeLists.txt {found['CMakeLists.txt']}"


def check_imports(root):
    """The modules of the Python package import each other in one direction, inside functions too."""
    package = root / "python/carom"
    imports = {}
    for path in sorted(package.glob("*.py")):
        if path.stem in ("__init__", "picture"):  # the package's names, and what is run with them
            continue
        tree = ast.parse(path.read_text(encoding="utf-8"))
        named = {node.module or alias.name for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) and node.level
                 for alias in node.names}
        imports[path.stem] = sorted(name for name in named if (package / f"{name}.py").exists())
    try:
        graphlib.TopologicalSorter(imports).prepare()
    except graphlib.CycleError as circle:
        yield "python/carom: a circle of imports: " + " imports ".join(reversed(circle.args[1]))


LONG_PARAGRAPH = 600


def check_paragraphs(root):
    """No paragraph, item of a list or row of a table of README and the guide is long: characters, without links' targets."""
    for path in [root / "README.md", *sorted((root / "docs/guide").rglob("*.md"))]:
        text = re.sub(r"^```.*?^```", lambda code: re.sub(r".", "", code[0]), path.read_text(encoding="utf-8"), flags=re.M | re.S)
        begin = 0
        for part in re.split(r"(\n\s*\n|\n(?=\||- |#))", text):
            length = len(re.sub(r"\]\([^)]*\)", "", part))
            if length > LONG_PARAGRAPH:
                line = text.count("\n", 0, begin) + 1
                yield f"{path.relative_to(root).as_posix()}:{line}: {length} characters; at most {LONG_PARAGRAPH}"
            begin += len(part)


SKIPPED = 77
CHECKS = {"includes": check_includes, "umbrella": check_umbrella, "names": check_names, "libm": check_libm, "imports": check_imports, "length": check_length,
          "format": check_format, "headers": check_headers, "version": check_version, "paragraphs": check_paragraphs}


def main(arguments):
    if not arguments or arguments[0] not in CHECKS:
        raise SystemExit(__doc__)
    root = pathlib.Path(arguments[1] if len(arguments) > 1 else pathlib.Path(__file__).parents[2])
    if not any(sources(root)):
        raise SystemExit(f"no sources in {root}")
    faults = list(CHECKS[arguments[0]](root))
    print("\n".join(faults) if faults else "no faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
