// Random tables with extreme ratios, from 1e-1 to 1e-15: axes, radii, gaps, angles, distances from
// the origin, cells. Each is refused when it is read, or no particle is lost in it, none ends as
// singular, and all engines make the same orbits.
#include <gtest/gtest.h>

#include <cstdio>
#include <functional>
#include <map>
#include <string>

#include "carom/analyses/escape.hpp"
#include "carom/files/system_file.hpp"
#include "random_tables.hpp"

namespace carom {
namespace {

using tests::Dice;

std::string text(double x) {
  char shown[40];
  std::snprintf(shown, sizeof shown, "\"%.17g\"", x);
  return shown;
}
std::string text(double x, double y) { return "[" + text(x) + ", " + text(y) + "]"; }

double extreme(Dice& dice, double least = 1e-15) { return dice.spread(least, 0.1); }
double far_off(Dice& dice) { return dice.coin() ? 0.0 : dice.sign() / extreme(dice, 1e-12); }

std::string square(double side, double x, double y) {
  return "[table]\nshape = \"polygon\"\npoints = [" + text(x, y) + ", " + text(x + side, y) + ", " +
         text(x + side, y + side) + ", " + text(x, y + side) + "]\n";
}
std::string disc(double x, double y, double radius) {
  return "[[table.obstacle]]\nname = \"small\"\nshape = \"circle\"\ncenter = " + text(x, y) +
         "\nradius = " + text(radius) + "\n";
}
std::string ellipse(double x, double y, double a, double b, double angle) {
  return "[[table.obstacle]]\nname = \"small\"\nshape = \"ellipse\"\ncenter = " + text(x, y) +
         "\na = " + text(a) + "\nb = " + text(b) + "\nangle = " + text(angle) + "\n";
}
std::string path(const std::string& start, const std::string& pieces) {
  return "[table]\nshape = \"path\"\n[[table.loop]]\nstart = " + start + "\npieces = [" + pieces +
         "]\n";
}
std::string line(double x, double y) { return "{line_to = " + text(x, y) + "},"; }
std::string shape(const char* name, std::initializer_list<std::pair<const char*, double>> numbers) {
  std::string t = std::string("[table]\nshape = \"") + name + "\"\n";
  for (const auto& [key, number] : numbers) t += std::string(key) + " = " + text(number) + "\n";
  return t;
}

struct Family {
  const char* name;
  std::function<std::string(Dice&)> table;
  double time = 1e4;
};

const Family families[] = {
    {"thin rectangles",
     [](Dice& d) {
       return shape("rectangle", {{"width", 1.0}, {"height", extreme(d)}});
     }},
    {"thin ellipses in a square",
     [](Dice& d) {
       const double a = d.spread(1e-3, 1.4);
       return square(3.0, 0.0, 0.0) +
              ellipse(1.5, 1.5, a, a * extreme(d), d.coin() ? 0.0 : d.between(0.0, 3.0));
     }},
    {"thin ellipses far away",
     [](Dice& d) {
       const double x = far_off(d), y = far_off(d), a = d.spread(1e-3, 1.4);
       return square(3.0, x, y) +
              ellipse(x + 1.5, y + 1.5, a, a * extreme(d, 1e-8), d.between(0.0, 3.0));
     }},
    {"small discs", [](Dice& d) { return square(1.0, 0.0, 0.0) + disc(0.5, 0.375, extreme(d)); }},
    {"discs that nearly touch",
     [](Dice& d) {
       const double r = d.spread(1e-6, 0.2), gap = 0.5 * extreme(d), angle = d.between(0.0, 6.28);
       return square(1.0, 0.0, 0.0) + disc(0.5, 0.5, r) +
              "[[table.obstacle]]\nshape = \"circle\"\ncenter = " +
              text(0.5 + (2.0 * r + gap) * std::cos(angle),
                   0.5 + (2.0 * r + gap) * std::sin(angle)) +
              "\nradius = " + text(r) + "\n";
     }},
    {"a disc near a wall",
     [](Dice& d) {
       const double r = d.spread(1e-6, 0.4);
       return square(1.0, 0.0, 0.0) + disc(0.5, r * (1.0 + extreme(d)), r);
     }},
    {"discs far away",
     [](Dice& d) {
       const double x = far_off(d), y = far_off(d);
       return square(1.0, x, y) + disc(x + 0.5, y + 0.5, d.spread(1e-3, 0.4));
     }},
    {"sharp triangles",
     [](Dice& d) {
       return "[table]\nshape = \"triangle\"\npoints = [[0, 0], [1, 0], " +
              text(d.between(0.0, 1.0), extreme(d)) + "]\n";
     }},
    {"thin elliptic tables",
     [](Dice& d) {
       return shape("ellipse", {{"a", 1.0}, {"b", extreme(d)}});
     }},
    {"stadiums",
     [](Dice& d) {
       return d.coin() ? shape("stadium", {{"half_length", 1.0}, {"radius", extreme(d)}})
                       : shape("stadium", {{"half_length", extreme(d)}, {"radius", 1.0}});
     }},
    {"mushrooms",
     [](Dice& d) {
       return shape("mushroom", {{"cap_radius", 1.0},
                                 {"stem_width", d.coin() ? extreme(d) : 2.0 - extreme(d)},
                                 {"stem_height", d.coin() ? extreme(d) : 1.0}});
     }},
    {"lemons",
     [](Dice& d) {
       return shape("lemon", {{"radius", 1.0}, {"separation", 2.0 - 2.0 * extreme(d)}});
     }},
    {"annuli",
     [](Dice& d) {
       const double gap = extreme(d);
       return d.coin() ? shape("annulus", {{"outer", 1.0},
                                           {"inner", 1.0 - gap},
                                           {"offset", gap * d.between(0.0, 1.0)}})
                       : shape("annulus", {{"outer", 1.0}, {"inner", gap}, {"offset", 0.5}});
     }},
    {"cells with a disc",
     [](Dice& d) {
       return shape("sinai", {{"side", 1.0}, {"radius", d.coin() ? extreme(d) : 0.5 - extreme(d)}});
     },
     100.0},
    {"triangular cells with a disc",
     [](Dice& d) {
       return "[table]\nshape = \"lorentz\"\nlattice = \"triangular\"\nspacing = 1\nradius = " +
              text(d.coin() ? extreme(d) : 0.5 - extreme(d)) + "\n";
     },
     100.0},
    {"narrow cells",
     [](Dice& d) {
       const double height = extreme(d, 1e-3);
       return "[table]\nshape = \"discs\"\ncenters = [[0, 0]]\nradius = " +
              text(height * d.between(0.05, 0.49)) + "\n[lattice]\nvectors = [[1, 0], " +
              text(d.between(-0.4, 0.4), height) + "]\n";
     },
     10.0},
    {"rounded corners",
     [](Dice& d) {
       const double r = extreme(d), half = 0.70710678118654757 * r;
       return path("[0, 0]", line(1.0, 0.0) + line(1.0, 1.0 - r) +
                                 "{arc_via = " + text(1.0 - r + half, 1.0 - r + half) +
                                 ", arc_to = " + text(1.0 - r, 1.0) + ", name = \"small\"}," +
                                 line(0.0, 1.0) + line(0.0, 0.0));
     }},
    {"thin elliptic domes",
     [](Dice& d) {
       const double h = extreme(d);
       return path("[-1, 0]", line(1.0, 0.0) + "{ellipse_via = " + text(0.0, h) +
                                  ", ellipse_to = [-1, 0], ellipse_ratio = " + text(h) + "}");
     }},
    {"thin elliptic bumps",
     [](Dice& d) {
       const double h = extreme(d);
       return path("[-2, 0]", line(-1.0, 0.0) + "{ellipse_via = " + text(0.0, h) +
                                  ", ellipse_to = [1, 0], ellipse_ratio = " + text(h) + "}," +
                                  line(2.0, 0.0) + line(2.0, 2.0) + line(-2.0, 2.0) +
                                  line(-2.0, 0.0));
     }},
    {"short sides",
     [](Dice& d) {
       const double e = extreme(d), f = extreme(d);
       return path("[0, 0]", line(1.0, 0.0) + line(1.0, 1.0 - e) + line(1.0 - f, 1.0) +
                                 line(0.0, 1.0) + line(0.0, 0.0));
     }},
    {"spikes",
     [](Dice& d) {
       const double x = 0.5, w = extreme(d), h = d.between(0.01, 0.9);
       return path("[0, 0]", line(x, 0.0) + line(x + 0.5 * w, h) + line(x + w, 0.0) +
                                 line(1.0, 0.0) + line(1.0, 1.0) + line(0.0, 1.0) + line(0.0, 0.0));
     }},
    {"slits",
     [](Dice& d) {
       const double w = extreme(d), h = d.between(0.1, 0.8);
       return square(1.0, 0.0, 0.0) + "[[table.obstacle]]\nshape = \"polygon\"\npoints = [" +
              text(0.25, h) + ", " + text(0.75, h) + ", " + text(0.75, h + w) + ", " +
              text(0.25, h + w) + "]\n";
     }},
};

struct Counts {
  int flown = 0, refused = 0, otherwise = 0;  ///< refused by another limit, or as no table
  std::uint64_t hits = 0, exact = 0, lost = 0, singular = 0;
};

TEST(ExtremeTables, AreRefusedOrLoseNoParticle) {
  Dice dice(29);
  std::map<std::string, Counts> seen;
  const long each = tests::cases(8, 460);
  for (const Family& family : families) {
    Counts& counts = seen[family.name];
    for (long k = 0; k < each; ++k) {
      const std::string table = family.table(dice);
      const bool field = dice.coin();
      const std::string whole =
          table + (field ? "[field]\nlarmor_radius = " + text(dice.spread(1e-3, 1e3)) + "\n" : "") +
          "[particles]\nspeed = 1\n[initial]\nkind = \"boundary\"\n" +
          // Most flights from a small wall meet none of the others, but some come back to it.
          (table.find("small") != std::string::npos && dice.coin() ? "wall = \"small\"\n" : "") +
          "[run]\nt_max = " + text(family.time) +
          "\ncollisions = 40\ntrajectories = 12\nseed = " + std::to_string(k) + "\n";
      std::optional<System> system;
      try {
        system = read_system(whole, family.name).system;
      } catch (const InputError& error) {
        ++counts.refused;
        if (std::string(error.what()).find("2^-16") == std::string::npos) {
          ++counts.otherwise;
          std::printf("%s: %s\n", family.name, error.what());
        }
        continue;
      }
      ++counts.flown;
      EscapeOptions how;
      how.threads = 1;
      how.lanes = std::nullopt;
      const EscapeResult scalar = run_escape(*system, how);
      counts.hits += scalar.counts.collisions;
      counts.exact += scalar.decisions.exact;
      counts.lost += scalar.counts.lost;
      counts.singular += scalar.counts.singular;
      EXPECT_EQ(scalar.counts.lost, 0u) << whole;
      EXPECT_EQ(scalar.counts.singular, 0u) << whole;
      for (const auto& [index, report] : scalar.reports) std::printf("%s\n", report.c_str());
      for (const InstructionSet set : available_instruction_sets()) {
        how.lanes = set;
        const EscapeResult lanes = run_escape(*system, how);
        EXPECT_EQ(lanes.digest, scalar.digest) << name_of(set) << "\n" << whole;
        EXPECT_EQ(lanes.counts.lost, 0u) << name_of(set) << "\n" << whole;
      }
    }
    EXPECT_GT(counts.flown, 0) << family.name;
    EXPECT_LE(10 * counts.otherwise, each) << family.name;
  }
  Counts all;
  for (const auto& [name, c] : seen) {
    std::printf(
        "%s: %d tables, %d refused, %llu hits, %llu decided exactly, %llu lost, %llu "
        "singular\n",
        name.c_str(), c.flown, c.refused, static_cast<unsigned long long>(c.hits),
        static_cast<unsigned long long>(c.exact), static_cast<unsigned long long>(c.lost),
        static_cast<unsigned long long>(c.singular));
    all.flown += c.flown;
    all.refused += c.refused;
    all.hits += c.hits;
  }
  std::printf("%d tables, %d refused, %llu hits\n", all.flown, all.refused,
              static_cast<unsigned long long>(all.hits));
}

}  // namespace
}  // namespace carom
