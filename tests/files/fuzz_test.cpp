// Damaged files are refused with an InputError or read; nothing else may happen.
#include "system_text.hpp"

namespace carom::tests {
namespace {

// A small generator, so that the cases are the same everywhere.
class Cases {
 public:
  std::size_t below(std::size_t n) {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<std::size_t>(state_ >> 33) % n;
  }

 private:
  std::uint64_t state_ = 2026;
};

const std::string pieces[] = {"0",      "-1",   "1e400", "nan", "[",    "]",     "{",   "}",
                              "\"",     "=",    "\n",    ".",   "true", "[[x]]", "1/0", "\"1/3\"",
                              "[1, 2]", "#",    "\xff",  "é",   "hole", "kind",  "''",  "[run]",
                              "inf",    "1e-9", "\"\"",  "1e9", ",",    "\r\n",  "\t"};

std::string damaged(std::string text, Cases& cases) {
  for (std::size_t k = cases.below(3) + 1; k > 0 && !text.empty(); --k) {
    const std::size_t at = cases.below(text.size());
    switch (cases.below(4)) {
      case 0:
        text.erase(at, cases.below(12) + 1);
        break;
      case 1:
        text.insert(at, pieces[cases.below(std::size(pieces))]);
        break;
      case 2: {  // another value for a key
        const std::size_t equals = text.find('=', at);
        if (equals == std::string::npos) break;
        const std::size_t end = std::min(text.find('\n', equals), text.size());
        text.replace(equals + 1, end - equals - 1, " " + pieces[cases.below(std::size(pieces))]);
        break;
      }
      default:
        text[at] = static_cast<char>(32 + cases.below(95));
    }
  }
  return text;
}

TEST(Fuzz, DamagedSystemsAreRefusedOrRead) {
  Cases cases;
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
  Cases cases;
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
