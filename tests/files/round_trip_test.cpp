// The resolved system reads back as the same system.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>

#include "system_text.hpp"

namespace carom::tests {
namespace {

bool same(const geometry::Curve& a, const geometry::Curve& b) {
  if (a.index() != b.index() || !(geometry::start_point(a) == geometry::start_point(b)))
    return false;
  for (const double part : {0.2, 0.5, 0.9}) {
    const double u = part * geometry::end_parameter(a);
    if (!(geometry::point_at(a, u) == geometry::point_at(b, u))) return false;
  }
  return geometry::end_parameter(a) == geometry::end_parameter(b);
}

void expect_same(const Table& a, const Table& b) {
  EXPECT_EQ(a.shape, b.shape);
  EXPECT_EQ(a.extent, b.extent);
  ASSERT_EQ(a.walls.size(), b.walls.size());
  for (std::size_t k = 0; k < a.walls.size(); ++k) {
    EXPECT_EQ(a.walls[k].name, b.walls[k].name);
    EXPECT_EQ(a.walls[k].next, b.walls[k].next);
    EXPECT_EQ(a.walls[k].corner, b.walls[k].corner);
    EXPECT_EQ(a.walls[k].holes, b.walls[k].holes);
    EXPECT_TRUE(same(a.walls[k].curve, b.walls[k].curve)) << a.walls[k].name;
  }
  ASSERT_EQ(a.holes.size(), b.holes.size());
  for (std::size_t k = 0; k < a.holes.size(); ++k) {
    EXPECT_EQ(a.holes[k].name, b.holes[k].name);
    EXPECT_EQ(a.holes[k].from, b.holes[k].from);
    EXPECT_EQ(a.holes[k].to, b.holes[k].to);
  }
  ASSERT_EQ(a.lattice.has_value(), b.lattice.has_value());
  if (a.lattice) {
    EXPECT_EQ(a.lattice->first, b.lattice->first);
    EXPECT_EQ(a.lattice->second, b.lattice->second);
  }
}

void expect_same(const System& a, const System& b) {
  EXPECT_EQ(a.title, b.title);
  expect_same(*a.table, *b.table);
  ASSERT_EQ(a.particles.size(), b.particles.size());
  for (std::size_t k = 0; k < a.particles.size(); ++k) {
    EXPECT_EQ(a.particles[k].mass, b.particles[k].mass);
    EXPECT_EQ(a.particles[k].charge, b.particles[k].charge);
    EXPECT_EQ(a.particles[k].speed, b.particles[k].speed);
    EXPECT_EQ(a.particles[k].omega, b.particles[k].omega);
  }
  EXPECT_EQ(a.initial.kind, b.initial.kind);
  EXPECT_EQ(a.initial.walls, b.initial.walls);
  EXPECT_EQ(a.initial.hole, b.initial.hole);
  EXPECT_EQ(a.initial.position, b.initial.position);
  EXPECT_EQ(a.initial.velocity, b.initial.velocity);
  EXPECT_EQ(a.initial.low, b.initial.low);
  EXPECT_EQ(a.initial.high, b.initial.high);
  EXPECT_EQ(a.initial.from, b.initial.from);
  EXPECT_EQ(a.initial.to, b.initial.to);
  EXPECT_EQ(a.initial.angle, b.initial.angle);
  EXPECT_EQ(a.initial.s, b.initial.s);
  EXPECT_EQ(a.initial.v_parallel, b.initial.v_parallel);
  EXPECT_EQ(a.run.t_max, b.run.t_max);
  EXPECT_EQ(a.run.trajectories, b.run.trajectories);
  EXPECT_EQ(a.run.collisions, b.run.collisions);
  EXPECT_EQ(a.run.seed, b.run.seed);
  EXPECT_EQ(a.run.sample, b.run.sample);
  EXPECT_EQ(a.run.times, b.run.times);
}

void expect_round_trip(const LoadedSystem& loaded) {
  const LoadedSystem again = read_system(loaded.resolved_toml, "again");
  expect_same(loaded.system, again.system);
  EXPECT_EQ(loaded.resolved_toml, again.resolved_toml);
}

TEST(RoundTrip, BuiltInSystemsReadBackTheSame) {
  const std::vector<std::string> contract{"magnetic-square",
                                          "mushroom",
                                          "stadium",
                                          "circle",
                                          "ellipse-magnetic",
                                          "sinai",
                                          "lorentz-triangular",
                                          "lorentz-square",
                                          "lorentz-random",
                                          "three-disc",
                                          "siam-photon",
                                          "coulomb-circle",
                                          "wigner",
                                          "soft-lorentz",
                                          "henon-heiles",
                                          "antidot-magnetic"};
  EXPECT_EQ(builtin_systems().size(), contract.size());
  for (const std::string& name : contract) {
    SCOPED_TRACE(name);
    const LoadedSystem loaded = load_system(name);
    EXPECT_EQ(loaded.system.name, name);
    EXPECT_FALSE(loaded.system.title.empty());
    expect_round_trip(loaded);
  }
}

TEST(RoundTrip, EverySection) {
  const std::string hole = "[[table.hole]]\nwall = \"top\"\ncenter = \"1/3\"\nwidth = 0.1\n";
  for (
      const std::string& text : {
          square(hole + "[initial]\nkind = \"hole\"\nhole = \"hole_1\"\n"),
          square("[field]\nB = \"1/3\"\n[particles]\nmass = [1, \"2/3\"]\ncharge = [-1, 2]\nenergy "
                 "= 0.1\n"),
          square(
              "[initial]\nkind = \"point\"\nposition = [0.1, 0.2]\nvelocity = [0.3, \"sqrt(2)\"]\n"
              "[field]\nlarmor_radius = 0.3\n"),
          square("[initial]\nkind = \"point\"\nposition = [0.1, 0.2]\nangle = 0.3\n"),
          square(
              "[initial]\nkind = \"birkhoff\"\nwall = \"top\"\ns = {from = 0, to = 0.9, count = "
              "4}\n"
              "v_parallel = [0.1, -0.2]\n[run]\nsample = 0.1\ncollisions = 7\ntimes = [1, 2, 3]\n"),
          square(
              "[initial]\nkind = \"line\"\nfrom = [0.1, 0.1]\nto = [0.9, 0.1]\nangle = \"pi/3\"\n"),
          square("[initial]\nkind = \"rectangle\"\nmin = [0.1, 0.1]\nmax = [0.2, 0.2]\n"
                 "[run]\nt_max = \"2*pi\"\nseed = 0x10\n"),
          std::string("title = \"a \\\"b\\\" \\n é\"\n[table]\nshape = \"regular\"\nsides = "
                      "5\nradius = 1_0.5\n"),
          std::string("[table]\nshape = \"path\"\n[[table.loop]]\nstart = [-1, 0]\npieces = "
                      "[{line_to = [1, 0]},\n"
                      "{arc_via = [0, 1], arc_to = [-1, 0], name = \"dome\"}]\n"),
          square("[[table.obstacle]]\nshape = \"circle\"\ncenter = [\"1/3\", 0.2]\nradius = 0.1\n"
                 "[[table.obstacle]]\nshape = \"ellipse\"\ncenter = [0.7, 0.2]\na = 0.1\nb = "
                 "\"1/7\"\nangle = 0.3\n"
                 "name = \"egg\"\n"
                 "[[table.obstacle]]\nshape = \"polygon\"\npoints = [[0.5, 0.5], [0.7, 0.5], [0.6, "
                 "0.6]]\n"
                 "[[table.hole]]\nwall = \"obstacle_3_side_2\"\ncenter = 0.05\nwidth = 0.01\n"),
          std::string("[table]\nshape = \"sinai\"\nside = 1\nradius = 0.2\n"
                      "[[table.obstacle]]\nshape = \"circle\"\ncenter = [0, 0]\nradius = 0.1\n"),
          std::string(
              "[table]\nshape = \"discs\"\ncenters = [[0, 0], [3, 0]]\nradii = [1, \"1/2\"]\n"
              "[lattice]\nvectors = [[6, 0], [\"1/2\", 4]]\n"),
      }) {
    SCOPED_TRACE(text);
    expect_round_trip(read_system(text, "test.toml"));
  }
}

TEST(RoundTrip, OverridesAreInTheResolvedSystem) {
  SystemOverrides o = set("table.hole[0].width", "1/7");
  o.seed = "18446744073709551615";
  o.trajectories = "1e9";
  o.t_max = "sqrt(2)*100";
  o.times = "log:1/3:sqrt(2)*100:9";
  o.position = "1/3,1/4";
  o.velocity = "-1,1/7";
  const LoadedSystem loaded = load_system("magnetic-square", o);
  EXPECT_EQ(loaded.system.run.seed, UINT64_MAX);
  EXPECT_EQ(loaded.system.run.times.size(), 9u);
  expect_round_trip(loaded);
}

TEST(RoundTrip, NumbersStayAsWritten) {
  const std::string resolved =
      read_system(square("[run]\nt_max = 1.50e2\n"), "test.toml").resolved_toml;
  EXPECT_NE(resolved.find("t_max = 1.50e2\n"), std::string::npos);
  EXPECT_NE(resolved.find("from = \"(1.50e2)/1000\", to = 1.50e2"), std::string::npos);
}

/// The table of keys as Markdown.
std::string key_table_markdown() {
  // There may be several of these, each under [[its name]].
  const auto heading = [](std::string_view section) {
    const bool list = section == "table.obstacle" || section == "table.hole" ||
                      section == "table.wall" || section == "table.region" ||
                      section == "table.loop" || section == "injection" || section == "potential";
    return list ? fmt::format("[[{}]]", section) : std::string(section);
  };
  std::string page;
  std::string_view section = "none";
  for (const KeyDescription& key : key_table()) {
    if (key.section != section) {
      section = key.section;
      page += section.empty() ? "### Above all sections\n\n"
                              : fmt::format("\n### {}\n\n", heading(section));
      page += "| key | for | type | default | meaning |\n|---|---|---|---|---|\n";
    }
    std::string kinds(key.kind);
    for (std::size_t at = 0; (at = kinds.find('|', at)) != std::string::npos;)
      kinds.replace(at, 1, ", ");
    const std::string fallback = key.fallback.empty() ? "" : fmt::format("`{}`", key.fallback);
    page += fmt::format("| `{}` | {} | {} | {} | {} |\n", key.key, kinds, key.type, fallback,
                        key.meaning);
  }
  return page;
}

TEST(KeyTable, IsTheOneInTheGuide) {
  std::ifstream file(CAROM_SOURCE "/docs/guide/system-file.md");
  ASSERT_TRUE(file);
  std::ostringstream page;
  page << file.rdbuf();
  EXPECT_NE(page.str().find(key_table_markdown()), std::string::npos);
}

TEST(KeyTable, DescribesEveryKeyOnceForEachKind) {
  std::vector<std::string> seen;
  for (const KeyDescription& key : key_table()) {
    EXPECT_FALSE(key.key.empty());
    EXPECT_FALSE(key.type.empty());
    EXPECT_FALSE(key.meaning.empty());
    std::istringstream kinds{std::string(key.kind)};
    for (std::string kind; std::getline(kinds, kind, '|') || kind.empty();) {
      const std::string name =
          std::string(key.section) + "." + std::string(key.key) + " of '" + kind + "'";
      EXPECT_EQ(std::count(seen.begin(), seen.end(), name), 0) << name;
      seen.push_back(name);
      if (kind.empty()) break;  // of all
    }
  }
}

}  // namespace
}  // namespace carom::tests
