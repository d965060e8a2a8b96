// What a system file means.
#include <cmath>

#include "files/toml/read.hpp"
#include "system_text.hpp"

namespace carom::tests {
namespace {

using Kind = InitialCondition::Kind;

TEST(System, DefaultsAreThoseOfTheGuide) {
  const System s = read(square());
  EXPECT_EQ(s.name, "test.toml");
  ASSERT_EQ(s.particles.size(), 1u);
  EXPECT_EQ(s.particles[0].speed, 1.0);
  EXPECT_EQ(s.particles[0].mass, 1.0);
  EXPECT_EQ(s.particles[0].charge, 1.0);
  EXPECT_EQ(s.particles[0].omega, 0.0);
  EXPECT_EQ(s.initial.kind, Kind::uniform);
  EXPECT_EQ(s.run.t_max, 1000.0);
  EXPECT_EQ(s.run.trajectories, 100000u);
  EXPECT_EQ(s.run.seed, 1u);
  EXPECT_EQ(s.run.collisions, 0u);
  EXPECT_EQ(s.run.sample, 0.0);
  ASSERT_EQ(s.run.times.size(), 31u);
  EXPECT_EQ(s.run.times.front(), 1.0);
  EXPECT_EQ(s.run.times.back(), 1000.0);
  EXPECT_NEAR(s.run.times[10], 10.0, 1e-14);
}

TEST(System, APositionAloneIsAPoint) {
  const System s = read(square("[initial]\nposition = [0.25, 0.5]\nvelocity = [3, 4]\n"));
  EXPECT_EQ(s.initial.kind, Kind::point);
}

TEST(System, FieldGivesTheCyclotronFrequency) {
  const auto omega = [](const std::string& text) { return read(square(text)).particles[0].omega; };
  EXPECT_EQ(omega("[field]\nB = 0.1\n"), 0.1);
  EXPECT_EQ(omega("[field]\nB = 0.3\n[particles]\nmass = 0.1\ncharge = -2\n"),
            -6.0);  // rounded once
  EXPECT_EQ(omega("[field]\nlarmor_radius = 0.5\n[particles]\nspeed = 3\n"), 6.0);
  EXPECT_EQ(omega("[field]\nlarmor_radius = 0.5\n[particles]\nspeed = 3\ncharge = -7\n"), -6.0);
  EXPECT_EQ(omega("[field]\nlarmor_radius = 2\n[particles]\ncount = 3\n"), 0.5);
  EXPECT_EQ(omega("[field]\nlarmor_radius = 2\n[particles]\nspeed = [1, 1]\n"), 0.5);
}

TEST(System, SpeedFollowsFromEnergyOrVelocity) {
  EXPECT_EQ(read(square("[particles]\nenergy = 2\n")).particles[0].speed, 2.0);
  EXPECT_EQ(read(square("[particles]\nenergy = 0.1\nmass = 0.2\n")).particles[0].speed, 1.0);
  const std::string start =
      "[initial]\nkind = \"point\"\nposition = [0.5, 0.5]\nvelocity = [3, -4]\n";
  const System free = read(square(start));
  EXPECT_EQ(free.particles[0].speed, 5.0);
  EXPECT_EQ(free.initial.velocity, (geometry::Vector{3, -4}));
  const std::string without_kind = "[initial]\nposition = [0.5, 0.5]\nvelocity = [3, -4]\n";
  EXPECT_EQ(read(square(without_kind)).particles[0].speed, 5.0);
  EXPECT_EQ(read(square("[particles]\nspeed = 2\n" + start)).particles[0].speed, 2.0);
  EXPECT_EQ(read(square("[particles]\nenergy = 2\n" + start)).particles[0].speed, 2.0);
  EXPECT_EQ(read(square("[field]\nlarmor_radius = 10\n" + start)).particles[0].omega, 0.5);
}

TEST(System, ListsMakeParticles) {
  const System s = read(square(
      "[field]\nB = 2\n[particles]\nmass = [1, 2, 4]\ncharge = [1, -1, \"1/2\"]\nspeed = 3\n"));
  ASSERT_EQ(s.particles.size(), 3u);
  EXPECT_EQ(s.particles[1].mass, 2.0);
  EXPECT_EQ(s.particles[1].omega, -1.0);
  EXPECT_EQ(s.particles[2].omega, 0.25);
  EXPECT_EQ(s.particles[2].speed, 3.0);
  EXPECT_EQ(read(square("[particles]\ncount = 4\n")).particles.size(), 4u);
}

TEST(System, EveryKindOfStartIsRead) {
  const auto initial = [](const std::string& text) {
    return read(square("[[table.hole]]\nwall = \"left\"\ncenter = 0.5\nwidth = 0.1\nname = "
                       "\"door\"\n[initial]\n" +
                       text))
        .initial;
  };
  EXPECT_EQ(initial("kind = \"boundary\"\n").walls, std::vector<int>{});
  EXPECT_EQ(initial("kind = \"boundary\"\nwall = \"top\"\n").walls, std::vector<int>{2});
  EXPECT_EQ(initial("kind = \"boundary\"\nhole = \"door\"\n").hole, 0);
  EXPECT_EQ(initial("kind = \"hole\"\nhole = \"door\"\n").kind, Kind::hole);
  const InitialCondition up =
      initial("kind = \"point\"\nposition = [\"1/2\", \"1/10\"]\nangle = \"pi/2\"\n");
  EXPECT_EQ(up.position, (geometry::Vector{0.5, 0.1}));
  EXPECT_EQ(up.velocity, (geometry::Vector{0, 1}));  // exactly up
  const InitialCondition box =
      initial("kind = \"rectangle\"\nmin = [0.1, 0.2]\nmax = [0.3, 0.4]\n");
  EXPECT_EQ(box.low, (geometry::Vector{0.1, 0.2}));
  EXPECT_EQ(box.high, (geometry::Vector{0.3, 0.4}));
  const InitialCondition line =
      initial("kind = \"line\"\nfrom = [0.1, 0.2]\nto = [0.3, 0.4]\nangle = 0.5\n");
  EXPECT_EQ(line.to, (geometry::Vector{0.3, 0.4}));
  EXPECT_EQ(line.angle, 0.5);
}

// Their pieces are shorter than the rounding of their places.
TEST(System, SmallCurvesFarAwayAreRefused) {
  const std::string text =
      "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1e13\n[[table.obstacle]]\nshape = "
      "\"polar\"\nradius = \"0.1 + 0.02*cos(3*phi)\"\ncenter = ";
  const auto distance = [&](const std::string& centre) {
    return read_system(text + centre + "\n", "near").system.table->curve_errors.distance;
  };
  EXPECT_LT(distance("[0.5, 1]"), 3e-15);
  EXPECT_GT(distance("[0.5, 1e3]"), 1e-13);  // the rounding of places counts
  EXPECT_THROW(read_system(text + "[0.5, 1e12]\n", "far"), InputError);
}

TEST(System, BirkhoffStartsPairListsAndCrossGrids) {
  const auto initial = [](const std::string& text) {
    return read(square("[initial]\nkind = \"birkhoff\"\nwall = \"right\"\n" + text)).initial;
  };
  const InitialCondition one = initial("s = \"1/3\"\nv_parallel = -0.5\n");
  EXPECT_EQ(one.s, std::vector<double>{1.0 / 3});
  EXPECT_EQ(one.v_parallel, std::vector<double>{-0.5});
  const InitialCondition pairs = initial("s = [0.1, 0.2]\nv_parallel = [0.3, 0.4]\n");
  EXPECT_EQ(pairs.s, (std::vector<double>{0.1, 0.2}));
  EXPECT_EQ(pairs.v_parallel, (std::vector<double>{0.3, 0.4}));
  const InitialCondition fan = initial("s = 0.25\nv_parallel = [0.3, 0.4]\n");
  EXPECT_EQ(fan.s, (std::vector<double>{0.25, 0.25}));
  const InitialCondition grid = initial(
      "s = {from = 0, to = 0.5, count = 3}\nv_parallel = {from = -0.5, to = 0.5, count = 2}\n");
  EXPECT_EQ(grid.s, (std::vector<double>{0, 0.25, 0.5, 0, 0.25, 0.5}));
  EXPECT_EQ(grid.v_parallel, (std::vector<double>{-0.5, -0.5, -0.5, 0.5, 0.5, 0.5}));
}

TEST(System, TimesAreRead) {
  const auto times = [](const std::string& text) {
    return read(square("[run]\nt_max = 100\n" + text)).run.times;
  };
  EXPECT_EQ(times("times = [0, 1, \"5/2\"]\n"), (std::vector<double>{0, 1, 2.5}));
  EXPECT_EQ(times("times = {from = 0, to = 1, count = 5, spacing = \"linear\"}\n"),
            (std::vector<double>{0, 0.25, 0.5, 0.75, 1}));
  const std::vector<double> log = times("times = {from = 0.1, to = 100, count = 4}\n");
  ASSERT_EQ(log.size(), 4u);
  EXPECT_EQ(log.front(), 0.1);
  EXPECT_NEAR(log[1], 1, 1e-15);
  EXPECT_NEAR(log[2], 10, 1e-14);
  EXPECT_EQ(log.back(), 100.0);
}

TEST(System, SpacedValuesIncreaseAndKeepTheirEnds) {
  for (const bool logarithmic : {false, true}) {
    const std::vector<double> values = files::spaced(0.1, 0.7, 1000, logarithmic);
    EXPECT_EQ(values.front(), 0.1);
    EXPECT_EQ(values.back(), 0.7);
    for (std::size_t k = 1; k < values.size(); ++k) EXPECT_LT(values[k - 1], values[k]);
  }
}

TEST(System, PathsAreRelativeToTheFile) {
  const System s = read(
      "[table]\nshape = \"path\"\n"
      "[[table.loop]]\nstart = [-1, 0]\n"
      "pieces = [{line_to = [1, 0], name = \"floor\"}, {arc_via = [0, 1], arc_to = [-1, 0], name = "
      "\"dome\"}]\n"
      "[[table.loop]]\nstart = [\"1/4\", \"1/4\"]\n"
      "pieces = [{ellipse_via = [0, 0.125], ellipse_to = [\"-1/4\", \"1/4\"], ellipse_ratio = "
      "0.5},\n"
      "          {ellipse_via = [0, 0.375], ellipse_to = [\"1/4\", \"1/4\"], ellipse_ratio = 0.5, "
      "name = "
      "\"lid\"}]\n"
      "[[table.hole]]\nwall = \"dome\"\ncenter = \"pi/2\"\nwidth = 0.2\n");
  ASSERT_EQ(s.table->walls.size(), 4u);
  EXPECT_EQ(s.table->wall_index("lid"), 3);
  EXPECT_EQ(s.table->walls[2].name, "wall_3");
  EXPECT_EQ(s.table->extent, Extent::bounded);
  EXPECT_EQ(s.table->holes[0].wall, 1);
  EXPECT_NEAR(measure(*s.table).area, 1.5707963267948966 * (1 - 1.0 / 16), 1e-14);
}

// "45 deg" is the diagonal, as pi/4 is, also where digits are guaranteed.
TEST(Angles, MayBeDegrees) {
  const auto velocity = [](const std::string& angle) {
    return read_system(
               "[table]\nshape = \"rectangle\"\nwidth = 1\nheight = 1\n[initial]\nkind = "
               "\"point\"\nposition = [0.5, 0.5]\nangle = " +
                   angle + "\n",
               "test.toml")
        .system.initial.velocity;
  };
  EXPECT_EQ(velocity("\"45 deg\""), velocity("\"pi/4\""));
  EXPECT_EQ(velocity("\"-90deg\""), (geometry::Vector{0, -1}));
  EXPECT_EQ(velocity("\"1e1*9 deg\""), (geometry::Vector{0, 1}));
  EXPECT_EQ(velocity("\"720 deg\""), (geometry::Vector{1, 0}));
  EXPECT_EQ(velocity("\"2 rad\""), velocity("2"));
  EXPECT_EQ(velocity("\"2*pi\""), (geometry::Vector{1, 0}));
  EXPECT_EQ(velocity("-6.283"), velocity("\"-6.283 rad\""));
  for (const char* large : {"45", "6.284", "-90", "\"7\""})
    EXPECT_THROW(velocity(large), InputError);
}

// The title says what was changed, once, and an archive's system has it.
TEST(Titles, SayWhatWasChanged) {
  SystemOverrides overrides;
  overrides.set = {{"table.spacing", "2.5"},
                   {"table.spacing", "2.3"},
                   {"field.B", "1/3"},
                   {"run.t_max", "10"},
                   {"initial.kind", "boundary"}};
  const LoadedSystem gas = load_system("lorentz-triangular", overrides);
  const std::string plain = load_system("lorentz-triangular").system.title;
  EXPECT_EQ(gas.system.title, plain + ", with table.spacing = 2.3, field.B = 1/3");
  const LoadedSystem again = read_system(gas.resolved_toml, "again.toml");
  EXPECT_EQ(again.system.title, gas.system.title);
  EXPECT_EQ(read_system(gas.resolved_toml, "again.toml", overrides).system.title, gas.system.title);
  overrides.set = {{"table.hole", "[]"}};
  EXPECT_TRUE(load_system("stadium", overrides).system.title.ends_with(", with no holes"));
  overrides.set = {{"title", "mine"}, {"field.B", "1"}};
  EXPECT_EQ(load_system("stadium", overrides).system.title, "mine");
}

// Where there are no walls, taking their holes away makes no table.
TEST(OpenPlanes, AreClosedAsTheyAre) {
  SystemOverrides overrides;
  overrides.set = {{"table.hole", "[]"}};
  const LoadedSystem closed = load_system("henon-heiles", overrides);
  EXPECT_EQ(closed.resolved_toml.find("[table]"), std::string::npos);
  EXPECT_TRUE(closed.system.table->walls.empty());
  overrides.set.emplace_back("table.radius", "1");
  try {
    load_system("henon-heiles", overrides);
    FAIL() << "a radius is no shape";
  } catch (const InputError& error) {
    EXPECT_EQ(error.place().key, "table.shape");
  }
}

}  // namespace
}  // namespace carom::tests
