// What the program prints and how it ends.
#include <gtest/gtest.h>

#include <ostream>

#include "carom/files/system_file.hpp"
#include "program.hpp"

namespace carom {
namespace {

const char* common_keys[] = {"version", "system", "seed",    "threads",
                             "engine",  "isa",    "seconds", "cpu_seconds"};

void expect_keys(const std::string& json, const std::vector<std::string>& keys) {
  EXPECT_TRUE(is_json_object(json)) << json;
  for (const char* key : common_keys) EXPECT_NE(json_value(json, key), "") << key;
  for (const std::string& key : keys) EXPECT_NE(json_value(json, key), "") << key;
}

TEST(Program, PrintsHelpWithoutArguments) {
  const Shell shell;
  for (const char* command : {"$carom", "$carom --help", "$carom -h"}) {
    const Outcome o = shell(command);
    EXPECT_EQ(o.status, 0);
    EXPECT_NE(o.out.find("carom escape magnetic-square"), std::string::npos);
    EXPECT_NE(o.out.find("carom run stadium"), std::string::npos);
    EXPECT_NE(o.out.find("carom table mushroom"), std::string::npos);
    EXPECT_EQ(o.err, "");
  }
  for (const char* command :
       {"escape", "run", "diffusion", "lyapunov", "section", "table", "systems", "validate"}) {
    const Outcome o = shell(std::string("$carom ") + command + " --help");
    EXPECT_EQ(o.status, 0);
    int examples = 0;
    const std::string example = "\n  carom " + std::string(command);
    for (std::size_t at = o.out.find("Examples:");
         (at = o.out.find(example, at)) != std::string::npos; ++at)
      ++examples;
    EXPECT_GE(examples, 3) << o.out;
  }
}

TEST(Systems, ListsAndPrints) {
  const Shell shell;
  const Outcome list = shell("$carom systems");
  EXPECT_EQ(list.status, 0);
  for (const char* name :
       {"magnetic-square", "mushroom", "stadium", "circle", "ellipse-magnetic", "sinai",
        "lorentz-triangular", "lorentz-square", "three-disc", "siam-photon"})
    EXPECT_NE(list.out.find(name), std::string::npos) << name;
  expect_keys(shell("$carom systems --json").out, {"systems"});
  EXPECT_EQ(shell("$carom systems mushroom > mine.toml && $carom table mine.toml").status, 0);
}

TEST(Table, Measures) {
  const Shell shell;
  expect_keys(shell("$carom table stadium --json").out,
              {"area", "perimeter", "mean_flight", "walls"});
  const Outcome open = shell("$carom table three-disc --json");
  EXPECT_EQ(json_value(open.out, "area"), "\"inf\"") << "no double holds it";
  expect_refused(shell("$carom table stadium -o stadium.h5"), "command line: -o: ");
}

TEST(Escape, PrintsItsKeysAndOneDigest) {
  const Shell shell;
  const std::string command = "$carom escape magnetic-square --trajectories 2e3 --t-max 100 --json";
  const Outcome one = shell(command + " --threads 1"), two = shell(command + " --threads 2");
  EXPECT_EQ(one.status, 0);
  EXPECT_EQ(one.err, "");
  expect_keys(one.out, {"trajectories", "escaped", "survived", "pinned", "capped", "singular",
                        "unbounded", "unresolved", "lost", "collisions", "digest", "decisions",
                        "survival", "survival_hits", "rate", "holes"});
  EXPECT_EQ(json_value(one.out, "trajectories"), "2000");
  EXPECT_EQ(json_value(one.out, "threads"), "1");
  EXPECT_EQ(json_value(one.out, "lost"), "0");
  EXPECT_EQ(json_value(one.out, "digest"), json_value(two.out, "digest"));
  EXPECT_EQ(json_value(one.out, "survival"), json_value(two.out, "survival"));
  EXPECT_NE(json_value(one.out, "digest"), json_value(shell(command + " --seed 2").out, "digest"));
  EXPECT_TRUE(shell.files().empty()) << "nothing is written without -o";
}

TEST(Escape, PrintsATable) {
  const Shell shell;
  const Outcome o = shell("$carom escape magnetic-square --trajectories 500 --times 1,10,100");
  EXPECT_EQ(o.status, 0);
  for (const char* part : {"500", "p(t)", "95 %", "survived"})
    EXPECT_NE(o.out.find(part), std::string::npos) << part;
}

// A table of many times takes no longer than its lines.
TEST(Escape, PrintsManyTimes) {
  const Shell shell;
  const Outcome o = shell(
      "timeout 300 $carom escape stadium --trajectories 10 --t-max 100 --times lin:0:100:100000 "
      "--quiet");
  EXPECT_EQ(o.status, 0);
  std::size_t intervals = 0;
  for (std::size_t at = 0; (at = o.out.find(" .. ", at)) != std::string::npos; ++at) ++intervals;
  EXPECT_EQ(intervals, 100000u + 99999u) << "of p at all times, of the rate but at the first, 0";
}

TEST(Escape, CountsAHoleAcrossTheStartOfAWallOnce) {
  const Shell shell;
  const Outcome o = shell(
      "$carom systems circle | sed 's/\"pi\"/0/' >wrapped.toml; $carom escape wrapped.toml "
      "--trajectories 1000 --json");
  EXPECT_EQ(o.status, 0) << o.err;
  const std::string holes = json_value(o.out, "holes");
  EXPECT_NE(holes.find("\"escaped\": " + json_value(o.out, "escaped")), std::string::npos) << holes;
}

TEST(Run, PrintsItsKeys) {
  const Shell shell;
  const Outcome o = shell("$carom run siam-photon --t-max 10 --json");
  EXPECT_EQ(o.status, 0);
  expect_keys(o.out, {"status", "collisions", "wall", "t", "x", "y", "vx", "vy", "cell",
                      "energy_error", "decisions"});
  EXPECT_EQ(json_value(o.out, "status"), "\"completed\"");
  EXPECT_EQ(json_value(o.out, "collisions"), "14");
  EXPECT_EQ(json_value(o.out, "t"), "10");
  EXPECT_NE(json_value(o.out, "decisions").find("\"share\": "), std::string::npos);
}

TEST(Run, StopsAfterSoManyCollisions) {
  const Shell shell;
  const Outcome o = shell("$carom run sinai --collisions 1e4 --json");
  EXPECT_EQ(json_value(o.out, "collisions"), "10000");
  EXPECT_EQ(json_value(o.out, "status"), "\"completed\"");
}

TEST(Run, SeveralParticlesFormAnArray) {
  const Shell shell;
  const Outcome o = shell("$carom run sinai --set particles.count=3 --t-max 20 --json");
  EXPECT_EQ(o.status, 0);
  expect_keys(o.out, {"status", "collisions", "particles"});
}

TEST(Run, ReadsExactNumbersThatStartWithAMinus) {
  const Shell shell;
  const Outcome apart =
      shell("$carom run sinai --position 1/10,1/5 --velocity '-sqrt(2),1' --t-max 3 --json");
  const Outcome joined =
      shell("$carom run sinai --position=1/10,1/5 --velocity='-sqrt(2),1' --t-max=3 --json");
  EXPECT_EQ(apart.status, 0) << apart.err;
  EXPECT_EQ(json_value(apart.out, "x"), json_value(joined.out, "x"));
  EXPECT_EQ(json_value(apart.out, "vx").front(), '-');
}

TEST(Validate, PassesItsCases) {
  const Shell shell;
  const Outcome o = shell("$carom validate --scale 0.002 --json");
  EXPECT_EQ(o.status, 0) << o.err << o.out;
  expect_keys(o.out, {"passed", "failed", "cases"});
  EXPECT_EQ(json_value(o.out, "failed"), "0");
  for (const char* part :
       {"three-disc: escape rate", "siam-photon", "\"source\"", "\"filter_share\"", "\"digest\""})
    EXPECT_NE(o.out.find(part), std::string::npos) << part;
}

TEST(StandardOutput, AFullStandardOutputIsAnError) {
  const Shell shell;
  const Outcome o = shell("$carom escape sinai --trajectories 10 --json > /dev/full");
  EXPECT_EQ(o.status, 1);
  EXPECT_EQ(o.err.rfind("carom: ", 0), 0u) << o.err;
}

// Starts that are listed are flown once, and repetitions are reported.
TEST(Escape, FliesListedStartsOnce) {
  const Shell shell;
  const Outcome point = shell("$carom escape siam-photon --t-max 10 --json");
  EXPECT_EQ(point.status, 0) << point.err;
  EXPECT_EQ(json_value(point.out, "trajectories"), "1");
  EXPECT_EQ(json_value(point.out, "note"), "");
  shell("printf '[table]\nshape = \"circle\"\nradius = 2\n' > a.toml");
  const std::string list =
      "$carom escape a.toml --t-max 5 --set particles.speed=1 --set initial.kind=list --set "
      "'initial.starts=[[0,0,1,0],[0,0.1,1,0.5],[0.2,0,0.3,1]]' ";
  EXPECT_EQ(json_value(shell(list + "--json").out, "trajectories"), "3");
  const Outcome more = shell(list + "--trajectories 9 --json"),
                text = shell(list + "--trajectories 9");
  const std::string note = json_value(more.out, "note");
  ASSERT_GT(note.size(), 2u) << more.out;
  EXPECT_NE(on_one_line(text.out).find(note.substr(1, note.size() - 2)), std::string::npos)
      << text.out;
  EXPECT_EQ(
      json_value(shell("$carom escape stadium --t-max 5 --trajectories 9 --json").out, "note"), "");
}

// Where flights bend D may still not exist: some orbits drift for ever, or none does.
TEST(Diffusion, DoubtsADThatTheMomentsDoNotShow) {
  const Shell shell;
  const std::string square = "$carom diffusion lorentz-square --json ";
  const auto note = [&](const std::string& options) {
    return json_value(shell(square + options).out, "note");
  };
  EXPECT_NE(note("--set field.B=2 --trajectories 10000 --t-max 1000").find("much farther"),
            std::string::npos);
  EXPECT_NE(note("--set table.radius=0.3 --set field.B=12 --trajectories 500").find("hardly grows"),
            std::string::npos);
  EXPECT_EQ(json_value(shell("$carom diffusion lorentz-triangular --json").out, "note"), "");
  const std::string left =
      "--set 'table.hole=[{wall=\"disc\", center=1, width=0.3}]' --trajectories 300 --t-max 20 ";
  const Outcome paths = shell("$carom diffusion lorentz-triangular --json --free-paths " + left);
  EXPECT_NE(json_value(paths.out, "note").find("particles left"), std::string::npos);
  EXPECT_NE(paths.out.find("\"expected_mean\": null"), std::string::npos) << paths.out;
}

// Nothing to draw from: that is known at once.
TEST(Escape, RefusesStartsThatCannotBeWithoutTrying) {
  const Shell shell;
  const char* impossible[] = {
      ("--set initial.kind=line --set 'initial.from=[0,0]' --set 'initial.to=[1,0]' "
       "--set initial.angle=1"),
      "--set initial.kind=rectangle --set 'initial.min=[0,0]' --set 'initial.max=[0,0]'",
      "--set initial.kind=rectangle --set 'initial.min=[2,0]' --set 'initial.max=[3,1]'"};
  for (const char* start : impossible) {
    const Outcome o =
        shell("timeout 300 $carom escape magnetic-square --trajectories 10 " + std::string(start));
    expect_refused(o, "command line: initial.");
  }
}

// Asked for by hand, lanes that nothing flies in are told of.
TEST(Commands, SayWhereNothingFliesInLanes) {
  const Shell shell;
  EXPECT_EQ(shell("$carom escape lorentz-random --trajectories 5 --t-max 2 --isa baseline --quiet")
                .err.rfind("carom: --isa", 0),
            0u);
  EXPECT_EQ(shell("$carom escape lorentz-random --trajectories 5 --t-max 2 --quiet").err, "");
  EXPECT_EQ(shell("$carom escape stadium --trajectories 5 --t-max 2 --isa baseline --quiet").err,
            "");
}

TEST(Commands, ClosedTakesTheHolesAway) {
  const Shell shell;
  const Outcome closed = shell("$carom table stadium --closed --json");
  EXPECT_EQ(closed.status, 0);
  EXPECT_NE(closed.out.find("\"holes\": []"), std::string::npos) << closed.out;
  EXPECT_EQ(
      shell("$carom run stadium --closed --collisions 50 --json | grep -v seconds").out,
      shell("$carom run stadium --set 'table.hole=[]' --collisions 50 --json | grep -v seconds")
          .out);
}

TEST(Commands, HelpOfACommandIsItsHelp) {
  const Shell shell;
  EXPECT_EQ(shell("$carom help escape").out, shell("$carom escape --help").out);
  EXPECT_EQ(shell("$carom help").out, shell("$carom --help").out);
  EXPECT_EQ(shell("$carom help nothing").status, 2);
}

// Three discs in the plane: a particle that leaves them has escaped.
TEST(Escape, CountsThoseThatFlyToInfinity) {
  const Shell shell;
  const std::string command = "$carom escape three-disc --trajectories 500 --t-max 50";
  const Outcome json = shell(command + " --json -o a.h5"), text = shell(command);
  EXPECT_EQ(json_value(json.out, "escaped"), "500") << json.out;
  EXPECT_EQ(json_value(json.out, "unbounded"), "500");
  EXPECT_EQ(json_value(json.out, "survived"), "0");
  EXPECT_NE(text.out.find("  escaped                            500  100.00000 %\n    unbounded "),
            std::string::npos)
      << text.out;
  EXPECT_EQ(json_value(shell("$carom escape --resume a.h5 --json").out, "escaped"), "500");
  EXPECT_EQ(json_value(shell("$carom run three-disc --json").out, "status"), "\"unbounded\"");
  EXPECT_NE(shell("$carom run three-disc").out.find("escaped to infinity"), std::string::npos);
}

// What was written is what is printed: 0.2, and the wall's own coordinate.
TEST(Numbers, AreExactWhereTheyCanBe) {
  const Shell shell;
  const Outcome table = shell(
      "$carom table stadium --set table.hole[0].width=0.2 --set table.hole[0].center=0.9 "
      "--json");
  EXPECT_NE(table.out.find("\"center\": 0.9, \"width\": 0.2"), std::string::npos) << table.out;
  int left = 0;
  for (int i = 0; i < 40; ++i) {
    const Outcome o = shell("$carom run stadium --json --trajectory " + std::to_string(i));
    if (json_value(o.out, "status") != "\"escaped\"") continue;
    ++left;
    EXPECT_EQ(json_value(o.out, "y"), "-1") << i;
  }
  EXPECT_GT(left, 30);
}

}  // namespace
}  // namespace carom
