#!/usr/bin/env python3
"""Each fault below is put into a small tree of its own, and structure.py must find it."""
import pathlib
import shutil
import tempfile
import unittest

import structure


def faults(check, files):
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        base = {"include/carom/base/error.hpp": "#pragma once\n", "include/carom/table/table.hpp": "#pragma once\n",
                "include/carom/events/world.hpp": "#pragma once\n", "src/motion/flight.hpp": "#pragma once\n",
                "src/files/value.hpp": "#pragma once\n", "src/cli/tables.hpp": "#pragma once\n",
                "src/analyses/escape/law.hpp": "#pragma once\n", "include/carom/analyses/splitting.hpp": "#pragma once\n", "validation/cases/cases.hpp": "#pragma once\n"}
        for name, text in {**base, **files}.items():
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return list(structure.CHECKS[check](root))


class Includes(unittest.TestCase):
    def legal(self, path, line):
        self.assertEqual(faults("includes", {path: line + "\n"}), [])

    def illegal(self, path, line):
        self.assertEqual(len(faults("includes", {path: "// first\n" + line + "\n"})), 1, line)

    def test_dependencies(self):
        self.legal("src/events/world.cpp", '#include "carom/table/table.hpp"')
        self.legal("src/cli/run.cpp", '#include "files/value.hpp"')
        self.illegal("src/table/build.cpp", '#include "carom/events/world.hpp"')
        self.illegal("src/events/world.cpp", '#include "files/value.hpp"')
        self.illegal("geometry/src/curve.cpp", '#include "carom/table/table.hpp"')
        self.illegal("src/attic/old.cpp", '#include "carom/base/error.hpp"')
        self.illegal("src/table/build.cpp", '#include "nowhere.hpp"')
        self.illegal("src/certify/wall.cpp", '#include "carom/events/world.hpp"')
        self.legal("src/cli/validate.cpp", '#include "validation/cases/cases.hpp"')
        self.illegal("src/files/value.cpp", '#include "validation/cases/cases.hpp"')
        self.illegal("validation/cases/cases.cpp", '#include "carom/table/table.hpp"')

    def test_dependencies_are_direct(self):
        self.legal("src/events/world.cpp", '#include "motion/flight.hpp"')
        self.illegal("src/certify/value.cpp", '#include "files/value.hpp"')

    def test_analyses_see_their_own(self):
        self.legal("src/analyses/escape/decay.cpp", '#include "analyses/escape/law.hpp"')
        self.legal("src/analyses/lyapunov/repeller.cpp", '#include "carom/analyses/splitting.hpp"')
        self.illegal("src/analyses/escape/decay.cpp", '#include "carom/analyses/splitting.hpp"')
        self.illegal("src/analyses/escape/report.cpp", '#include "carom/analyses/splitting.hpp"')
        self.illegal("src/files/value.cpp", '#include "carom/analyses/splitting.hpp"')

    def test_reports_and_commands_are_the_programs(self):
        self.legal("src/analyses/escape/report.cpp", '#include "cli/tables.hpp"')
        self.illegal("src/analyses/escape/decay.cpp", '#include "cli/tables.hpp"')

    def test_maps_are_a_witness(self):
        self.legal("tests/maps/closed/disc.cpp", '#include "carom/base/error.hpp"')
        self.illegal("tests/maps/closed/disc.cpp", '#include "carom/table/table.hpp"')

    def test_packages_stay_at_home(self):
        self.legal("geometry/src/cgal/root.cpp", "#include <CGAL/Gmpq.h>")
        self.illegal("geometry/src/curve.cpp", "#include <CGAL/Gmpq.h>")
        self.illegal("src/table/build.cpp", "#include <toml++/toml.h>")
        self.illegal("src/cli/run.cpp", "#include <hdf5.h>")
        self.illegal("src/cli/run.cpp", "#include <CLI/App.hpp>")
        self.illegal("src/events/world.cpp", "#include <gmpxx.h>")

    def test_public_headers_are_plain(self):
        self.legal("include/carom/table/walls.hpp", "#include <vector>")
        self.illegal("include/carom/table/walls.hpp", "#include <fmt/format.h>")

    def test_examples_see_what_users_see(self):
        self.legal("examples/mine.cpp", "#include <carom/carom.hpp>\n#include <cstdio>")
        self.illegal("examples/mine.cpp", '#include "events/flight/next_hit.hpp"')
        self.illegal("examples/mine.cpp", "#include <fmt/core.h>")

    def test_comments_do_not_count(self):
        self.legal("src/table/build.cpp", '// #include "carom/events/world.hpp"')
        self.legal("src/table/build.cpp", '/*\n#include "carom/events/world.hpp"\n*/')


class Umbrella(unittest.TestCase):
    def test_public_headers_come_with_it(self):
        world = '#include "carom/table/table.hpp"\n#include "carom/base/error.hpp"\n#include "carom/analyses/splitting.hpp"\n'
        files = {"include/carom/events/world.hpp": world,
                 "include/carom/carom.hpp": '#include "carom/events/world.hpp"\n'}
        self.assertEqual(faults("umbrella", files), [])
        files["include/carom/motion/tangent.hpp"] = "#pragma once\n"
        self.assertEqual(len(faults("umbrella", files)), 1)


class Names(unittest.TestCase):
    def count(self, namespace, text, path="src/motion/contact.hpp"):
        return len(faults("names", {path: f"namespace {namespace} {{\n\n{text}\n\n}}  // namespace {namespace}\n"}))

    def test_internal_names_in_plain_carom_are_found(self):
        for text in ("struct Ahead {", "double angle(double x);", "using Pair = double[2];", "namespace detail {",
                     "inline constexpr int most = 3;", "template <class Real>\nReal area(Real r) {", "enum class Kind {"):
            self.assertEqual(self.count("carom", text), 1, text)
            self.assertEqual(self.count("carom::events", text), 1, text)
            self.assertEqual(self.count("carom::motion", text), 0, text)
            self.assertEqual(self.count("carom", text, "src/motion/contact.cpp"), 0, text)
            self.assertEqual(self.count("carom", text, "include/carom/motion/state.hpp"), 0, text)

    def test_parts_of_public_classes_stay_there(self):
        for text in ("class World;", "class World::Implementation {", "template <>\nstruct FusedProduct<lanes::Real> {",
                     "// a comment"):
            self.assertEqual(self.count("carom", text), 0, text)

    def test_using_directives_are_found(self):
        self.assertEqual(self.count("carom::motion", "using namespace events;"), 1)


class Libm(unittest.TestCase):
    def count(self, path, line):
        return len(faults("libm", {path: line + "\n"}))

    def test_calls_are_found(self):
        for call in ("std::sin(t)", "cos(t)", "::pow(a, b)", "x+atan2f(y, x)", "std::hypot (x, y)"):
            self.assertEqual(self.count("src/motion/flight.cpp", f"double a = {call};"), 1, call)
        self.assertEqual(self.count("geometry/src/curve.cpp", "a = std::exp(b) * log(c);"), 2)
        self.assertEqual(self.count("src/base/random.cpp", "n = 1'000'000; a = std::log(u);"), 1)

    def test_others_are_not(self):
        for line in ("a = elementary::sin(t);", "a = std::sqrt(t);", "// sin(t)", 's = "sin(t)";', "a = my_sin(t);",
                     "a = mpfr_log(t);", "a = curve.exp(t);"):
            self.assertEqual(self.count("src/motion/flight.cpp", line), 0, line)
        self.assertEqual(self.count("src/cli/drawing.cpp", "a = std::sin(t);"), 0)


class Length(unittest.TestCase):
    def test_long_files_are_found(self):
        self.assertEqual(len(faults("length", {"src/files/long.cpp": "\n" * 501})), 1)
        self.assertEqual(len(faults("length", {"src/files/long.cpp": "\n" * 500})), 0)


@unittest.skipUnless(shutil.which("c++"), "no compiler is called c++")
class Headers(unittest.TestCase):
    def test_headers_that_need_others_are_found(self):
        found = faults("headers", {"src/lanes/good.hpp": "#pragma once\nint f(int);\n",
                                   "src/lanes/bad.hpp": "#pragma once\ninline Real twice(Real x);\n"})
        self.assertEqual([fault.split(" does")[0] for fault in found], ["src/lanes/bad.hpp"])


@unittest.skipUnless(shutil.which("clang-format-14"), "clang-format-14 is not installed")
class Format(unittest.TestCase):
    def test_other_formats_are_found(self):
        found = faults("format", {".clang-format": "BasedOnStyle: Google\n", "src/base/good.cpp": "int f() { return 1; }\n",
                                  "src/base/bad.cpp": "int f() {return 1;}\n"})
        self.assertEqual([fault.split(":")[0] for fault in found], ["src/base/bad.cpp"])


class Version(unittest.TestCase):
    def test_another_version_is_found(self):
        files = {"src/base/a.cpp": "", "CMakeLists.txt": "project(carom VERSION 1.2.3 LANGUAGES CXX)\n",
                 "CITATION.cff": "cff-version: 1.2.0\nversion: 1.2.3\n", "pyproject.toml": 'version = "1.2.3"\n',
                 "CHANGELOG.md": "# Changelog\n\n## [1.2.3] - unreleased\n\n## [1.2.2]\n"}
        self.assertEqual(faults("version", files), [])
        for name in files:
            if name != "src/base/a.cpp":
                self.assertTrue(faults("version", files | {name: files[name].replace("1.2.3", "1.2.4")}), name)
                self.assertTrue(faults("version", files | {name: "none\n"}), name)


class Paragraphs(unittest.TestCase):
    def test_long_ones_are_found(self):
        short, code = "word " * 100, "```\n" + "word " * 200 + "\n```\n"
        pages = {"README.md": f"{short}\n\n{short}\n- {short}\n{code}", "docs/guide/tutorials/a.md": f"# A\n\n{short}{short}\n"}
        self.assertEqual([fault.split(": ")[0] for fault in faults("paragraphs", pages)], ["docs/guide/tutorials/a.md:3"])


class Imports(unittest.TestCase):
    def test_a_circle_is_found(self):
        package = "python/carom/"
        files = {package + "low.py": "", package + "high.py": "from . import _compiled, low\n", package + "top.py": "from .high import f\n"}
        self.assertEqual(faults("imports", files), [])
        found = faults("imports", files | {package + "low.py": "def f():\n    from .top import g\n"})
        self.assertEqual(len(found), 1)


class Plan(unittest.TestCase):
    def test_a_cycle_is_found(self):
        plan = dict(structure.DEPENDENCIES)
        try:
            structure.DEPENDENCIES["base"] = ["cli"]
            with self.assertRaises(SystemExit):
                faults("includes", {})
        finally:
            structure.DEPENDENCIES.clear()
            structure.DEPENDENCIES.update(plan)


if __name__ == "__main__":
    unittest.main()
