// Walls that reflect at random: Lambert's law, and the same bits however the work is shared.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "carom/analyses/escape.hpp"
#include "carom/analyses/lyapunov.hpp"
#include "carom/analyses/run.hpp"
#include "carom/base/error.hpp"
#include "carom/certify/certified_orbit.hpp"
#include "carom/engines/trajectories.hpp"
#include "carom/files/system_file.hpp"
#include "carom/geometry/curve_frame.hpp"

namespace carom {
namespace {

System system_of(const std::string& toml) { return read_system(toml, "test").system; }

const std::string stadium = "[table]\nshape = \"stadium\"\nhalf_length = 1\nradius = 1\n";
std::string walls(const std::string& law) { return "[[table.wall]]\nlaw = \"" + law + "\"\n"; }

// What leaves a wall.
class Hits : public Observer {
 public:
  explicit Hits(const Table& table) {
    for (const Wall& wall : table.walls) frames_.push_back(geometry::frame_of(wall.curve));
  }
  void hit(const HitEvent& e) override {
    const geometry::Vector normal =
        geometry::normal_at(frames_[static_cast<std::size_t>(e.wall)], e.u);
    const double speed = std::sqrt(dot(e.after, e.after));
    in.push_back(cross(normal, e.before) / speed);
    out.push_back(cross(normal, e.after) / speed);
    flights.push_back(e.flight_time);
    at.push_back(e.wall == 0 && std::fabs(e.position.x) < 0.25);
    worst_speed = std::max(worst_speed, std::fabs(speed - 1.0));
  }
  std::vector<double> in, out, flights;
  std::vector<bool> at;  // in the middle of the first wall
  double worst_speed = 0.0;

 private:
  std::vector<geometry::CurveFrame> frames_;
};

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double aa = 0.0, bb = 0.0, ab = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    aa += a[i] * a[i], bb += b[i] * b[i], ab += a[i] * b[i];
  return ab / std::sqrt(aa * bb);
}

// The largest distance of the distribution from a uniform one over (-1, 1), times sqrt(n).
double kolmogorov(std::vector<double> x) {
  std::sort(x.begin(), x.end());
  const auto n = static_cast<double>(x.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i)
    worst = std::max(worst, std::fabs(0.5 * (x[i] + 1.0) - (static_cast<double>(i) + 0.5) / n));
  return worst * std::sqrt(n);
}

Hits hits_of(const System& system) {
  Hits seen(*system.table);
  for_each_trajectory(system, {0, system.run.trajectories}, seen);
  return seen;
}

TEST(Scattering, OfDiffuseWallsForgetsTheWayIn) {
  const System system =
      system_of(stadium + walls("diffuse") + "[run]\nt_max = 200\ntrajectories = 200\n");
  const Hits seen = hits_of(system);
  const auto n = static_cast<double>(seen.out.size());
  ASSERT_GT(n, 10000);
  EXPECT_LT(kolmogorov(seen.out), 1.95);  // exceeded by one in a thousand
  EXPECT_LT(std::fabs(correlation(seen.in, seen.out)), 3.3 / std::sqrt(n));
  EXPECT_LT(seen.worst_speed, 1e-14);
  // Flights have the mean pi A/L whatever walls do, as long as all directions stay equally likely.
  double sum = 0.0, square = 0.0;
  for (const double flight : seen.flights) sum += flight, square += flight * flight;
  const double mean = sum / n, error = std::sqrt((square / n - mean * mean) / n);
  EXPECT_NEAR(mean, measure(*system.table).mean_flight, 4.0 * error);
}

// The largest distance of the distribution from that with the given function, times sqrt(n).
template <class Distribution>
double kolmogorov_from(std::vector<double> x, const Distribution& below) {
  std::sort(x.begin(), x.end());
  const auto n = static_cast<double>(x.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i)
    worst = std::max(worst, std::fabs(below(x[i]) - (static_cast<double>(i) + 0.5) / n));
  return worst * std::sqrt(n);
}

std::string thermal(double temperature) {
  return walls("thermal") + "temperature = " + std::to_string(temperature) + "\n";
}

class Velocities : public Observer {
 public:
  explicit Velocities(const Table& table) {
    for (const Wall& wall : table.walls) frames_.push_back(geometry::frame_of(wall.curve));
  }
  void hit(const HitEvent& e) override {
    const geometry::CurveFrame& frame = frames_[static_cast<std::size_t>(e.wall)];
    const geometry::Vector n = geometry::normal_at(frame, e.u);
    normal.push_back(dot(n, e.after));
    along.push_back(cross(n, e.after));
    change = std::max(change, std::fabs(dot(e.before, e.before) / square_ - 1.0));
    square_ = dot(e.after, e.after);
  }
  void end(const EndEvent&) override { square_ = start; }
  std::vector<double> normal, along;
  double start = 1.0, change = 0.0;  // of the squared speed within a flight

 private:
  std::vector<geometry::CurveFrame> frames_;
  double square_ = 1.0;
};

TEST(Scattering, OfThermalWallsIsTheFluxOfAGas) {
  for (const char* field : {"", "[field]\nB = 0.5\n"}) {
    const System system = system_of(stadium + thermal(0.25) + field +
                                    "[particles]\nmass = 2\n[run]\nt_max = 300\n"
                                    "trajectories = 200\n");
    Velocities seen(*system.table);
    for_each_trajectory(system, {0, system.run.trajectories}, seen);
    ASSERT_GT(seen.normal.size(), 10000u);
    EXPECT_LT(seen.change, 1e-13);
    // m/T is 8.
    EXPECT_LT(kolmogorov_from(seen.normal, [](double v) { return 1.0 - std::exp(-4.0 * v * v); }),
              1.95);
    EXPECT_LT(kolmogorov_from(seen.along, [](double v) { return 0.5 * std::erfc(-2.0 * v); }),
              1.95);
    EXPECT_LT(std::fabs(correlation(seen.normal, seen.along)),
              3.3 / std::sqrt(static_cast<double>(seen.normal.size())));
  }
}

TEST(Scattering, BetweenThermalWallsAGasHasTheirTemperature) {
  const System system =
      system_of(stadium + thermal(2) + "[run]\nt_max = 40\ntrajectories = 4000\n");
  class Sampled : public Observer {
   public:
    void end(const EndEvent& e) override {
      squares.push_back(dot(e.state.velocity, e.state.velocity));
    }
    std::vector<double> squares;
  } seen;
  for_each_trajectory(system, {0, system.run.trajectories}, seen);
  EXPECT_LT(kolmogorov_from(seen.squares, [](double v) { return 1.0 - std::exp(-0.25 * v); }),
            1.95);
}

TEST(Scattering, ThermalWallsAreRefusedWhereOneSpeedCounts) {
  const auto fault = [](const std::string& toml) {
    try {
      system_of(toml);
    } catch (const InputError& error) {
      return error.place().key;
    }
    return std::string("no fault");
  };
  EXPECT_EQ(fault(stadium + thermal(1)), "no fault");
  EXPECT_EQ(fault(stadium + thermal(0)), "table.wall[0].temperature");
  EXPECT_EQ(fault(stadium + thermal(-1)), "table.wall[0].temperature");
  EXPECT_NE(fault(stadium + thermal(1) + "[[potential]]\nkind = \"harmonic\"\nomega = 1\n"),
            "no fault");
}

TEST(Scattering, OfMixedWallsMirrorsItsShare) {
  const System system = system_of(stadium + "[[table.wall]]\nlaw = \"mixed\"\nspecularity = 0.3\n" +
                                  "[run]\nt_max = 200\ntrajectories = 100\n");
  const Hits seen = hits_of(system);
  double mirrored = 0.0;
  for (std::size_t i = 0; i < seen.in.size(); ++i)
    mirrored += std::fabs(seen.in[i] - seen.out[i]) < 1e-12;
  const auto n = static_cast<double>(seen.in.size());
  EXPECT_NEAR(mirrored / n, 0.3, 4.0 * std::sqrt(0.21 / n));
}

TEST(Scattering, OfOneWallLeavesTheOthersMirrors) {
  const System system = system_of(
      "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 2\n[[table.wall]]\nlaw = \"diffuse\"\n"
      "wall = \"bottom\"\n[run]\nt_max = 50\ntrajectories = 20\n");
  const Hits seen = hits_of(system);
  EXPECT_EQ(system.table->walls[0].specularity, 0.0);
  std::size_t same = 0;
  for (std::size_t i = 0; i < seen.in.size(); ++i)
    same += std::fabs(seen.in[i] - seen.out[i]) < 1e-12;
  EXPECT_GT(same, seen.in.size() / 2);
  EXPECT_LT(same, seen.in.size());
}

TEST(Scattering, OfRoughWallsTurnsTheNormalByTheAngle) {
  const System system = system_of(stadium + "[[table.wall]]\nlaw = \"rough\"\nangle = 0.1\n" +
                                  "[run]\nt_max = 200\ntrajectories = 50\n");
  const Hits seen = hits_of(system);
  double square = 0.0, most = 0.0, n = 0.0;
  for (std::size_t i = 0; i < seen.in.size(); ++i) {
    if (std::fabs(seen.in[i]) > 0.9) continue;  // far from grazing no number is tried again
    const double turned = std::asin(seen.out[i]) - std::asin(seen.in[i]);
    square += turned * turned;
    most = std::max(most, std::fabs(turned));
    n += 1.0;
  }
  EXPECT_NEAR(square / n, 0.04 / 3.0, 4.0 * 0.012 / std::sqrt(n));
  EXPECT_LE(most, 0.2 + 1e-12);
  EXPECT_LT(seen.worst_speed, 1e-14);
}

TEST(Scattering, OfAHoleLetsItsSharePass) {
  const std::string hole = stadium +
                           "[[table.hole]]\nwall = \"bottom\"\ncenter = 1\nwidth = 0.5\n"
                           "transmission = 0.25\n[run]\nt_max = 2000\ntrajectories = 4000\n";
  const System system = system_of(hole);
  const Hits seen = hits_of(system);
  double mirrored = 0.0;
  for (std::size_t i = 0; i < seen.at.size(); ++i) mirrored += seen.at[i];
  // Each particle is mirrored there until it passes: 3 times in the mean, +- sqrt(12).
  EXPECT_NEAR(mirrored / 4000.0, 3.0, 4.0 * std::sqrt(12.0 / 4000.0));
  EXPECT_THROW(run_lyapunov(system), InputError);
}

TEST(Scattering, GivesOneDigestHoweverTheWorkIsShared) {
  const auto digest = [&](const std::string& law, int threads, std::uint64_t block) {
    EscapeOptions how;
    how.threads = threads;
    how.block = block;
    return run_escape(system_of(stadium + law +
                                "[[table.hole]]\nwall = \"bottom\"\ncenter = 0.5\nwidth = 0.3\n"
                                "[run]\nt_max = 50\ntrajectories = 300\n"),
                      how)
        .digest;
  };
  const auto one = digest(walls("diffuse"), 1, 64);
  EXPECT_EQ(digest(walls("diffuse"), 2, 64), one);
  EXPECT_EQ(digest(walls("diffuse"), 2, 7), one);
  EXPECT_EQ(digest(thermal(0.5), 1, 64), digest(thermal(0.5), 2, 7));
  System mirrors = system_of(stadium +
                             "[[table.hole]]\nwall = \"bottom\"\ncenter = 0.5\n"
                             "width = 0.3\n[run]\nt_max = 50\ntrajectories = 300\n");
  const System specular = system_of(stadium + walls("specular") +
                                    "[[table.hole]]\nwall = \"bottom\"\ncenter = 0.5\nwidth = 0.3\n"
                                    "[run]\nt_max = 50\ntrajectories = 300\n");
  EXPECT_EQ(run_escape(specular).digest, run_escape(mirrors).digest);
  EXPECT_NE(run_escape(mirrors).digest, one);
}

TEST(Scattering, IsRefusedWhereItMeansNothing) {
  const System system = system_of(stadium + walls("diffuse"));
  EXPECT_THROW(run_lyapunov(system), InputError);
  EXPECT_THROW(
      run_escape(system_of(stadium + walls("diffuse") +
                           "[[potential]]\nkind = \"harmonic\"\nomega = 1\n[integrator]\nstep = "
                           "0.01\n[run]\nt_max = 1\ntrajectories = 1\n")),
      InputError)
      << "forces";
  EXPECT_THROW(system_of(stadium + walls("fuzzy")), InputError);
  EXPECT_THROW(system_of(stadium + walls("mixed")), InputError);
  EXPECT_THROW(system_of(stadium + walls("diffuse") + "specularity = 0.5\n"), InputError);
  EXPECT_THROW(system_of(stadium + "[[table.wall]]\nlaw = \"mixed\"\nspecularity = 1.5\n"),
               InputError);
  EXPECT_THROW(system_of(stadium + walls("diffuse") + "wall = \"botom\"\n"), InputError);
}

}  // namespace
}  // namespace carom
