// [table] path: discs and corners in a text file.
#include <filesystem>
#include <fstream>
#include <tuple>

#include "scratch_folder.hpp"
#include "system_text.hpp"

namespace carom::tests {
namespace {

using geometry::Circle;
using geometry::Segment;
using geometry::Vector;

class PointsFile : public testing::Test {
 protected:
  LoadedSystem read_with(const std::string& points, const std::string& table) const {
    std::ofstream(folder_.file("points.csv")) << points;
    return read_system(
        "[table]\npath = \"points.csv\"\n" + table +
            "[initial]\nkind = \"line\"\nfrom = [-9, -9]\nto = [-8, -9]\nangle = 0\n",
        folder_.file("a.toml"));
  }
  std::string fault_of(const std::string& points, const std::string& table) const {
    try {
      read_with(points, table);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no fault";
  }

  const ScratchFolder folder_;
};

TEST_F(PointsFile, HoldsDiscs) {
  const LoadedSystem loaded =
      read_with("# x, y, radius\n0, 0, 1/3\n1, sqrt(2)/4, 0.5\r\n", "shape = \"discs\"\n");
  const Table& table = *loaded.system.table;
  ASSERT_EQ(table.walls.size(), 2u);
  EXPECT_EQ(std::get<Circle>(table.walls[0].curve).radius, 1.0 / 3.0);
  EXPECT_EQ(std::get<Circle>(table.walls[1].curve).centre, (Vector{1.0, 0x1.6a09e667f3bcdp-2}));
  EXPECT_EQ(read_with("0 0\n3 0\n", "shape = \"discs\"\nradius = 1\n").system.table->walls.size(),
            2u);
}

TEST_F(PointsFile, HoldsCorners) {
  const Table table = *read_with("0 0\n1 0\n1 1\n", "shape = \"polygon\"\n").system.table;
  EXPECT_EQ(table.walls.size(), 3u);
}

TEST_F(PointsFile, ResolvedSystemsHoldThePoints) {
  const LoadedSystem loaded = read_with("0 0 1/3\n1 1 +0.5e0\n2 2 .25\n", "shape = \"discs\"\n");
  std::filesystem::remove(folder_.file("points.csv"));
  const LoadedSystem again = read_system(loaded.resolved_toml, "again.toml");
  EXPECT_EQ(again.resolved_toml, loaded.resolved_toml);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_EQ(std::get<Circle>(again.system.table->walls[k].curve).radius,
              std::get<Circle>(loaded.system.table->walls[k].curve).radius);
}

TEST_F(PointsFile, FaultsNameTheLine) {
  const std::string discs = "shape = \"discs\"\n", round = "shape = \"discs\"\nradius = 1\n",
                    polygon = "shape = \"polygon\"\n";
  const std::tuple<const char*, std::string, const char*> faults[] = {
      {"0 0 1\n5 0\n", discs, "points.csv, line 2, column 1: this disc has no radius"},
      {"0 0\n5 0 1\n", round, "points.csv, line 2, column 1: this disc has a radius"},
      {"0 0 1\n", round, "has the discs' radii already"},
      {"0 0\n", discs, "table.radius"},
      {"0\n", discs,
       "points.csv, line 1, column 1: a disc has two or three numbers, but the line has 1"},
      {"0 0 1\n\n5 zero 1\n", discs, "points.csv, line 3, column 3"},
      {"0 0 1\n0.5 0 -1\n", discs, "points.csv, line 2, column 7: radius must be positive"},
      {"0 0 1\n1 0 1\n", discs, "points.csv, line"},
      {"0 0\n1 0\n1 1 1\n", polygon, "points.csv, line 3, column 1: a corner has two numbers"},
      {"0 0\n1 0\n1 0\n1 1\n", polygon, "points.csv, line 3, column 1: the same point twice"},
      {"# nothing\n", polygon, "the file holds no corner"},
      {"0 0\n", discs + "centers = [[0, 0]]\n", "'path' and 'centers' are both given"},
      {"0 0\n", "shape = \"circle\"\nradius = 1\n",
       "unknown key 'path' for 'circle', it belongs to polygon, discs"},
  };
  for (const auto& [points, table, message] : faults) EXPECT_HAS(fault_of(points, table), message);
}

}  // namespace
}  // namespace carom::tests
