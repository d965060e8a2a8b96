// carom section as a user sees it.
#include <gtest/gtest.h>

#include "program.hpp"

namespace carom {
namespace {

TEST(Section, PrintsItsKeysAndStoresItsPoints) {
  const Shell shell;
  const std::string command = "$carom section ellipse-magnetic --orbits 5 --points 100 --json ";
  const Outcome o = shell(command + "--threads 1 -o a.h5");
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_TRUE(is_json_object(o.out));
  EXPECT_EQ(json_value(o.out, "points"), "500");
  EXPECT_EQ(json_value(o.out, "orbits"), "5");
  for (const char* key : {"version", "seconds", "digest", "incomplete", "lost", "archive"})
    EXPECT_NE(json_value(o.out, key), "") << key;
  const Outcome two = shell(command + "--threads 2 -o b.h5");
  EXPECT_EQ(json_value(o.out, "digest"), json_value(two.out, "digest"));
  const Outcome same = shell("h5diff --exclude-path /provenance a.h5 b.h5 2>&1 || echo differ");
  if (same.out.find("not found") == std::string::npos) {
    EXPECT_EQ(same.out, "");
  }
}

TEST(Section, TakesListsAndGridsOfStarts) {
  const Shell shell;
  const std::string command =
      "$carom section ellipse-magnetic --points 20 --json --set initial.kind=birkhoff --set "
      "initial.wall=ellipse "
      "--set 'initial.s={from=0.1, to=4, count=3}' ";
  EXPECT_EQ(json_value(shell(command + "--set 'initial.v_parallel=[0.1,0.5]'").out, "points"),
            "120");
  EXPECT_EQ(json_value(shell(command + "--set initial.v_parallel=0").out, "points"), "60");
}

TEST(Section, ReadsEveryForm) {
  const Shell shell;
  for (const char* on : {"boundary", "wall:ellipse", "line:0,0:1,1/3", "segment:-1/2,0:1/2,0",
                         "circle:0,0,1/2", "x=1/10", "y=0", "vx=0", "vy=sqrt(2)/4"}) {
    const Outcome o = shell("$carom section ellipse-magnetic --orbits 3 --t-max 50 --json --on '" +
                            std::string(on) + "'");
    EXPECT_EQ(o.status, 0) << on << o.err;
    EXPECT_NE(json_value(o.out, "points"), "0") << on;
  }
  for (const char* on : {"wall:circle", "line:0,0", "line:0,0:0,0", "circle:0,0", "circle:0,0,-1",
                         "z=1", "x=", "x=a", "", "nowhere"}) {
    const Outcome o = shell("$carom section ellipse-magnetic --on '" + std::string(on) + "'");
    EXPECT_NE(o.status, 0) << on;
    EXPECT_EQ(o.out, "") << on;
    EXPECT_NE(o.err, "");
  }
  const Outcome direction = shell("$carom section ellipse-magnetic --direction positive");
  expect_refused(direction, "command line: section.direction: ");
}

TEST(Section, ComesFromTheFileToo) {
  const Shell shell;
  const Outcome o = shell(
      "$carom systems ellipse-magnetic > a.toml; printf '[section]\\non = \"y=0\"\\npoints = "
      "10\\norbits = 4\\n' >> a.toml; "
      "$carom section a.toml --json");
  EXPECT_EQ(json_value(o.out, "points"), "40") << o.err;
  const Outcome text = shell("$carom section a.toml");
  EXPECT_NE(text.out.find("40 "), std::string::npos) << text.out;
}

// On one wall the points may never come: there is a last time, wherever the wall is named.
// Such orbits would look for their first point for ever.
TEST(Section, NeedsWallsOrASurface) {
  const Shell shell;
  const Outcome o = shell("timeout 300 $carom section soft-lorentz --orbits 2 --points 3 -o a.h5"),
                line = shell("$carom section soft-lorentz --on vx=0 --orbits 2 --points 3");
  expect_refused(o, "section.on: ");
  EXPECT_TRUE(shell.files().empty());
  EXPECT_EQ(line.status, 0) << line.err;
}

TEST(Section, OnAWallEndsWhereverTheWallIsNamed) {
  const Shell shell;
  const std::string vertical =
      " --set initial.kind=point --position 0,0 --velocity 0,1 --set 'table.hole=[]' --points 5 "
      "--json --quiet";
  for (const char* on : {"--on wall:right", "--set section.on=wall:right"}) {
    const Outcome o = shell("timeout 300 $carom section stadium " + std::string(on) + vertical);
    EXPECT_EQ(o.status, 0) << on << o.err;
    EXPECT_EQ(json_value(o.out, "points"), "0") << on;
    EXPECT_EQ(json_value(o.out, "incomplete"), "1") << on;
  }
  shell("$carom systems stadium > a.toml; printf '[section]\non = \"wall:right\"\n' >> a.toml");
  const Outcome file = shell("timeout 300 $carom section a.toml" + vertical);
  EXPECT_EQ(file.status, 0) << file.err;
  EXPECT_EQ(json_value(file.out, "points"), "0");
  // All walls: the points come, unless a last time is asked for.
  const std::string closed =
      "$carom section stadium --set 'table.hole=[]' --orbits 1 --points 2000 --json --quiet";
  EXPECT_EQ(json_value(shell(closed + " --set section.on=boundary").out, "points"), "2000");
  EXPECT_EQ(json_value(shell(closed + " --set run.t_max=1/1000").out, "incomplete"), "1");
}

TEST(Section, WithoutALastTimeSaysSo) {
  const Shell shell;
  const Outcome o = shell("$carom section stadium --orbits 5 --points 1000");
  EXPECT_EQ(o.out.find("e+300"), std::string::npos) << o.out;
  EXPECT_NE(on_one_line(o.out).find("with fewer than 1 000 points without a last time"),
            std::string::npos)
      << o.out;
}

}  // namespace
}  // namespace carom
