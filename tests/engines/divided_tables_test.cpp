// Tables that are divided from wall to wall, and regions within regions.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "carom/analyses/escape.hpp"
#include "carom/base/error.hpp"
#include "carom/engines/trajectories.hpp"
#include "carom/events/medium.hpp"
#include "region_orbits.hpp"

namespace carom {
namespace {

using geometry::Vector;

/// A rectangle of 4 by 2 with corners at x = 1, 2 and 3 of its long sides.
const std::string layers =
    "[table]\nshape = \"polygon\"\npoints = [[0, 0], [1, 0], [2, 0], [3, 0], [4, 0], [4, 2], [3, "
    "2], [2, 2], [1, 2], [0, 2]]\n";
std::string cut(const std::string& from, const std::string& pieces, const std::string& keys) {
  return "[[table.region]]\nstart = " + from + "\npieces = [" + pieces + "]\n" + keys;
}
/// What is right of x.
std::string right_of(int x, const std::string& keys) {
  const std::string at = std::to_string(x);
  return cut("[" + at + ", 2]", "{ line_to = [" + at + ", 0], name = \"at_" + at + "\" }", keys);
}
const std::string uniform = "[initial]\nkind = \"uniform\"\n";

class Hits : public Observer {
 public:
  void hit(const HitEvent& e) override { rows.push_back(e); }
  void end(const EndEvent& e) override {
    fates.push_back(e.fate);
    ends.push_back(rows.size());
  }
  int count(Fate fate) const {
    int n = 0;
    for (const Fate f : fates) n += f == fate;
    return n;
  }
  std::vector<HitEvent> rows;
  std::vector<Fate> fates;
  std::vector<std::size_t> ends;  // of trajectories
};

Hits hits_of(const System& system) {
  Hits seen;
  for_each_trajectory(system, {0, system.run.trajectories}, seen);
  return seen;
}

Hits flown(const System& system, const State& start, std::uint64_t hits) {
  World world(*system.table, system.dynamics);
  world.add(system.particles[0], start);
  Hits seen;
  world.limit_hits(hits);
  world.run_until(1000.0, seen);
  return seen;
}

TEST(DividedTables, HaveTheirWallsInTheirParts) {
  const System system = system_of(layers + right_of(2, "B = 1\n") + right_of(3, "B = 2\n"));
  const Table& table = *system.table;
  const Table outside = seen_from(table, -1), first = seen_from(table, 0),
              second = seen_from(table, 1);
  EXPECT_EQ(outside.walls.size(), 5u + 1u);
  EXPECT_EQ(first.walls.size(), 2u + 2u);
  EXPECT_EQ(second.walls.size(), 3u + 1u);
  EXPECT_EQ(measure(outside).area, 4.0);
  EXPECT_EQ(measure(first).area, 2.0);
  EXPECT_EQ(measure(second).area, 2.0);
  EXPECT_EQ(measure(table).area, 8.0);
  EXPECT_EQ(measure(table).perimeter, 12.0 + 4 * 2.0);
  for (int w = 0; w < static_cast<int>(table.walls.size()); ++w) {
    const Wall& wall = table.wall(w);
    EXPECT_EQ(table.wall(wall.next).previous, w);
    EXPECT_EQ(geometry::end_point(wall.curve), geometry::start_point(table.wall(wall.next).curve));
    EXPECT_EQ(region_of(table, wall.next), region_of(table, w));
    if (wall.twin < 0) continue;
    EXPECT_EQ(table.wall(wall.twin).twin, w);
    EXPECT_NE(is_inner_side(table, w), is_inner_side(table, wall.twin));
  }
  EXPECT_EQ(region_of(table, table.wall_index("at_3")), 0);
  EXPECT_EQ(region_of(table, table.wall_index("at_3.inside")), 1);
  EXPECT_EQ(region_of(table, table.wall_index("side_5")), 1);
}

/// n sin(angle) is the same in all layers, whichever of them is cut off first.
TEST(DividedTables, RefractInLayers) {
  const std::string in_order =
      right_of(1, "index = 1.25\n") + right_of(2, "index = 1.5\n") + right_of(3, "index = 1.1\n");
  const std::string out_of_order = right_of(2, "index = 1.5\n") + right_of(3, "index = 1.1\n") +
                                   cut("[1, 2]", "{ line_to = [1, 0] }", "index = 1.25\n");
  for (const std::string& regions : {in_order, out_of_order}) {
    const System system = system_of(layers + regions);
    const double sine = 0.28, index[] = {1.0, 1.25, 1.5, 1.1};
    const Hits seen = flown(system, at({0.25, 0.25}, {0.96, sine}), 4);
    ASSERT_EQ(seen.rows.size(), 4u);
    double y = 0.25, width = 0.75;
    for (int k = 0; k < 4; ++k) {
      const HitEvent& hit = seen.rows[static_cast<std::size_t>(k)];
      const double s = sine / index[k], c = std::sqrt(1.0 - s * s);
      EXPECT_NEAR(hit.before.y, s / index[k], 2e-16);
      EXPECT_NEAR(hit.flight_time, width / c * index[k], 1e-15);
      EXPECT_NEAR(hit.position.y, y += width * s / c, 1e-15);
      width = 1.0;
    }
    EXPECT_EQ(system.table->wall(seen.rows[3].wall).name, "side_5");
    EXPECT_EQ(seen.rows[3].after.x, -seen.rows[3].before.x);
  }
}

/// Flights in every part have the mean pi A / L of that part: obstacles in it, discs within discs,
/// a pocket of an obstacle and curved edges count.
TEST(DividedTables, HaveTheirMeanFlightsInEveryPart) {
  const std::string disc = "[[table.obstacle]]\nshape = \"circle\"\nname = \"";
  const std::string obstacles = disc + "hard\"\ncenter = [3.4, 0.5]\nradius = 0.25\n" + disc +
                                "soft\"\ncenter = [3.1, 1.4]\nradius = 0.5\n" + disc +
                                "core\"\ncenter = [3, 1.4]\nradius = 0.2\n";
  const std::string pocket =
      "[[table.obstacle]]\nshape = \"polygon\"\nname = \"cup\"\npoints = [[0.3, 0.3], [1.3, 0.3], "
      "[1.3, 1.5], [1.1, 1.5], [1.1, 0.5], [0.5, 0.5], [0.5, 1.5], [0.3, 1.5]]\n";
  const std::string bow = cut("[2, 2]", "{ arc_via = [2.3, 1], arc_to = [2, 0] }", "B = 1.5\n");
  const std::string within =
      "[[table.region]]\nwall = \"core\"\npotential = 0.2\n"
      "[[table.region]]\nwall = \"soft\"\npotential = -0.6\nB = 0.5\n";
  for (const std::string& parts :
       {bow, bow + within, within + bow,
        bow + cut("[1.1, 1.5]", "{ line_to = [0.5, 1.5] }", "potential = 0.3\nB = -1\n") +
            within}) {
    const bool cup = parts.find("1.1, 1.5") != std::string::npos;
    const System system = system_of(
        layers +
        obstacles.substr(0, parts == bow ? obstacles.find(disc + "core") : obstacles.size()) +
        (cup ? pocket : "") + parts + uniform + "[run]\nt_max = 1000\ntrajectories = 60\n");
    const Table& table = *system.table;
    const Hits seen = hits_of(system);
    EXPECT_EQ(seen.count(Fate::lost), 0);
    EXPECT_EQ(seen.count(Fate::singular), 0);
    for (int part = -1; part < static_cast<int>(table.regions.size()); ++part) {
      const double expected = measure(seen_from(table, part)).mean_flight;
      double sum = 0.0, square = 0.0, all = 0.0;
      for (std::size_t t = 0, row = 0; t < seen.ends.size(); ++t) {
        double excess = 0.0;
        for (; row < seen.ends[t]; ++row) {
          const HitEvent& hit = seen.rows[row];
          const Wall& wall = table.wall(hit.wall);
          // A particle that passed came from the other side.
          const Vector normal = geometry::normal_at(geometry::frame_of(wall.curve), hit.u);
          const int side = dot(normal, hit.before) > 0.0 ? wall.twin : hit.wall;
          if (region_of(table, side) != part) continue;
          excess += hit.flight_time * in_region(table, system.particles[0], part).speed - expected;
          all += 1.0;
        }
        sum += excess;
        square += excess * excess;
      }
      EXPECT_LT(std::fabs(sum), 4.0 * std::sqrt(square)) << parts << part;
      EXPECT_GT(all, 1000.0) << parts << part;
    }
  }
}

/// A cut into equal parts changes nothing but the count of hits.
TEST(DividedTables, AreWholeWhereTheirPartsAreEqual) {
  const std::string arc = cut("[2, 2]", "{ arc_via = [2.5, 1], arc_to = [2, 0] }", "");
  const std::string bezier = cut("[1, 2]", "{ bezier = [[0.5, 1.5], [1.5, 0.5], [1, 0]] }", "");
  for (const std::string field : {"", "[field]\nB = 0.7\n"})
    for (const std::string& edges : {right_of(2, ""), arc, right_of(1, "") + arc, bezier + arc}) {
      const System with = system_of(layers + edges + field), without = system_of(layers + field);
      for (const double angle : {0.4, 2.2, 3.9}) {
        expect_same_orbit(with, without, at({0.7, 0.9}, {std::cos(angle), std::sin(angle)}), 20.0,
                          1e-10);
      }
    }
}

TEST(DividedTables, AreFlownThroughBackwards) {
  const System system =
      system_of(layers + right_of(1, "potential = 0.2\n") + right_of(3, "potential = -0.5\n"));
  expect_way_back(system, at({0.6, 0.3}, {0.8, 0.6}), 30.0, 15, 1e-10);
}

/// A bubble of the outer index in a disc of glass: straight on through its middle.
TEST(DividedTables, HoldRegionsWithinRegions) {
  const std::string rings =
      "[table]\nshape = \"circle\"\nradius = 3\n[[table.obstacle]]\nshape = \"circle\"\nname = "
      "\"bubble\"\ncenter = [0, 0]\nradius = 0.5\n[[table.obstacle]]\nshape = \"circle\"\nname = "
      "\"glass\"\ncenter = [0, 0]\nradius = 1\n";
  const std::string glass = "[[table.region]]\nwall = \"glass\"\nindex = 1.5\n",
                    bubble = "[[table.region]]\nwall = \"bubble\"\n";
  for (const std::string& regions : {glass + bubble, bubble + glass}) {
    const System system = system_of(rings + regions);
    const Hits seen = flown(system, at({-2, 0}, {1, 0}), 5);
    const double times[] = {1.0, 0.75, 1.0, 0.75, 2.0};
    for (std::size_t k = 0; k < 5; ++k) EXPECT_NEAR(seen.rows[k].flight_time, times[k], 1e-15);
    // A start in the glass, and one in the bubble, have the speed there.
    for (const auto& [x, speed] : {std::pair{0.75, 1.0 / 1.5}, std::pair{0.1, 1.0}}) {
      World world(*system.table, system.dynamics);
      world.add(Particle(), at({x, 0.0}, {0.6, 0.8}));
      const Vector v = world.state(0).velocity;
      EXPECT_NEAR(std::sqrt(dot(v, v)), speed, 1e-15);
    }
  }
  // Without a region the bubble is hard.
  const Hits seen = flown(system_of(rings + glass), at({-2, 0}, {1, 0}), 3);
  EXPECT_NEAR(seen.rows[1].flight_time, 0.75, 1e-15);
  EXPECT_NEAR(seen.rows[2].flight_time, 0.75, 1e-15);
}

/// The wave that is mirrored is the same from either side, also where both are regions.
TEST(DividedTables, MirrorTheSameShareFromBothSides) {
  const std::string parts =
      right_of(1, "index = 1.5\n") + right_of(3, "index = 3\nreflection = \"s\"\n");
  for (const char* start : {"[2, 1]\nvelocity = [1, 0]\n", "[3.5, 1]\nvelocity = [-1, 0]\n"}) {
    const System system = system_of(layers + parts + "[initial]\nposition = " + start +
                                    "[run]\nt_max = 1.6\ntrajectories = 4000\n");
    double mirrored = 0.0;
    const Hits seen = hits_of(system);
    for (const HitEvent& hit : seen.rows) mirrored += hit.before.x * hit.after.x < 0.0;
    EXPECT_EQ(seen.rows.size(), 4000u);
    EXPECT_NEAR(mirrored / 4000.0, 1.0 / 9.0, 4.0 * std::sqrt(8.0 / 81.0 / 4000.0)) << start;
  }
}

/// What is in an obstacle is found there, even where the boxes around it reach beyond.
TEST(DividedTables, KnowWhatLiesInAnObstacle) {
  const std::string box =
      "[table]\nshape = \"rectangle\"\nwidth = 4\nheight = 2\n[[table.obstacle]]\nshape = "
      "\"polygon\"\nname = \"p\"\npoints = [[1, 0.5], [3, 0.5], [3, 1.5], [1, 1.5]]\n";
  const std::string leaf =
      "[[table.obstacle]]\nshape = \"path\"\nname = \"leaf\"\nstart = [1.5, 1]\npieces = [{ bezier "
      "= [[1.5, 1.6], [2.5, 1.6], [2.5, 1]] }, { bezier = [[2.5, 0.4], [1.5, 0.4], [1.5, 1]] }]\n";
  EXPECT_THROW(system_of(box + leaf), InputError);
  const System system = system_of(box + leaf + "[[table.region]]\nwall = \"p_side_1\"\n");
  const Hits seen = flown(system, at({0.5, 1.1}, {1, 0}), 2);
  EXPECT_TRUE(system.table->wall(seen.rows[1].wall).name.starts_with("leaf"));
  EXPECT_EQ(region_of(*system.table, seen.rows[1].wall), 0);
}

/// The lid of a pocket and the obstacle itself: whichever is written first.
TEST(DividedTables, DoNotDependOnTheOrderOfRegions) {
  const std::string cup =
      "[table]\nshape = \"rectangle\"\nwidth = 2\nheight = 2\n[[table.obstacle]]\nshape = "
      "\"polygon\"\nname = \"cup\"\npoints = [[0.3, 0.3], [1.3, 0.3], [1.3, 1.5], [1.1, 1.5], "
      "[1.1, "
      "0.5], [0.5, 0.5], [0.5, 1.5], [0.3, 1.5]]\n";
  const std::string body = "[[table.region]]\nwall = \"cup_side_1\"\nB = 1\n",
                    lid = cut("[1.1, 1.5]", "{ line_to = [0.5, 1.5] }", "B = 2\n");
  const System one = system_of(cup + body + lid), other = system_of(cup + lid + body);
  for (const int part : {-1, 0, 1}) {
    const TableMeasure a = measure(seen_from(*one.table, part)),
                       b = measure(seen_from(*other.table, part < 0 ? part : 1 - part));
    EXPECT_EQ(a.area, b.area);
    EXPECT_EQ(a.perimeter, b.perimeter);
  }
  EXPECT_NEAR(measure(seen_from(*one.table, 1)).area, 0.6, 1e-15);
}

/// Signs of areas are exact: a table far from the origin has a left and a right.
TEST(DividedTables, AreDividedFarFromTheOrigin) {
  const std::string far =
      "[table]\nshape = \"polygon\"\npoints = [[100000000, 100000000], [100000002, 100000000], "
      "[100000002, 100000001], [100000001, 100000001], [100000001, 100000002], [100000000, "
      "100000001]]\n";
  const System system = system_of(
      far + cut("[100000001, 100000001]", "{ line_to = [100000000, 100000000] }", "B = 1\n"));
  EXPECT_EQ(seen_from(*system.table, 0).walls.size(), 4u);
  EXPECT_THROW(system_of(far + "[[table.region]]\nwall = \"side_1\"\n"), InputError);
}

/// A law for a piece of an edge counts on both sides, one for its inner side there.
TEST(DividedTables, TakeTheLastLawOfEachSide) {
  const auto law = [](const std::string& wall, const std::string& how) {
    return "[[table.wall]]\nwall = \"" + wall + "\"\nlaw = \"" + how + "\"\n";
  };
  const auto shares = [&](const std::string& laws) {
    const System system = system_of(layers + right_of(2, "") + laws);
    const Table& table = *system.table;
    return std::pair{table.wall(table.wall_index("at_2")).specularity,
                     table.wall(table.wall_index("at_2.inside")).specularity};
  };
  EXPECT_EQ(shares(law("at_2", "specular") + law("at_2", "diffuse")), std::pair(0.0, 0.0));
  EXPECT_EQ(shares(law("at_2", "specular") + law("at_2.inside", "diffuse")), std::pair(1.0, 0.0));
  EXPECT_EQ(shares(law("at_2.inside", "diffuse") + law("at_2", "specular")), std::pair(1.0, 1.0));
}

TEST(DividedTables, HaveHolesAndLawsInTheirParts) {
  const std::string hole = "[[table.hole]]\nwall = \"side_5\"\ncenter = 1\nwidth = 0.5\n";
  const System system = system_of(layers + right_of(2, "potential = 0.1\n") + hole);
  const Hits seen = flown(system, at({1, 1}, {1, 0}), 10);
  EXPECT_EQ(seen.rows.size(), 1u);
  EXPECT_EQ(seen.fates, std::vector<Fate>{Fate::escaped});
  // Lambert's law at the far end: the tangential component is uniform.
  const System diffuse =
      system_of(layers + right_of(2, "potential = 0.1\n") +
                "[[table.wall]]\nwall = \"side_5\"\nlaw = "
                "\"diffuse\"\n[initial]\nposition = [1, 1]\nvelocity = [1, 0]\n[run]\nt_max = 4\n"
                "trajectories = 4000\n");
  double sum = 0.0, square = 0.0, all = 0.0;
  for (const HitEvent& hit : hits_of(diffuse).rows)
    if (diffuse.table->wall(hit.wall).name == "side_5" && hit.before.y == 0.0) {
      const double sine = hit.after.y / std::sqrt(dot(hit.after, hit.after));
      sum += sine;
      square += sine * sine;
      all += 1.0;
    }
  EXPECT_EQ(all, 4000.0);
  EXPECT_NEAR(sum / all, 0.0, 4.0 * std::sqrt(1.0 / 3.0 / all));
  EXPECT_NEAR(square / all, 1.0 / 3.0, 4.0 * std::sqrt(4.0 / 45.0 / all));
}

/// Two walls with a slit between them: what the flux through it must be, and reflections at both
/// sides.
TEST(DividedTables, HaveSlits) {
  const std::string edge =
      cut("[2, 2]",
          "{ line_to = [2, 1.3], name = \"upper\" }, { line_to = [2, 0.9], name = "
          "\"slit\" }, { line_to = [2, 0], name = \"lower\" }",
          "");
  const auto law = [](const std::string& wall, const std::string& how) {
    return "[[table.wall]]\nwall = \"" + wall + "\"\nlaw = \"" + how + "\"\n";
  };
  const System system =
      system_of(layers + edge + law("upper", "specular") + law("lower.inside", "diffuse") +
                uniform + "[run]\nt_max = 500\ntrajectories = 400\n");
  const Table& table = *system.table;
  EXPECT_EQ(table.wall(table.wall_index("lower")).specularity, 0.0);
  const Hits seen = hits_of(system);
  EXPECT_EQ(seen.count(Fate::lost), 0);
  double passed = 0.0, expected = 0.0;
  for (const HitEvent& hit : seen.rows) {
    const Wall& wall = table.wall(hit.wall);
    const bool through =
        dot(geometry::normal_at(geometry::frame_of(wall.curve), hit.u), hit.before) > 0.0;
    EXPECT_EQ(through, wall.name.starts_with("slit")) << wall.name;
    passed += through;
  }
  // The flux of a uniform density 1/A from either side: v/(pi A) times the width.
  expected = 400 * 500 * 2.0 * 0.4 / (std::acos(-1.0) * 8.0);
  EXPECT_NEAR(passed / expected, 1.0, 0.03);
}

/// Between walls a corner is one of pi/n, at the end of an edge no law holds.
TEST(DividedTables, EndWhatMeetsTheEndOfAnEdge) {
  const double diagonal = std::sqrt(0.5);
  const System system = system_of(layers + right_of(2, "potential = 0.1\n"));
  // At either end, from outside and from within.
  for (const double x : {1.0, 3.0})
    for (const double y : {diagonal, -diagonal}) {
      const State start = at({x, 1}, {x < 2.0 ? diagonal : -diagonal, y});
      EXPECT_EQ(flown(system, start, 4).fates, std::vector<Fate>{Fate::singular}) << x << y;
    }
  const Hits seen = flown(system, at({3, 1}, {diagonal, -diagonal}), 1);
  EXPECT_EQ(seen.fates, std::vector<Fate>{Fate::capped});
  EXPECT_EQ(seen.rows[0].after, -seen.rows[0].before);
}

TEST(DividedTables, GiveOneDigestHoweverTheWorkIsShared) {
  const System system =
      system_of(layers + right_of(1, "index = 1.5\nreflection = \"s\"\n") + right_of(3, "B = 2\n") +
                "[[table.hole]]\nwall = \"side_5\"\ncenter = 1\nwidth = 0.5\n" + uniform +
                "[run]\nt_max = 50\ntrajectories = 300\n");
  const auto digest = [&](int threads, std::uint64_t block) {
    EscapeOptions how;
    how.threads = threads;
    how.block = block;
    return run_escape(system, how).digest;
  };
  EXPECT_EQ(digest(1, 64), digest(2, 7));
}

TEST(DividedTables, AreRefusedByNameAndPlace) {
  const std::string disc =
      "[[table.obstacle]]\nshape = \"circle\"\ncenter = [2, 1]\nradius = 0.5\n";
  const struct {
    std::string toml, words;
  } cases[] = {
      {layers + cut("[2, 1.5]", "{ line_to = [2, 0] }", ""), "begins at (2, 1.5)"},
      {layers + cut("[2, 2]", "{ line_to = [2, 0.5] }", ""), "ends at (2, 0.5)"},
      {layers + cut("[2, 2]", "{ line_to = [2, 2] }", ""), "ends where it begins"},
      {layers + cut("[2, 2]", "", ""), "no pieces"},
      {layers + cut("[2, 2]", "{ line_to = [4.1, 1] }, { line_to = [2, 0] }", ""), "cross"},
      {layers + cut("[1, 2]", "{ line_to = [3, 2] }", ""), "run along"},
      {layers + cut("[1, 2]", "{ line_to = [1, 3] }, { line_to = [3, 2] }", ""), "on the left"},
      {layers + disc + right_of(2, ""), "'at_2.inside'"},
      {layers + right_of(2, "") + cut("[1, 2]", "{ line_to = [3, 0] }", ""), "different parts"},
      {layers + right_of(2, "") + right_of(2, ""), "called 'at_2'"},
      {layers + cut("[2, 2]",
                    "{ line_to = [2, 1], name = \"a\" }, { line_to = [2, 0], name = \"a\" }", ""),
       "called 'a'"},
      {layers + cut("[2, 2]",
                    "{ line_to = [2, 1], name = \"a\" }, { line_to = [2, 0], name = \"a.inside\" }",
                    ""),
       "called 'a.inside'"},
      {layers + disc +
           "name = \"d\"\n[[table.region]]\nwall = \"d\"\n[[table.region]]\nwall = \"d\"\n",
       "another region"},
      {layers + right_of(2, "") + "[[table.region]]\nwall = \"side_1\"\n", "outer wall"},
      {layers + cut("[2, 2]", "{ line_to = [3, 1] }, { line_to = [2, 2] }", ""),
       "ends where it begins"},
      {layers + cut("[1, 2]", "{ line_to = [3, 0] }", "") +
           cut("[3, 2]", "{ line_to = [1, 0] }", ""),
       "different parts"},
      {layers + cut("[1, 2]", "{ line_to = [3, 0] }", "") +
           cut("[1, 0]", "{ line_to = [3, 1.5] }, { line_to = [0, 2] }", ""),
       "cross"},
      {layers + cut("[2, 2]", "{ line_to = [2, 0] }", "wall = \"side_1\"\n"), "unknown key"},
      {layers + right_of(2, "") + "[[table.hole]]\nwall = \"at_2\"\ncenter = 1\nwidth = 0.5\n",
       "particles pass"},
      {layers + cut("[2, 2]", "{ arc_via = [2.0000001, 1], arc_to = [2, 0] }", ""), "too flat"},
  };
  for (const auto& [toml, words] : cases) {
    try {
      system_of(toml);
      ADD_FAILURE() << toml;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
      EXPECT_GT(error.place().line, 0) << error.what();
    }
  }
}

}  // namespace
}  // namespace carom
