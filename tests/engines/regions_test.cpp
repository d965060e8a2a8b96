// Regions of another index, potential or field: closed forms, conservation, reversal, statistics.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "carom/analyses/diffusion.hpp"
#include "carom/analyses/escape.hpp"
#include "carom/analyses/lyapunov.hpp"
#include "carom/base/error.hpp"
#include "carom/engines/trajectories.hpp"
#include "carom/events/medium.hpp"
#include "carom/geometry/curve_frame.hpp"
#include "carom/starts/start_measure.hpp"
#include "region_orbits.hpp"

namespace carom {
namespace {

using geometry::Vector;

constexpr double pi = 3.141592653589793;

std::string box(const std::string& obstacle, const std::string& region,
                const std::string& more = "") {
  return "[table]\nshape = \"rectangle\"\nwidth = 4\nheight = 3\n[[table.obstacle]]\n" + obstacle +
         "[[table.region]]\n" + region + more;
}
const std::string disc = "shape = \"circle\"\ncenter = [2.1, 1.4]\nradius = 0.7\nname = \"disc\"\n";
const std::string of_disc = "wall = \"disc\"\n";
/// A rectangle whose left side, x = 2, is its fourth.
const std::string half =
    "shape = \"polygon\"\npoints = [[2, 0.25], [3.75, 0.25], [3.75, 2.75], [2, 2.75]]\nname = "
    "\"half\"\n";
const std::string of_half = "wall = \"half_side_4\"\n";

// All hits, and what was seen at each.
class Hits : public Observer {
 public:
  explicit Hits(const System& system) : system_(system) {
    for (const Wall& wall : system.table->walls) frames_.push_back(geometry::frame_of(wall.curve));
  }
  struct Row {
    HitEvent event;
    int region_before, region_after;
    double sine_before, sine_after;  // of the angles to the normal
  };
  void hit(const HitEvent& e) override {
    const Table& table = *system_.table;
    const Wall& wall = table.walls[static_cast<std::size_t>(e.wall)];
    const Vector normal = geometry::normal_at(frames_[static_cast<std::size_t>(e.wall)], e.u);
    // A particle that passed came against the normal of the wall's other side.
    const bool passed = dot(normal, e.before) > 0.0;
    const int side = passed ? wall.twin : e.wall;
    rows.push_back({e, region_of(table, side), region_of(table, e.wall),
                    cross(normal, e.before) / std::sqrt(dot(e.before, e.before)),
                    cross(normal, e.after) / std::sqrt(dot(e.after, e.after))});
  }
  void end(const EndEvent& e) override {
    fates.push_back(e.fate);
    ends.push_back(rows.size());
  }
  std::vector<Row> rows;
  std::vector<std::size_t> ends;  // of trajectories
  std::vector<Fate> fates;

 private:
  const System& system_;
  std::vector<geometry::CurveFrame> frames_;
};

Hits hits_of(const System& system) {
  Hits seen(system);
  for_each_trajectory(system, {0, system.run.trajectories}, seen);
  return seen;
}

int lost(const Hits& hits) {
  int count = 0;
  for (const Fate fate : hits.fates) count += fate == Fate::lost;
  return count;
}

TEST(Regions, BendALineThroughADiscAsSnellDoes) {
  const System system = system_of(box(disc, of_disc + "index = 1.5\n"));
  for (const double b : {-0.6, -0.1, 0.0, 0.3, 0.69}) {
    World world(*system.table, system.dynamics);
    Particle light;
    world.add(light, at({0.5, 1.4 + b}, {1.0, 0.0}));
    Hits seen(system);
    world.limit_hits(2);
    world.run_until(10.0, seen);
    ASSERT_EQ(seen.rows.size(), 2u);
    const double first = std::asin(b / 0.7), second = std::asin(b / 0.7 / 1.5);
    const HitEvent& leaves = seen.rows[1].event;
    EXPECT_NEAR(leaves.flight_time, 1.5 * 2.0 * 0.7 * std::cos(second), 2e-15);
    EXPECT_NEAR(std::atan2(leaves.after.y, leaves.after.x), -2.0 * (first - second), 4e-15) << b;
    EXPECT_NEAR(dot(leaves.after, leaves.after), 1.0, 4e-16);
    EXPECT_NEAR(dot(leaves.before, leaves.before), 1.0 / 2.25, 4e-16);
  }
}

TEST(Regions, KeepTheMomentumAlongTheWallOrMirror) {
  for (const char* region : {"index = 1.7\n", "index = 0.6\n", "potential = 0.3\n",
                             "potential = -0.8\n", "index = 1.3\nreflection = \"p\"\n"}) {
    const System system =
        system_of(box(disc, of_disc + region, "[run]\nt_max = 200\ntrajectories = 100\n"));
    const Hits seen = hits_of(system);
    EXPECT_EQ(lost(seen), 0);
    const Particle& outside = system.particles.front();
    int passed = 0, total = 0;
    for (const Hits::Row& row : seen.rows) {
      const double before = momentum_in(*system.table, outside, row.region_before),
                   after = momentum_in(*system.table, outside, row.region_after);
      EXPECT_NEAR(before * row.sine_before, after * row.sine_after, 4e-15);
      const double speed = in_region(*system.table, outside, row.region_after).speed;
      EXPECT_NEAR(dot(row.event.after, row.event.after) / (speed * speed), 1.0, 4e-15);
      if (row.region_before != row.region_after) {
        ++passed;
        continue;
      }
      const Wall& wall = system.table->walls[static_cast<std::size_t>(row.event.wall)];
      if (wall.twin < 0 || system.table->regions[0].reflection != Region::Reflection::none)
        continue;
      const double other = momentum_in(*system.table, outside, region_of(*system.table, wall.twin));
      EXPECT_GE(std::fabs(before * row.sine_before), other * (1.0 - 1e-15));
      ++total;
    }
    EXPECT_GT(passed, 1000);
    EXPECT_TRUE(total > 100 || system.table->regions[0].reflection != Region::Reflection::none);
  }
}

/// Flights in a domain have the mean pi A / L, its walls counted from within.
TEST(Regions, HaveTheirMeanFlights) {
  for (const char* region :
       {"", "potential = 0.3\n", "B = 1.5\n", "potential = -0.5\nreflection = \"s\"\n"}) {
    const System system = system_of(box(disc, of_disc + region,
                                        "[initial]\nkind = \"uniform\"\n[run]\nt_max = 3000\n"
                                        "trajectories = 100\n"));
    const Hits seen = hits_of(system);
    const double area[2] = {12.0 - 0.49 * pi, 0.49 * pi}, length[2] = {14.0 + 1.4 * pi, 1.4 * pi};
    for (const int k : {0, 1}) {
      // Trajectories are independent, flights of one are not: what their ways differ from the
      // expected ones of as many flights.
      const double expected = pi * area[k] / length[k];
      double sum = 0.0, square = 0.0, all = 0.0;
      for (std::size_t t = 0, row = 0; t < seen.ends.size(); ++t) {
        double excess = 0.0;
        for (; row < seen.ends[t]; ++row) {
          const Hits::Row& r = seen.rows[row];
          if (r.region_before + 1 != k) continue;
          const Particle& particle = system.particles.front();
          excess +=
              r.event.flight_time * in_region(*system.table, particle, k - 1).speed - expected;
          all += 1.0;
        }
        sum += excess;
        square += excess * excess;
      }
      EXPECT_LT(std::fabs(sum), 4.0 * std::sqrt(square)) << region << k;
      EXPECT_GT(all, 10000.0);
    }
    EXPECT_EQ(lost(seen), 0);
  }
}

TEST(Regions, TurnAParticleBackAcrossAnEdgeOfTheirField) {
  const System system = system_of(box(half, of_half + "B = 4\n"));
  const double angle = 0.4, radius = 0.25;
  World world(*system.table, system.dynamics);
  world.add(Particle(), at({1.5, 1.5}, {std::cos(angle), std::sin(angle)}));
  Hits seen(system);
  world.limit_hits(2);
  world.run_until(10.0, seen);
  ASSERT_EQ(seen.rows.size(), 2u);
  const HitEvent &enters = seen.rows[0].event, &leaves = seen.rows[1].event;
  EXPECT_EQ(enters.before.x, enters.after.x);  // it passes an edge of the field as it is
  // omega > 0 turns it clockwise: down by the chord 2 r cos(angle) = 2 r |v_x| / v.
  EXPECT_NEAR(leaves.position.y - enters.position.y, -2.0 * radius * std::cos(angle), 2e-15);
  EXPECT_NEAR(leaves.flight_time, (pi + 2.0 * angle) * radius, 4e-15);
  EXPECT_NEAR(leaves.after.x, -std::cos(angle), 2e-15);
  EXPECT_NEAR(leaves.after.y, std::sin(angle), 2e-15);
}

/// A region that is as the outside changes nothing but the count of hits.
TEST(Regions, ThatAreAsTheOutsideAreNotThere) {
  for (const std::string field : {"", "[field]\nB = 0.8\n"}) {
    const std::string none = "[table]\nshape = \"rectangle\"\nwidth = 4\nheight = 3\n" + field;
    const System with = system_of(box(disc, of_disc, field)), without = system_of(none);
    for (const double angle : {0.3, 1.9, 4.0}) {
      expect_same_orbit(with, without, at({0.5, 1.0}, {std::cos(angle), std::sin(angle)}), 60.0,
                        1e-9);
    }
  }
}

TEST(Regions, AreFlownThroughBackwards) {
  const std::string rings =
      "[table]\nshape = \"circle\"\nradius = 2\n[[table.obstacle]]\nshape = \"circle\"\ncenter = "
      "[0, "
      "0]\nradius = 1\nname = \"core\"\n[[table.region]]\nwall = \"core\"\n";
  for (const char* region : {"index = 1.4\n", "potential = 0.2\n", "potential = -1\n"}) {
    const System system = system_of(rings + region);
    expect_way_back(system, at({1.5, 0.2}, {-0.8, 0.6}), 100.0, 20, 1e-11);
  }
}

TEST(Regions, MirrorAsWavesDo) {
  // From the left on the flat side at right angles: ((n - 1)/(n + 1))^2 of either polarisation.
  for (const char* which : {"s", "p"}) {
    const System system =
        system_of(box(half, of_half + "index = 3\nreflection = \"" + which + "\"\n",
                      "[initial]\nposition = [1, 1.5]\nvelocity = [1, 0]\n[run]\nt_max = 1.5\n"
                      "trajectories = 4000\n"));
    const Hits seen = hits_of(system);
    double mirrored = 0.0, all = 0.0;
    for (const Hits::Row& row : seen.rows) {
      all += 1.0;
      mirrored += row.region_after == -1;
    }
    EXPECT_EQ(all, 4000.0);
    EXPECT_NEAR(mirrored / all, 0.25, 4.0 * std::sqrt(0.1875 / all)) << which;
  }
}

/// A fraction that is typed: of a mirror that changes nothing else, and that of a wave.
TEST(Regions, MirrorByAFormula) {
  const Hits seen = hits_of(
      system_of(box(half, of_half + "reflection = \"0.3*n\"\n",
                    "[initial]\nposition = [1, 1.5]\nvelocity = [1, 0]\n[run]\nt_max = 1.5\n"
                    "trajectories = 4000\n")));
  double mirrored = 0.0;
  for (const Hits::Row& row : seen.rows) mirrored += row.region_after == -1;
  EXPECT_EQ(seen.rows.size(), 4000u);
  EXPECT_NEAR(mirrored / 4000.0, 0.3, 4.0 * std::sqrt(0.21 / 4000.0));

  const auto digest = [](const std::string& reflection) {
    return run_escape(
               system_of(box(disc, of_disc + "index = 1.5\nreflection = \"" + reflection + "\"\n",
                             "[initial]\nkind = \"uniform\"\n[run]\nt_max = 20\n"
                             "trajectories = 300\n")))
        .digest;
  };
  EXPECT_EQ(digest("((cos(incidence) - n*cos(refraction))/(cos(incidence) + n*cos(refraction)))^2"),
            digest("s"));
  EXPECT_EQ(digest("((cos(incidence)*n - cos(refraction))/(cos(incidence)*n + cos(refraction)))^2"),
            digest("p"));
  EXPECT_NE(digest("s"), digest("p"));
}

/// What is no fraction ends an orbit and says so; names that the formula has not are refused.
TEST(Regions, MirrorByNoOtherNumbers) {
  const EscapeResult result =
      run_escape(system_of(box(disc, of_disc + "reflection = \"2*sin(incidence)\"\n",
                               "[initial]\nkind = \"uniform\"\n[run]\nt_max = 20\n"
                               "trajectories = 100\n")));
  EXPECT_GT(result.counts.unresolved, 50u);
  ASSERT_FALSE(result.reports.empty());
  EXPECT_NE(result.reports.front().second.find("`reflection`"), std::string::npos);
  try {
    system_of(box(disc, of_disc + "reflection = \"sin(angle)\"\n"));
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("incidence"), std::string::npos) << error.what();
    EXPECT_GT(error.place().line, 0);
  }
}

TEST(Regions, GoOnFromAnyStateBitByBit) {
  const System system = system_of(box(disc, of_disc + "index = 1.5\nB = 0.7\n"));
  World whole(*system.table, system.dynamics);
  whole.add(system.particles[0], at({0.5, 1.0}, {0.6, 0.8}));
  whole.run_until(30.0);
  World part(*system.table, system.dynamics);
  part.add(system.particles[0], at({0.5, 1.0}, {0.6, 0.8}));
  State state = part.state(0);
  for (int k = 1; k <= 30; ++k) {
    part.run_until(k);
    state = part.state(0);
    part.clear();
    part.add(system.particles[0], state);
  }
  const State a = whole.state(0), b = part.state(0);
  EXPECT_EQ(a.wall, b.wall);
  EXPECT_EQ(a.u, b.u);
  EXPECT_EQ(a.velocity, b.velocity);
}

/// Discs on the edges of the cell, which particles cross within them.
TEST(Regions, LieAcrossTheCellsOfALattice) {
  const std::string lattice =
      "[table]\nshape = \"lorentz\"\nlattice = \"triangular\"\nspacing = 2.2\nradius = "
      "1\n[[table.region]]\nwall = \"disc_1\"\n";
  for (const char* region : {"B = 1\n", "index = 1.2\n", "potential = 0.2\nB = -0.5\n"}) {
    const System system = system_of(lattice + region +
                                    "[field]\nB = 0.3\n[initial]\nkind = \"uniform\"\n[run]\nt_max "
                                    "= 300\ntrajectories = 100\n");
    const Hits seen = hits_of(system);
    EXPECT_EQ(lost(seen), 0) << region;
    int inside = 0;
    for (const Hits::Row& row : seen.rows) inside += row.region_before == 0;
    EXPECT_GT(inside, 5000);
  }
}

/// Two discs that no cell holds whole: a start in the part of one that lies in the next cell is in
/// its region, too.
TEST(Regions, AreEnteredFromEveryCell) {
  const System system = system_of(
      "[table]\nshape = \"discs\"\ncenters = [[0, 0], [0.6, 0.5]]\nradius = 0.25\n[lattice]\n"
      "vectors = [[1, 0], [0, 1]]\n[[table.region]]\nwall = \"disc_1\"\nB = 0.1\n"
      "[[table.region]]\nwall = \"disc_2\"\nB = 0.1\n[initial]\nkind = \"uniform\"\n"
      "[run]\nt_max = 2\ntrajectories = 60000\n");
  const Hits seen = hits_of(system);
  double inside = 0.0;
  for (std::size_t t = 0, row = 0; t < seen.ends.size(); row = seen.ends[t++])
    inside += row < seen.ends[t] && seen.rows[row].region_before >= 0;
  const double share = 2.0 * pi * 0.25 * 0.25;
  EXPECT_NEAR(inside / 60000.0, share, 4.0 * std::sqrt(share * (1.0 - share) / 60000.0));
  EXPECT_EQ(lost(seen), 0);
}

/// The density of light is the square of the index; that of particles does not depend on a
/// potential.
TEST(Regions, OfAnIndexAreNotFilledUniformly) {
  const std::string uniform = "[initial]\nkind = \"uniform\"\n";
  const auto why = [&](const std::string& region) {
    return why_not_stationary(system_of(box(disc, of_disc + region, uniform)));
  };
  EXPECT_NE(why("index = 1.5\n").find("index"), std::string::npos);
  EXPECT_EQ(why("potential = 0.2\nB = 1\n"), "");
  // With a formula for what is mirrored, only if it is the same on the way back.
  EXPECT_EQ(why("potential = 0.2\nreflection = \"s\"\n"), "");
  EXPECT_EQ(why("potential = 0.2\nreflection = \"(incidence - refraction)^2\"\n"), "");
  EXPECT_EQ(why("B = 1\nreflection = \"0.3 + 0.1*incidence\"\n"), "");
  EXPECT_NE(why("potential = 0.2\nreflection = \"0.95/(1 + n^16)\"\n"), "");
  EXPECT_NE(why("potential = 0.2\nreflection = \"0.1*incidence\"\n"), "");
}

/// The fraction of the time that is spent in a half of a table agrees with what is said of it.
TEST(Regions, ThatMirrorMoreOnOneSideEmptyTheOther) {
  const auto inside = [](const std::string& reflection) {
    const System system = system_of(
        "[table]\nshape = \"polygon\"\npoints = [[0, 0], [2, 0], [4, 0], [4, 2], [2, 2], [0, 2]]\n"
        "[[table.region]]\nstart = [2, 2]\npieces = [{line_to = [2, 0]}]\npotential = 0.3\n"
        "reflection = \"" +
        reflection + "\"\n[initial]\nkind = \"uniform\"\n[run]\nt_max = 60\ntrajectories = 1000\n");
    const Hits seen = hits_of(system);
    double there = 0.0;
    for (const std::size_t end : seen.ends) there += seen.rows[end - 1].region_before >= 0;
    return std::pair(there / 1000.0, why_not_stationary(system));
  };
  const auto [balanced, nothing] = inside("0.5");
  EXPECT_EQ(nothing, "");
  const auto [emptied, why] = inside("0.95/(1 + n^16)");
  EXPECT_NE(why, "");
  EXPECT_LT(emptied, balanced - 0.15);
}

TEST(Regions, OfANumberedWallAreOneObstacle) {
  const std::string discs =
      "[table]\nshape = \"random-discs\"\nside = 4\nradius = 0.3\ncount = 5\nseed = 1\n"
      "[[table.region]]\nindex = 1.5\nwall = ";
  EXPECT_NO_THROW(system_of(discs + "\"disc_2\"\n"));
  EXPECT_THROW(system_of(discs + "\"disc\"\n"), InputError);
  const System polar = system_of(box(
      "name = \"d\"\nshape = \"polar\"\nradius = \"0.3\"\ncenter = [1, 0.5]\n",
      "wall = \"d\"\nindex = 1.5\n", "[[table.wall]]\nwall = \"d.inside\"\nlaw = \"diffuse\"\n"));
  for (const Wall& wall : polar.table->walls)
    EXPECT_EQ(wall.specularity, wall.name.starts_with("d_") ? 0.0 : 1.0) << wall.name;
}

/// A cut from corner to corner leaves the sides of a polygon one after the other, as drawn.
TEST(Regions, DoNotPartTheNamesOfWalls) {
  const System system = system_of(
      "[table]\nshape = \"polygon\"\npoints = [[0, 0], [2, 0], [4, 0], [4, 2], [2, 2], [0, 2]]\n"
      "[[table.hole]]\nwall = \"side\"\ncenter = 2\nwidth = 1\n"
      "[[table.region]]\nstart = [2, 2]\npieces = [{line_to = [2, 0]}]\nB = 1\n");
  ASSERT_EQ(system.table->holes.size(), 2u);
  EXPECT_EQ(system.table->wall(system.table->holes[0].wall).name, "side_1");
  EXPECT_EQ(system.table->holes[0].from, 0.75);
  EXPECT_EQ(system.table->wall(system.table->holes[1].wall).name, "side_2");
  EXPECT_EQ(system.table->holes[1].to, 0.25);
}

TEST(Regions, ThatChangeSpeedsHaveNoMeanFlight) {
  const auto of = [](const std::string& region) { return system_of(box(disc, of_disc + region)); };
  EXPECT_TRUE(std::isnan(measure(*of("index = 1.5\n").table).mean_flight));
  EXPECT_TRUE(std::isnan(measure(*of("potential = -1\n").table).mean_flight));
  System field = of("B = 1\n"), index = of("index = 1.5\n");
  EXPECT_GT(measure(*field.table).mean_flight, 0.0);
  for (System* system : {&field, &index}) {
    system->run.t_max = 10;
    system->run.times = {5, 10};
    system->run.trajectories = 2;
    system->run.free_paths = true;
  }
  EXPECT_NO_THROW(run_diffusion(field));
  EXPECT_THROW(run_diffusion(index), InputError);
}

TEST(Regions, GiveOneDigestHoweverTheWorkIsShared) {
  const System system =
      system_of(box(disc, of_disc + "index = 1.5\nreflection = \"s\"\n",
                    "[[table.hole]]\nwall = \"bottom\"\ncenter = 1\nwidth = 0.5\n[initial]\nkind = "
                    "\"uniform\"\n[run]\nt_max = 50\ntrajectories = 300\n"));
  const auto digest = [&](int threads, std::uint64_t block) {
    EscapeOptions how;
    how.threads = threads;
    how.block = block;
    return run_escape(system, how).digest;
  };
  EXPECT_EQ(digest(1, 64), digest(2, 7));
}

TEST(Regions, AreRefusedWhereTheyMeanNothing) {
  EXPECT_THROW(run_lyapunov(system_of(box(disc, of_disc + "index = 1.5\n"))), InputError);
  for (const std::string& bad :
       {box(disc, "wall = \"bottom\"\n"), box(disc, "wall = \"dics\"\n"),
        box(disc, of_disc + "index = 0\n"), box(disc, of_disc + "index = 2\npotential = 0.1\n"),
        box(disc, of_disc + "potential = 0.6\n"), box(disc, of_disc + "reflection = \"q\"\n"),
        box(disc, of_disc + "potential = 0.1\nreflection = \"p\"\n"),
        box(disc, of_disc + "[[table.region]]\n" + of_disc),
        box(disc, of_disc, "[[table.hole]]\nwall = \"disc\"\ncenter = 1\nwidth = 0.5\n"),
        box(disc, of_disc,
            "[[potential]]\nkind = \"harmonic\"\nomega = 1\n[integrator]\nstep = 0.01\n")})
    EXPECT_THROW(system_of(bad), InputError) << bad;
}

}  // namespace
}  // namespace carom
