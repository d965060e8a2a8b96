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

TEST(Overrides, FaultsAreOnTheCommandLine) {
  EXPECT_EQ(fault(square(), set("table.widht", "1")),
            "command line: table.widht: unknown key 'widht' for 'rectangle' (expected one of "
            "shape, width, "
            "height, obstacle, hole; did you mean 'width'?)");
  EXPECT_HAS(fault(square(), set("table.width", "wide")),
             "command line: table.width: unknown word 'wide'");
  EXPECT_HAS(fault(square(), set("rnu.t_max", "1")), "did you mean 'run'?");
  EXPECT_HAS(fault(square(), set("table.width.x", "1")), "'width' is a number, it has no key 'x'");
  EXPECT_HAS(fault(square(), set("table.hole[1].wall", "top")), "there is no 'hole[1]'");
  EXPECT_HAS(fault(square(), set("table.width[0]", "1")), "not a list");
  for (const char* path : {"", "table.", ".x", "table..x", "a[", "a[x]", "a[1]b", "[0]"}) {
    EXPECT_HAS(fault(square(), set(path, "1")), "cannot read the path") << path;
  }
}

TEST(Overrides, OptionsOfTheRun) {
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

TEST(Overrides, TimesInTheirOwnNotation) {
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
    EXPECT_HAS(fault(square(), o), "command line: --times") << bad;
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
  EXPECT_HAS(fault(square(), o), "command line: --times: the time 20 comes after t_max = 10.5");
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
  EXPECT_HAS(fault(square(), o), "command line: --position: no velocity is given");
  o.velocity = "1,0";
  for (const char* bad : {"1", "1,2,3", "a,b", ",", "1;2", "nan,1"}) {
    o.position = bad;
    EXPECT_HAS(fault(square(), o), "command line: --position") << bad;
  }
  o.position = "0.5,0.5";
  o.velocity = "0,0";
  EXPECT_HAS(fault(square(), o), "command line: --velocity: the velocity is zero");
}

TEST(Overrides, BadOptionsAreNamed) {
  SystemOverrides o;
  for (const char* bad : {"0", "-5", "many", "1.5", "nan", "1e30"}) {
    o.trajectories = bad;
    EXPECT_HAS(fault(square(), o),
               "command line: --trajectories: must be a whole number from 1 to ")
        << bad;
  }
  SystemOverrides t;
  for (const char* bad : {"0", "-1", "inf", "long", "1,5"}) {
    t.t_max = bad;
    EXPECT_HAS(fault(square(), t), "command line: --t-max: ") << bad;
  }
}

TEST(Overrides, AnAngleThatIsSetGoesWithThePosition) {
  SystemOverrides o = set("initial.angle", "pi/2");
  o.position = "0.3,0.4";
  const System s = read(square(), o);
  EXPECT_EQ(s.initial.position, (geometry::Vector{0.3, 0.4}));
  EXPECT_EQ(s.initial.velocity, (geometry::Vector{0, 1}));
  o.velocity = "1,0";
  EXPECT_HAS(fault(square(), o),
             "command line: initial.angle: initial.angle is given beside --velocity");
  SystemOverrides v = set("initial.velocity", "[0, 1]");
  v.position = "0.3,0.4";
  EXPECT_EQ(read(square(), v).initial.velocity, (geometry::Vector{0, 1}));
}

TEST(Overrides, WindowIsAPairOfNumbers) {
  SystemOverrides o;
  o.window = "1/3,pi";
  EXPECT_EQ(read(square(), o).run.window, (std::pair{1.0 / 3, 3.141592653589793}));
  for (const char* bad : {"1", "1,2,3", "2,1", "a,b", "-1,3"}) {
    o.window = bad;
    EXPECT_HAS(fault(square(), o), "command line: --window") << bad;
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

TEST(Overrides, TrajectoriesAreThoseThatAreListed) {
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

TEST(Overrides, TimesOfAGridThatDoublesCannotTellApartAreRefused) {
  SystemOverrides o;
  o.times = "log:100:100.0000000000001:31";
  EXPECT_HAS(fault(square(), o), "closer together than doubles");
  o.times = "lin:100:100.0000000000001:5";
  EXPECT_EQ(read(square(), o).run.times.size(), 5u);
}

}  // namespace
}  // namespace carom::tests
