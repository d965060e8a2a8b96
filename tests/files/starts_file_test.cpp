// [initial] kind = "file".
#include <filesystem>
#include <fstream>

#include "scratch_folder.hpp"
#include "system_text.hpp"

namespace carom::tests {
namespace {

class StartsFile : public testing::Test {
 protected:
  LoadedSystem read_with(const std::string& starts) const {
    std::ofstream(folder_.file("starts.txt")) << starts;
    return read_system(square("[initial]\nkind = \"file\"\npath = \"starts.txt\"\n"),
                       folder_.file("a.toml"));
  }
  InputError fault_of(const std::string& starts) const {
    try {
      read_with(starts);
    } catch (const InputError& error) {
      return error;
    }
    return InputError("no fault");
  }

  const ScratchFolder folder_;
};

TEST_F(StartsFile, IsTheListItHolds) {
  const LoadedSystem loaded =
      read_with("# x y vx vy\n0.25 0.5 1 0\n\n1/3, sqrt(2)/4, 0, -1  # exact\r\n");
  const InitialCondition& initial = loaded.system.initial;
  ASSERT_EQ(initial.kind, InitialCondition::Kind::list);
  ASSERT_EQ(initial.positions.size(), 2u);
  EXPECT_EQ(initial.positions[0], (geometry::Vector{0.25, 0.5}));
  EXPECT_EQ(initial.positions[1].x, 1.0 / 3.0);
  EXPECT_EQ(initial.positions[1].y, 0x1.6a09e667f3bcdp-2);
  EXPECT_EQ(initial.velocities[1], (geometry::Vector{0, -1}));
}

TEST_F(StartsFile, ResolvedSystemsHoldTheStarts) {
  const LoadedSystem loaded = read_with("0.25 1/3 1 0\n");
  std::filesystem::remove(folder_.file("starts.txt"));
  const LoadedSystem again = read_system(loaded.resolved_toml, "again.toml");
  EXPECT_EQ(again.resolved_toml, loaded.resolved_toml);
  EXPECT_EQ(again.system.initial.positions, loaded.system.initial.positions);
}

// As with one start: its length is the speed unless one is set.
TEST_F(StartsFile, VelocitiesAreSpeedsToo) {
  EXPECT_EQ(
      read_with("0.25 0.5 2 0\n0.5 0.5 0 -2\n0.5 0.25 1.2 1.6\n").system.particles.at(0).speed,
      2.0);
  EXPECT_EQ(fault_of("0.25 0.5 2 0\n0.5 0.5 0 1\n").place().line, 2);
  const auto speeds = [](const std::string& particles, const std::string& starts) {
    const LoadedSystem loaded = read_system(
        square(particles + "[initial]\nkind = \"list\"\nstarts = " + starts + "\n"), "list");
    EXPECT_EQ(read_system(loaded.resolved_toml, "again").resolved_toml, loaded.resolved_toml);
    std::vector<double> result;
    for (const Particle& p : loaded.system.particles) result.push_back(p.speed);
    return result;
  };
  using Speeds = std::vector<double>;
  const char* const two = "[[0.1, 0.1, 2, 0], [0.1, 0.2, 0.5, 0]]";
  EXPECT_EQ(speeds("[particles]\ncount = 2\n", two), (Speeds{2.0, 0.5}));
  EXPECT_EQ(speeds("[particles]\ncount = 4\n", two), (Speeds{2.0, 0.5, 2.0, 0.5}));
  EXPECT_EQ(speeds("[particles]\nmass = [1, 2]\n", two), (Speeds{2.0, 0.5}));
  EXPECT_EQ(speeds("[particles]\ncount = 2\nspeed = 3\n", two), (Speeds{3.0, 3.0}));
  EXPECT_EQ(speeds("[particles]\nenergy = 2\n", two), (Speeds{2.0}));
  EXPECT_THROW(speeds("[particles]\ncount = 3\n", two), InputError);
  EXPECT_THROW(speeds("", two), InputError);
}

TEST_F(StartsFile, FaultsNameTheLine) {
  EXPECT_EQ(fault_of("0.5 0.5 1 0\n0.5 0.5 1\n").place().line, 2);
  EXPECT_EQ(fault_of("0.5 0.5 1 zero\n").place().column, 11);
  EXPECT_TRUE(fault_of("# nothing\n").place().file.ends_with("starts.txt"));
}

TEST_F(StartsFile, MayBeginWithAByteOrderMark) {
  EXPECT_EQ(read_with("\xEF\xBB\xBF"
                      "0.25 0.5 1 0\n")
                .system.initial.positions[0],
            (geometry::Vector{0.25, 0.5}));
  EXPECT_EQ(read_with("\xEF\xBB\xBF# x y vx vy\n0.25 0.5 1 0\n").system.initial.positions.size(),
            1u);
}

}  // namespace
}  // namespace carom::tests
