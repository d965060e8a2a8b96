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
  InputError fault_of(const std::string& points, const std::string& table) const {
    try {
      read_with(points, table);
    } catch (const InputError& error) {
      return error;
    }
    return InputError("no fault");
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
  const struct {
    const char* points;
    std::string table;
    int line, column;
  } faults[] = {
      {"0 0 1\n5 0\n", discs, 2, 1},
      {"0 0\n5 0 1\n", round, 2, 1},
      {"0\n", discs, 1, 1},
      {"0 0 1\n\n5 zero 1\n", discs, 3, 3},
      {"0 0 1\n0.5 0 -1\n", discs, 2, 7},
      {"0 0\n1 0\n1 1 1\n", polygon, 3, 1},
      {"0 0\n1 0\n1 0\n1 1\n", polygon, 3, 1},
  };
  for (const auto& [points, table, line, column] : faults) {
    const Place place = fault_of(points, table).place();
    EXPECT_TRUE(place.file.ends_with("points.csv")) << points;
    EXPECT_EQ(place.line, line) << points;
    EXPECT_EQ(place.column, column) << points;
  }
  EXPECT_EQ(fault_of("0 0\n", discs).place().key, "table.radius");
  EXPECT_EQ(fault_of("0 0\n", discs + "centers = [[0, 0]]\n").place().key, "table.centers");
}

}  // namespace
}  // namespace carom::tests
