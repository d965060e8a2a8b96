#include "cli/manual/candidates.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>

#include "carom/files/system_file.hpp"

namespace carom::cli::manual {

namespace {

// "auto|events|steps" names its words; capitals would stand for something.
std::vector<std::string> listed(const std::string& shown) {
  const auto capital = [](unsigned char c) { return std::isupper(c) != 0; };
  if (shown.find('|') == std::string::npos || std::any_of(shown.begin(), shown.end(), capital))
    return {};
  std::vector<std::string> words;
  std::istringstream text(shown);
  for (std::string word; std::getline(text, word, '|');) words.push_back(word);
  return words;
}

}  // namespace

Candidates candidates_of(const std::string& shown) {
  const std::vector<std::string> archives{"h5", "hdf5"};
  if (shown == "SYSTEM") return {.systems = true, .files = true, .endings = {"toml"}};
  if (shown == "SOURCE") return {.systems = true, .files = true, .endings = {"toml", "h5", "hdf5"}};
  if (shown == "NAME") return {.systems = true};
  if (shown == "FILES" || shown == "FILE.h5") return {.files = true, .endings = archives};
  if (shown == "PICTURE") return {.files = true, .endings = {"png", "svg", "pdf"}};
  if (shown == "FILE") return {.files = true};
  if (shown.starts_with("FILE.")) return {.files = true, .endings = {shown.substr(5)}};
  return {.words = listed(shown)};
}

std::vector<std::string> system_names() {
  std::vector<std::string> names;
  for (const BuiltinSystem& system : builtin_systems()) names.emplace_back(system.name);
  return names;
}

}  // namespace carom::cli::manual
