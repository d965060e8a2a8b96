#include "cli/option_faults.hpp"

#include <fmt/format.h>
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include <algorithm>
#include <vector>

#include "carom/base/error.hpp"
#include "carom/files/system_file.hpp"

namespace carom::cli {

namespace {

bool is_system(const std::string& word) {
  const auto& systems = builtin_systems();
  return word.ends_with(".toml") ||
         std::any_of(systems.begin(), systems.end(),
                     [&](const BuiltinSystem& system) { return system.name == word; });
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

}  // namespace

std::string unknown_word(const CLI::App& app) {
  for (const std::string& word : app.remaining()) {
    if (word.find_first_of("-+0123456789") == 0 || word.empty()) continue;  // an option, its value
    if (is_system(word))
      return "'" + word + "' is a system, not a command: carom run " + word + ", carom escape " +
             word + ", carom table " + word;
    std::vector<std::string> names;
    for (const CLI::App* command : commands_of(app)) names.push_back(command->get_name());
    const std::string near = nearest_name(word, names);
    return "there is no command '" + word + "'" +
           (near.empty() ? std::string() : "; did you mean '" + near + "'?");
  }
  return {};
}

std::string unknown_option(const CLI::App& app, const CLI::App& command, int argc, char** argv) {
  const std::vector<std::string> remaining = command.remaining();
  const auto is_option = [](const std::string& word) {
    return word.size() > 1 && word[0] == '-' &&
           std::string("0123456789.").find(word[1]) == std::string::npos;
  };
  std::string first;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (std::find(remaining.begin(), remaining.end(), word) == remaining.end()) continue;
    if (first.empty()) first = word;
    if (!is_option(word)) continue;
    const std::string name = word.substr(0, word.find('='));
    std::vector<std::string> others, known;
    for (const CLI::App* other : commands_of(app))
      if (other->get_option_no_throw(name)) others.push_back(other->get_name());
    for (const CLI::Option* option : command.get_options())
      for (const std::string& one : option->get_lnames()) known.push_back("--" + one);
    if (!others.empty() && &app == &command) {
      const auto chosen = app.get_subcommands();
      const std::string of = chosen.empty() ? others.front() : chosen.front()->get_name();
      return name + " comes before the command: write carom " + of + " SYSTEM " + name;
    }
    if (!others.empty()) {
      const auto longer = std::find_if(known.begin(), known.end(), [&](const std::string& one) {
        return one.starts_with(name.substr(0, name.size() - 1));
      });
      return name + " means nothing to carom " + command.get_name() + ": it is an option of " +
             fmt::format("{}", fmt::join(others, ", ")) +
             (longer == known.end() ? "" : "; did you mean '" + *longer + "'?");
    }
    const std::string near = nearest_name(name, known);
    return "there is no option '" + name + "'" +
           (near.empty() ? std::string() : "; did you mean '" + near + "'?");
  }
  return "'" + (first.empty() ? remaining.front() : first) + "' is not expected";
}

std::string parted_pair(int argc, char** argv) {
  const auto is_number = [](const std::string& word) {
    const std::size_t first = word.find_first_not_of("+-");
    return first != std::string::npos && std::string("0123456789.").find(word[first]) < 11;
  };
  for (int i = 1; i + 2 < argc; ++i) {
    const std::string option = argv[i], one = argv[i + 1], other = argv[i + 2];
    const bool window = option == "--window";
    if (option != "--position" && option != "--velocity" && !window) continue;
    if (is_number(one) && is_number(other) && one.find_first_of(",:") == std::string::npos)
      return option + " takes two numbers in one word: write " + option + " " + one +
             (window ? ":" : ",") + other;
  }
  return {};
}

}  // namespace carom::cli
