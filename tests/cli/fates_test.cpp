// How particles end: one meaning of each fate, and one sum, whatever the command.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <string>

#include "archive_contents.hpp"
#include "program.hpp"

namespace carom {
namespace {

std::uint64_t whole(const std::string& json, const char* key) {
  const std::string value = json_value(json, key);
  return value.empty() ? ~std::uint64_t{0} : std::stoull(value);
}

// The particles of each command: some escape, some are stopped by the cap, the others reach the
// last time.
TEST(Fates, AddUpInEveryCommand) {
  const Shell shell;
  const std::pair<const char*, std::uint64_t> commands[] = {
      {"escape stadium --trajectories 100", 100},
      {"diffusion stadium --trajectories 100", 100},
      {"lyapunov stadium --trajectories 100 --window 0:6", 100},
      {"section stadium --orbits 100 --points 9", 100},
      {"section stadium --orbits 50 --points 9 --set particles.count=2", 100}};
  for (const auto& [command, all] : commands) {
    const Outcome o = shell(std::string("$carom ") + command +
                            " --t-max 12 --collisions 6 --json --force -o a.h5");
    ASSERT_EQ(o.status, 0) << command << o.err;
    const auto number = [&](const char* key) { return whole(o.out, key); };
    EXPECT_GT(number("capped"), 0u) << command;
    EXPECT_LE(number("capped") + number("pinned"), number("survived")) << command;
    EXPECT_LE(number("unbounded"), number("escaped")) << command;
    EXPECT_EQ(number("survived") + number("escaped") + number("singular") + number("unresolved") +
                  number("lost"),
              all)
        << command << o.out;
    const auto datasets = open_archive(shell.folder() + "/a.h5").datasets;
    for (const char* key : {"survived", "pinned", "capped", "escaped", "unbounded", "singular",
                            "unresolved", "lost"}) {
      const auto at = datasets.find(std::string("fates/") + key);
      ASSERT_NE(at, datasets.end()) << command << ": " << key;
      std::uint64_t stored = 0;
      std::memcpy(&stored, at->second.data(), sizeof stored);
      EXPECT_EQ(stored, number(key)) << command << ": " << key;
    }
  }
}

TEST(Fates, ACappedOneHasSurvived) {
  const Shell shell;
  for (const char* command : {"escape", "diffusion"}) {
    const Outcome o = shell(std::string("$carom ") + command +
                            " lorentz-triangular --trajectories 100 --t-max 50 --collisions 5 "
                            "--json");
    EXPECT_EQ(json_value(o.out, "survived"), "100") << command << o.err;
    EXPECT_EQ(json_value(o.out, "capped"), "100") << command;
  }
}

}  // namespace
}  // namespace carom
