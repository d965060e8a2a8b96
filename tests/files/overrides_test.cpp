// --set and the other options of the command line.
#include "system_text.hpp"

namespace carom::tests {
namespace {

TEST(Overrides, SetReachesEveryValue) {
  EXPECT_EQ(read(square(), set("run.t_max", "1/3")).run.t_max, 1.0 / 3);
  EXPECT_EQ(read(square(), set("run.trajectories", "1e3")).run.trajectories, 1000u);
  EXPECT_EQ(read(square(), set("title", "some words")).title, "some words");
  EXPECT_EQ(read(square(), set("run.times", "[1, 2]")).run.times, (std::vector<double>{1, 2}));
  EXPECT_EQ(measure(*read(square(), set("table.width", "2.5")).table).area, 2.5);
  const std::string hole = square("[[table.hole]]\nwall = \"top\"\ncenter = 0.5\nwidth = 0.1\n");
  const System changed = read(hole, set("table.hole[0].wall", "left"));
  EXPECT_EQ(changed.table->holes[0].wall, changed.table->wall_index("left"));
  SystemOverrides append = set("table.hole[1].wall", "left");
  append.set.emplace_back("table.hole[1].center", "0.5");
  append.set.emplace_back("table.hole[1].width", "0.2");
  EXPECT_EQ(read(hole, append).table->holes.size(), 2u);
  EXPECT_EQ(measure(*read("[table]\nshape = \"polygon\"\npoints = [[0, 0], [1, 0], [0, 1]]\n",
                          set("table.points[2][1]", "4"))
                         .table)
                .area,
            2.0);
}

TEST(Overrides, SetReplacesWhatItExcludes) {
  const std::string field = square("[field]\nlarmor_radius = 2\n[particles]\nspeed = 1\n");
  EXPECT_EQ(read(field, set("field.B", "3")).particles[0].omega, 3.0);
  EXPECT_EQ(read(field, set("particles.energy", "8")).particles[0].speed, 4.0);
}

// The fault is on the command line, at this key or option.
void expect_blamed(const SystemOverrides& overrides, const std::string& key) {
  const InputError error = fault(square(), overrides);
  EXPECT_EQ(error.place().file, "command line") << error.what();
  EXPECT_EQ(error.place().key, key) << error.what();
}

TEST(Overrides, FaultsAreOnTheCommandLine) {
  expect_blamed(set("table.widht", "1"), "table.widht");
  EXPECT_EQ(fault(square(), set("table.widht", "1")).nearest(), "width");
  EXPECT_EQ(fault(square(), set("rnu.t_max", "1")).nearest(), "run");
  for (const char* path : {"table.width", "table.width.x", "table.hole[1].wall", "table.width[0]"})
    expect_blamed(set(path, "wide"), path);
  for (const char* path : {"", "table.", ".x", "table..x", "a[", "a[x]", "a[1]b", "[0]"})
    expect_blamed(set(path, "1"), "--set");
}

TEST(Overrides, OptionsOfTheRunAreRead) {
  SystemOverrides o;
  o.seed = "18446744073709551615";
  o.trajectories = "1e9";
  o.t_max = "2*pi";
  o.collisions = "1_000";
  const RunPlan run = read(square("[run]\nseed = 5\n"), o).run;
  EXPECT_EQ(run.seed, UINT64_MAX);
  EXPECT_EQ(run.trajectories, 1000000000u);
  EXPECT_EQ(run.t_max, 6.283185307179586);
  EXPECT_EQ(run.collisions, 1000u);
  EXPECT_EQ(run.times.back(), run.t_max);  // the default times follow
}

TEST(Overrides, TimesHaveTheirOwnNotation) {
  const auto times = [](const std::string& text) {
    SystemOverrides o;
    o.times = text;
    return read(square(), o).run.times;
  };
  EXPECT_EQ(times("1,5/2,1e2"), (std::vector<double>{1, 2.5, 100}));
  EXPECT_EQ(times("7"), std::vector<double>{7});
  EXPECT_EQ(times("lin:0:2:5"), (std::vector<double>{0, 0.5, 1, 1.5, 2}));
  EXPECT_EQ(times("log:1/10:1000:5").front(), 0.1);
  EXPECT_EQ(times("log:1/10:1000:5").size(), 5u);
  SystemOverrides o;
  for (const char* bad :
       {"log:1:2", "exp:1:2:3", "log:1:2:3:4", "1,,2", ",", "a,b", "2,1", "1,1e4", "log:0:1:5"}) {
    o.times = bad;
    expect_blamed(o, "--times");
  }
}

TEST(Overrides, AShorterRunCutsTheTimesOfTheFile) {
  SystemOverrides o;
  o.t_max = "10.5";
  const LoadedSystem loaded =
      read_system(square("[run]\ntimes = [0.1, 5, 10.5, 20]\n"), "test.toml", o);
  EXPECT_EQ(loaded.system.run.times, (std::vector<double>{0.1, 5, 10.5}));
  EXPECT_EQ(read(loaded.resolved_toml).run.times, loaded.system.run.times);
  o.times = "1,20";
  expect_blamed(o, "--times");
}

TEST(Overrides, PositionAndVelocityReplaceTheStart) {
  SystemOverrides o;
  o.position = "1/10,-1/5";
  o.velocity = "3,4";
  const System s = read(square("[initial]\nkind = \"boundary\"\nwall = \"top\"\n"), o);
  EXPECT_EQ(s.initial.kind, InitialCondition::Kind::point);
  EXPECT_EQ(s.initial.position, (geometry::Vector{0.1, -0.2}));
  EXPECT_EQ(s.initial.velocity, (geometry::Vector{3, 4}));
  EXPECT_EQ(s.particles[0].speed, 5.0);
  EXPECT_EQ(read(square("[particles]\nspeed = 2\n"), o).particles[0].speed, 2.0);

  const std::string point =
      square("[initial]\nkind = \"point\"\nposition = [0.1, 0.2]\nangle = 0\n");
  o.position.clear();
  EXPECT_EQ(read(point, o).initial.position, (geometry::Vector{0.1, 0.2}));
  EXPECT_EQ(read(point, o).initial.velocity, (geometry::Vector{3, 4}));
  o.position = "0.3,0.4";
  o.velocity.clear();
  EXPECT_EQ(read(point, o).initial.position, (geometry::Vector{0.3, 0.4}));
  EXPECT_EQ(read(point, o).initial.velocity, (geometry::Vector{1, 0}));
  expect_blamed(o, "--position");
  o.velocity = "1,0";
  for (const char* bad : {"1", "1,2,3", "a,b", ",", "1;2", "nan,1"}) {
    o.position = bad;
    expect_blamed(o, "--position");
  }
  o.position = "0.5,0.5";
  o.velocity = "0,0";
  expect_blamed(o, "--velocity");
}

TEST(Overrides, BadOptionsAreNamed) {
  SystemOverrides o;
  for (const char* bad : {"0", "-5", "many", "1.5", "nan", "1e30"}) {
    o.trajectories = bad;
    expect_blamed(o, "--trajectories");
  }
  SystemOverrides t;
  for (const char* bad : {"0", "-1", "inf", "long", "1,5"}) {
    t.t_max = bad;
    expect_blamed(t, "--t-max");
  }
}

TEST(Overrides, AnAngleThatIsSetGoesWithThePosition) {
  SystemOverrides o = set("initial.angle", "pi/2");
  o.position = "0.3,0.4";
  const System s = read(square(), o);
  EXPECT_EQ(s.initial.position, (geometry::Vector{0.3, 0.4}));
  EXPECT_EQ(s.initial.velocity, (geometry::Vector{0, 1}));
  o.velocity = "1,0";
  expect_blamed(o, "initial.angle");
  SystemOverrides v = set("initial.velocity", "[0, 1]");
  v.position = "0.3,0.4";
  EXPECT_EQ(read(square(), v).initial.velocity, (geometry::Vector{0, 1}));
}

// One of the two would be lost without a word.
TEST(Overrides, AStartIsGivenOnce) {
  struct Given {
    const char *path, *value, *key;
  };
  for (const auto& [path, value, key] :
       {Given{"initial.kind", "uniform", "initial.kind"},
        Given{"initial", "{kind = \"uniform\"}", "initial.kind"},
        Given{"initial.position", "[0.1, 0.1]", "initial.position"},
        Given{"initial.velocity", "[0, 1]", "initial.velocity"}}) {
    SystemOverrides o = set(path, value);
    o.position = "0.3,0.4";
    o.velocity = "1,0";
    expect_blamed(o, key);
  }
}

TEST(Overrides, WindowIsAPairOfNumbers) {
  SystemOverrides o;
  o.window = "1/3:pi";
  EXPECT_EQ(read(square(), o).run.window, (std::pair{1.0 / 3, 3.141592653589793}));
  for (const char* bad : {"1", "1:2:3", "2:1", "a:b", "-1:3", "1,2"}) {
    o.window = bad;
    expect_blamed(o, "--window");
  }
}

// A stored system has its default times written out; they are still those of its t_max.
TEST(Overrides, DefaultTimesOfAStoredSystemFollowItsLastTime) {
  const std::string stored = read_system(square("[run]\nt_max = 100\n"), "test.toml").resolved_toml;
  for (const char* t_max : {"2000", "20"}) {
    SystemOverrides o;
    o.t_max = t_max;
    EXPECT_EQ(read(stored, o).run.times, read(square(), o).run.times) << t_max;
  }
  SystemOverrides changed = set("run.times.count", "11");
  changed.t_max = "200";
  EXPECT_EQ(read(stored, changed).run.times.size(), 11u);
  EXPECT_EQ(read(stored).run.times.back(), 100);
}

TEST(Overrides, ListedStartsGiveTheNumberOfTrajectories) {
  const std::string list =
      square("[initial]\nkind = \"list\"\nstarts = [[0.5,0.5,1,0],[0.4,0.5,1,0],[0.3,0.5,1,0]]\n");
  EXPECT_EQ(read(list).run.trajectories, 3u);
  EXPECT_EQ(read(list + "[particles]\ncount = 2\n").run.trajectories, 2u);
  EXPECT_EQ(read(list + "[run]\ntrajectories = 7\n").run.trajectories, 7u);
  EXPECT_EQ(read(square()).run.trajectories, 100000u);
  const std::string hole = "[[table.hole]]\nwall = \"top\"\ncenter = 0.5\nwidth = 0.1\n";
  EXPECT_EQ(read(square(hole + "[initial]\nkind = \"point\"\nposition = [0.5,0.5]\nangle = 1\n"))
                .run.trajectories,
            1u);
  EXPECT_EQ(read(square(hole + "[initial]\nkind = \"point\"\nposition = [0.5,0.5]\nangle = 1\n"
                               "[[injection]]\nhole = \"hole_1\"\nrate = 1\n"))
                .run.trajectories,
            100000u)
      << "what enters is drawn";
}

TEST(Overrides, TimesTooCloseForDoublesAreRefused) {
  SystemOverrides o;
  o.times = "log:100:100.0000000000001:31";
  expect_blamed(o, "--times");
  o.times = "lin:100:100.0000000000001:5";
  EXPECT_EQ(read(square(), o).run.times.size(), 5u);
}

}  // namespace
}  // namespace carom::tests
