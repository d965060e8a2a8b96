// Damaged files are refused with an InputError or read; nothing else may happen.
#include "damaged.hpp"
#include "system_text.hpp"

namespace carom::tests {
namespace {

const std::string pieces[] = {"0",      "-1",   "1e400", "nan", "[",    "]",     "{",   "}",
                              "\"",     "=",    "\n",    ".",   "true", "[[x]]", "1/0", "\"1/3\"",
                              "[1, 2]", "#",    "\xff",  "é",   "hole", "kind",  "''",  "[run]",
                              "inf",    "1e-9", "\"\"",  "1e9", ",",    "\r\n",  "\t"};

/// The value of the next key is another one.
std::string damaged(std::string text, Cases& cases) {
  return damaged(std::move(text), cases, pieces, [&](std::string& all, std::size_t at) {
    const std::size_t equals = all.find('=', at);
    if (equals == std::string::npos) return;
    const std::size_t end = std::min(all.find('\n', equals), all.size());
    all.replace(equals + 1, end - equals - 1, " " + pieces[cases.below(std::size(pieces))]);
  });
}

TEST(Fuzz, DamagedSystemsAreRefusedOrRead) {
  Cases cases(2026);
  int refused = 0, read = 0;
  for (int k = 0; k < 400; ++k) {
    for (const BuiltinSystem& system : builtin_systems()) {
      const std::string text = damaged(std::string(system.toml), cases);
      try {
        const LoadedSystem loaded = read_system(text, "fuzz.toml");
        ++read;
        ASSERT_EQ(read_system(loaded.resolved_toml, "again").resolved_toml, loaded.resolved_toml)
            << text;
      } catch (const InputError& error) {
        ++refused;
        EXPECT_FALSE(error.problem().empty());
        EXPECT_EQ(error.place().file, "fuzz.toml") << error.what() << "\nof\n" << text;
      } catch (const std::exception& error) {
        FAIL() << error.what() << "\nof\n" << text;
      }
    }
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(read, 300);
}

TEST(Fuzz, AnyPathAndValueCanBeSet) {
  Cases cases(2026);
  const std::string paths[] = {
      "table.shape", "table.hole",  "table.hole[0]", "table.hole[0].width", "run.times",
      "table",       "run",         "initial.kind",  "particles.mass",      "title",
      "field.B",     "table.width", "run.seed",      "lattice.vectors",     "initial"};
  for (int k = 0; k < 2000; ++k) {
    const std::string value =
        pieces[cases.below(std::size(pieces))] + pieces[cases.below(std::size(pieces))];
    const InputError error =
        fault(std::string(builtin_systems()[cases.below(builtin_systems().size())].toml),
              set(paths[cases.below(std::size(paths))], value));
    EXPECT_FALSE(error.problem().empty());
  }
}

}  // namespace
}  // namespace carom::tests
