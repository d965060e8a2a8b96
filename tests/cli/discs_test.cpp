// Hard discs on the command line: what is typed, refused, counted and stored.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "program.hpp"
#include "systems.hpp"

namespace carom {
namespace {

const std::string cradle = R"([table]
shape = "rectangle"
width = 10
height = 1
[interaction]
kind = "hard-discs"
radius = 0.25
[particles]
speed = [1, 0, 0, 0]
[initial]
kind = "list"
starts = [[0.75, 0.5, 1, 0], [4, 0.5, 1, 0], [4.5, 0.5, 1, 0], [5, 0.5, 1, 0]]
[run]
t_max = 7
)";
const std::string torus = discs_on_a_torus + "t_max = 100\n";
const std::string box = R"([table]
shape = "rectangle"
width = 4
height = 4
[[table.hole]]
wall = "bottom"
center = 2
width = 1
[interaction]
kind = "hard-discs"
radius = 0.25
[particles]
count = 6
[run]
t_max = 1
trajectories = 2000
)";

void store(const Shell& shell, const std::string& name, const std::string& text) {
  std::ofstream(shell.folder() + "/" + name) << text;
}

void expect_refused(const Shell& shell, const std::string& line,
                    const std::vector<std::string>& parts) {
  const Outcome o = shell(line);
  EXPECT_EQ(o.status, 1) << line;
  EXPECT_EQ(o.out, "") << line;
  for (const std::string& part : parts)
    EXPECT_NE(o.err.find(part), std::string::npos) << line << "\n" << o.err;
}

/// A column of an archive as doubles; empty where there is none.
std::vector<double> column(const Shell& shell, const std::string& file, const std::string& name) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const hid_t id = H5Fopen((shell.folder() + "/" + file).c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t data = H5Dopen2(id, name.c_str(), H5P_DEFAULT);
  std::vector<double> values;
  if (data >= 0) {
    const hid_t space = H5Dget_space(data);
    values.resize(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
    H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Sclose(space);
    H5Dclose(data);
  }
  H5Fclose(id);
  return values;
}

TEST(DiscsTyped, NewtonsCradleIsExact) {
  const Shell shell;
  store(shell, "cradle.toml", cradle);
  const Outcome o = shell("$carom run ./cradle.toml --json");
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(json_value(o.out, "contacts"), "3");
  for (const char* end :
       {"\"contacts\": 1, \"wall\": null, \"t\": 7, \"x\": 3.5, \"y\": 0.5, \"vx\": 0, \"vy\": 0",
        "\"t\": 7, \"x\": 4, \"y\": 0.5, \"vx\": 0, \"vy\": 0",
        "\"t\": 7, \"x\": 4.5, \"y\": 0.5, \"vx\": 0, \"vy\": 0",
        "\"t\": 7, \"x\": 9.25, \"y\": 0.5, \"vx\": 1, \"vy\": 0"})
    EXPECT_NE(o.out.find(end), std::string::npos) << end << "\n" << o.out;
  const Outcome text = shell("$carom run ./cradle.toml");
  EXPECT_NE(text.out.find("3 contacts"), std::string::npos) << text.out;
}

TEST(DiscsTyped, ContactsThatRoundingHidesEndBothDiscs) {
  const Shell shell;
  store(shell, "cradle.toml", cradle);
  for (const char* radius : {"1e-21", "1e-15", "1e-14"}) {
    const Outcome o =
        shell("$carom run ./cradle.toml --json --set 'interaction.radius=" + std::string(radius) +
              "' --set 'initial.starts=[[0.1,0.3,1,0],[4,0.3,1,0],[5,0.3,1,0],[6,0.3,1,0]]'");
    EXPECT_EQ(o.status, 3) << radius << o.out;
    EXPECT_EQ(json_value(o.out, "status"), "\"unresolved\"") << radius;
    EXPECT_EQ(o.out.find("\"x\": null"), std::string::npos) << radius;
  }
}

TEST(DiscsTyped, WhatCannotBeIsRefusedByName) {
  const Shell shell;
  store(shell, "cradle.toml", cradle);
  store(shell, "torus.toml", torus);
  store(shell, "box.toml", box);
  std::string near = cradle;
  near.replace(near.find("[4.5,"), 4, "[4.4");
  store(shell, "near.toml", near);
  for (const char* command : {"run", "escape --trajectories 3"})
    expect_refused(shell, std::string("$carom ") + command + " ./near.toml",
                   {"./near.toml, line 12", "initial.starts", "disc 2"});
  expect_refused(shell, "$carom run ./near.toml --set 'initial.starts=[[0.2,0.5,1,0]]'",
                 {"initial.starts", "(0.2, 0.5)"});
  expect_refused(
      shell,
      "$carom run ./torus.toml --set particles.count=30 --set interaction.radii=[] --set "
      "particles.mass=1 --set particles.speed=1",
      {"interaction"});
  expect_refused(shell, "$carom run ./box.toml --set particles.count=60", {"box.toml"});
  expect_refused(shell, "$carom run ./box.toml --set 'initial={kind=\"boundary\"}'", {"initial"});
  expect_refused(shell, "$carom run ./box.toml --engine steps --set integrator.step=0.1",
                 {"interaction"});
  expect_refused(
      shell,
      "$carom run ./box.toml --set 'potential=[{kind=\"harmonic\"}]' --set integrator.step=0.1",
      {"interaction"});
  expect_refused(shell, "$carom run ./box.toml --set 'interaction.radius=3'",
                 {"interaction", "radius"});
  expect_refused(shell, "$carom run ./torus.toml --set 'particles.speed=-1'", {"particles.speed"});
  expect_refused(
      shell,
      "$carom run ./torus.toml --set 'interaction={kind=\"coulomb\"}' --set integrator.step=0.1",
      {"interaction"});
}

TEST(DiscsTyped, RandomStartsLeaveRoom) {
  // Equal and unequal radii, with and without a field; dense ones are placed one after the other.
  const Shell shell;
  store(shell, "torus.toml", torus);
  store(shell, "box.toml", box);
  for (const char* line : {"./torus.toml", "./torus.toml --set field.B=0.5", "./box.toml",
                           "./box.toml --set particles.count=20"})
    for (const char* seed : {"1", "2", "3"}) {
      const Outcome o = shell(std::string("$carom run --quiet --json ") + line + " --seed " + seed);
      ASSERT_EQ(o.status, 0) << line << o.err;
      EXPECT_NE(json_value(o.out, "contacts"), "0");
    }
}

TEST(DiscsTyped, AllowedArrangementsAreEquallyLikely) {
  // Two discs on a torus: the probability of a contact's neighbourhood follows from areas alone.
  // With sigma = 1.4, distances below 1.7 have the share pi (1.7^2 - 1.4^2) / (16 - pi 1.4^2).
  const Shell shell;
  store(shell, "two.toml",
        "[lattice]\nvectors = [[4, 0], [0, 4]]\n[interaction]\nkind = \"hard-discs\"\n"
        "radius = 0.7\n[particles]\ncount = 2\n[run]\nt_max = 1e-9\ntrajectories = 20000\n");
  ASSERT_EQ(shell("$carom escape ./two.toml --per-trajectory -o a.h5 --quiet").status, 0);
  const auto x = column(shell, "a.h5", "trajectories/x"),
             y = column(shell, "a.h5", "trajectories/y");
  ASSERT_EQ(x.size(), 40000u);
  double near = 0.0;
  for (std::size_t i = 0; i < x.size(); i += 2) {
    const double d =
        std::hypot(std::remainder(x[i] - x[i + 1], 4.0), std::remainder(y[i] - y[i + 1], 4.0));
    EXPECT_GE(d, 1.4);
    near += d < 1.7;
  }
  const double pi = 3.141592653589793, p = pi * (1.7 * 1.7 - 1.4 * 1.4) / (16.0 - pi * 1.4 * 1.4);
  EXPECT_NEAR(near / 20000, p, 4.0 * std::sqrt(p * (1 - p) / 20000));
}

TEST(DiscsTyped, DiscsLeaveAHoleAtTheRateOfTheirCentres) {
  // The centres have the square of side 4 - 2 r and leave through an opening of its width: e v /
  // (pi A).
  const Shell shell;
  store(shell, "box.toml", box);
  const Outcome o = shell("$carom escape ./box.toml --json --quiet --trajectories 20000");
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(json_value(o.out, "lost"), "0");
  EXPECT_GT(std::stod(json_value(o.out, "contacts")), 1000.0);
  const double n = 120000, share = std::stod(json_value(o.out, "escaped")) / n;
  const double expected =
      1.0 / (3.141592653589793 * 3.5 * 3.5);  // by t = 1; contacts spread the speeds
  EXPECT_NEAR(share, 1.0 - std::exp(-expected), 4.0 * std::sqrt(expected / n) + 0.06 * expected);
}

TEST(DiscsTyped, ArchivesHoldContactsAndEnergies) {
  const Shell shell;
  store(shell, "torus.toml", torus);
  const Outcome o = shell("$carom run ./torus.toml --json -o a.h5");
  ASSERT_EQ(o.status, 0) << o.err;
  const double mass[] = {1, 2, 3, 1.0 / 3}, radii[] = {0.5, 0.3, 0.4, 0.6};
  const auto get = [&](const char* name) {
    return column(shell, "a.h5", std::string("contacts/") + name);
  };
  const auto first = get("first"), second = get("second"), t = get("t"), dx = get("dx"),
             dy = get("dy"), x1 = get("first_x"), x2 = get("second_x"), v1 = get("first_vx"),
             v2 = get("second_vx"), w1 = get("first_vy"), w2 = get("second_vy"),
             transfer = get("transfer");
  ASSERT_GT(t.size(), 50u);
  EXPECT_EQ(std::to_string(t.size()), json_value(o.out, "contacts"));
  for (std::size_t i = 0; i < t.size(); ++i) {
    const auto a = static_cast<std::size_t>(first[i]), b = static_cast<std::size_t>(second[i]);
    EXPECT_LT(a, b);
    EXPECT_NEAR(std::hypot(dx[i], dy[i]), radii[a] + radii[b], 1e-12);
    EXPECT_NEAR(std::remainder(x1[i] - x2[i] - dx[i], 4.0), 0.0, 1e-12);
    // They part with the speed along the line of centres with which they met.
    const double apart =
        ((v1[i] - v2[i]) * dx[i] + (w1[i] - w2[i]) * dy[i]) / std::hypot(dx[i], dy[i]);
    EXPECT_NEAR(2.0 * apart * mass[a] * mass[b] / (mass[a] + mass[b]), transfer[i], 1e-12);
    EXPECT_TRUE(i == 0 || t[i] >= t[i - 1]);
  }
  const auto total = column(shell, "a.h5", "energy/total"), px = column(shell, "a.h5", "energy/px"),
             py = column(shell, "a.h5", "energy/py");
  ASSERT_EQ(total.size(), 201u);
  for (std::size_t i = 0; i < total.size(); ++i) {
    EXPECT_NEAR(total[i], total[0], 1e-12);
    EXPECT_NEAR(px[i], px[0], 1e-12);
    EXPECT_NEAR(py[i], py[0], 1e-12);
  }
}

TEST(DiscsTyped, AContinuedRunRepeatsAndGoesOnCounting) {
  const Shell shell;
  store(shell, "torus.toml", torus);
  ASSERT_EQ(shell("$carom run ./torus.toml -o whole.h5").status, 0);
  ASSERT_EQ(shell("$carom run ./torus.toml -o part.h5 --t-max 33.3").status, 0);
  const Outcome o = shell("$carom run --resume part.h5 --t-max 100 --json");
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(json_value(o.out, "contacts"),
            json_value(shell("$carom run ./torus.toml --json").out, "contacts"));
  for (const char* name :
       {"contacts/t", "contacts/dx", "contacts/first", "state/x", "state/vy", "state/contacts"})
    EXPECT_EQ(column(shell, "whole.h5", name), column(shell, "part.h5", name)) << name;
  EXPECT_FALSE(column(shell, "whole.h5", "state/contacts").empty());
}

// A disc's velocity after a wall differs from the speed that its reflections keep by rounding.
TEST(DiscsTyped, AContinuedRunAmongWallsHasTheSameBits) {
  const Shell shell;
  store(shell, "box.toml", R"toml(
table = { shape = "stadium", radius = 1, half_length = 1 }
[particles]
count = 6
mass = [1, 2, 3, 1, 2, 3]
[interaction]
kind = "hard-discs"
radius = 0.1
[run]
t_max = 30
)toml");
  for (const char* const seed : {"1", "2", "3", "4", "5", "6", "7", "8"}) {
    const std::string run = std::string("$carom run ./box.toml --force --seed ") + seed;
    ASSERT_EQ(shell(run + " -o whole.h5").status, 0) << shell(run + " -o whole.h5").err;
    ASSERT_EQ(shell(run + " -o part.h5 --t-max 10").status, 0);
    ASSERT_EQ(shell("$carom run --resume part.h5 --t-max 30").status, 0);
    for (const char* name : {"contacts/t", "state/x", "state/vy", "state/speed"})
      EXPECT_EQ(column(shell, "whole.h5", name), column(shell, "part.h5", name))
          << name << ", seed " << seed;
  }
}

}  // namespace
}  // namespace carom
